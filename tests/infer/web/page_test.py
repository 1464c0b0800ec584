"""The ground-station page in headless Chromium: page_test.py SERVE_HOVER [PICTURE]. Exit code 77: no Chromium."""
import json
import struct
import subprocess
import sys
import tempfile
import time
import urllib.request
import zlib

from browser import Browser, find_chromium

TOKEN = "a token for the page test"
SKIPPED = 77


def check(condition, message):
    if not condition:
        raise AssertionError(message)


def png_rows(path):
    """The rows of an RGB(A) PNG without interlacing, filters undone."""
    data = open(path, "rb").read()
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    check(depth == 8 and kind in (2, 6), "a PNG of 8 bits was expected")
    channels, packed, at = (3 if kind == 2 else 4), b"", 8
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    raw, stride, before = zlib.decompress(packed), width * channels, bytearray(width * channels)
    for v in range(height):
        mode, row = raw[v * (stride + 1)], bytearray(raw[v * (stride + 1) + 1:(v + 1) * (stride + 1)])
        for i in range(stride):
            a = row[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            if mode == 4:
                p = a + b - c
                near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, near if mode == 4 else 0)[mode]) & 255
        yield [tuple(row[i:i + 3]) for i in range(0, stride, channels)]
        before = row


def state(url):
    with urllib.request.urlopen(url + "state", timeout=10) as answer:
        return json.load(answer)


def text(browser, name):
    return browser.value(f"document.getElementById('{name}').textContent")


def compare_live_numbers(browser, frame):
    """Raises unless the page shows what does not change in a hover as the state said it."""
    check(text(browser, "landing") == "accepted" == frame["landing"]["text"], text(browser, "landing"))
    check(text(browser, "source") == frame["result"]["source"] == "lidar", text(browser, "source"))
    for name in ("sim", "sim_d", "sim_pred"):
        shown = text(browser, name)
        check(abs(float(shown) - frame["result"][name]) < 0.02, f"{name}: {shown} for {frame['result'][name]}")
    shown = float(text(browser, "radius").split()[0])
    check(abs(shown - frame["result"]["site"]["radius_m"]) < 0.2, f"radius: {shown}")


def shows_live_numbers(browser, url):
    """A busy machine drops messages, and the engine interpolates a few images: then the network has no numbers to show."""
    deadline = time.monotonic() + 60
    while True:
        try:
            compare_live_numbers(browser, state(url)["frame"])
            break
        except (AssertionError, ValueError, TypeError):
            if time.monotonic() > deadline:
                raise
            time.sleep(0.2)
    rates = browser.value("[...document.querySelectorAll('#sensors tr')].map(row => row.innerText)")
    check(len(rates) == 5 and "100.0 Hz" in rates[2], f"sensors: {rates}")
    first = browser.value("+document.documentElement.dataset.frame")
    browser.wait_for(f"document.documentElement.dataset.frame > {first + 3}")


def shows_pictures(browser, path):
    """The three pictures and the charts are on the screenshot, each with many colours."""
    browser.screenshot(path)
    rows = list(png_rows(path))
    boxes = browser.value("""[...document.querySelectorAll('.screen, .plot')].map(canvas => {
      const box = canvas.getBoundingClientRect();
      return [canvas.id, ...[box.left, box.top, box.right, box.bottom].map(Math.round)];
    })""")
    check(len(boxes) == 6, f"pictures and charts: {boxes}")
    least = {"left": 200, "depth": 1, "safe": 20}  # level ground is one depth
    for name, left, top, right, bottom in boxes:
        colours = {pixel for row in rows[top:bottom] for pixel in row[left:right]}
        check(len(colours) >= least.get(name, 10), f"{name} is blank: {len(colours)} colours")
    box = next(box for box in boxes if box[0] == "depth")
    check(sum(rows[(box[2] + box[4]) // 2][(box[1] + box[3]) // 2]) > 60, "the depth picture is black")
    check(browser.value("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the window")


def switches_mode(browser, url):
    """To automatic with two presses, back with one; not without the token."""
    press = "document.getElementById('switch').click()"
    browser.value(press)
    time.sleep(0.5)
    check(state(url)["mode"] == "manual", "one press switched to automatic")
    # The page forgets the first press after a while, which may have passed on a busy machine.
    browser.value(f"document.getElementById('switch').classList.contains('armed') || {press}; {press}")
    browser.wait_for("document.getElementById('mode').textContent === 'automatic'")
    check(state(url)["mode"] == "automatic", "the page says automatic, the station does not")
    browser.value(press)
    browser.wait_for("document.getElementById('mode').textContent === 'manual'")


def main():
    if not find_chromium():
        print("skipped: chromium is not installed (scripts/setup.sh --full)")
        return SKIPPED
    server = subprocess.Popen([sys.argv[1], ":0", TOKEN], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        url = next(line.strip() for line in server.stdout if line.startswith("http"))
        with tempfile.TemporaryDirectory() as folder, Browser(1600, 900) as browser:
            browser.open(url + "#token=" + TOKEN.replace(" ", "%20"))
            browser.wait_for("document.documentElement.dataset.frame > 0")
            browser.wait_for("document.getElementById('landing').textContent === 'accepted'")
            check(not browser.value("location.hash"), "the token stays in the address")
            shows_live_numbers(browser, url)
            shows_pictures(browser, f"{folder}/page.png")
            switches_mode(browser, url)
            for width_px, height_px in ((1024, 1366), (768, 1024), (390, 844)):
                browser.resize(width_px, height_px)
                time.sleep(0.5)
                check(browser.value("document.documentElement.scrollWidth <= innerWidth"),
                      f"the page is wider than a window of {width_px} px")
            server.stdin.close()
            server.wait(30)
            browser.wait_for("document.getElementById('notice').textContent.includes('No connection')")
    finally:
        server.kill()
        server.wait()
    print("page_test: passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
