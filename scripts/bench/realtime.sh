#!/usr/bin/env bash
# How the onboard program does on flights at the paper's full rates, with the shipped network: images a second and losses in
# real time, and the LiDAR time that an image needs when the processor is fast enough, over a familiar and an unknown look.
#   scripts/bench/realtime.sh                 flies the two simulated flights first, about two minutes
#   scripts/bench/realtime.sh LOG.bag ...     your own flights
#   ALIGHT_WORK=DIR                           for logs and results (default: out/realtime)
# Prints Markdown. Run it while nothing else wants the cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
case ${1:-} in --help | -h) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
bin=build/release/bin work=${ALIGHT_WORK:-out/realtime}
[ -x $bin/alight-infer ] && [ -x $bin/alight-sim ] || scripts/build.sh release alight-infer alight-sim >&2
mkdir -p "$work"
logs=("$@")
if [ $# = 0 ]; then
  for flight in familiar unknown; do
    [ -f "$work/$flight.bag" ] || $bin/alight-sim --config configs/sim/realtime.yaml --flight $flight --output "$work" >&2
    logs+=("$work/$flight.bag")
  done
fi
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-1000}
for log in "${logs[@]}"; do
  name=$(basename "$log" .bag)
  rm -rf "$work/$name.live" "$work/$name.replay"
  $bin/alight-infer --quiet --realtime --set overlay_every=0 --log "$log" --output "$work/$name.live" >"$work/$name.live.txt" 2>/dev/null
  $bin/alight-infer --quiet --set overlay_every=0 --log "$log" --output "$work/$name.replay" >"$work/$name.replay.txt" 2>/dev/null
done
echo "$(nproc) cores,$(sed -n 's/^model name.*:/ /p' /proc/cpuinfo | head -1), $(date -u +%Y-%m-%d)"
echo
/usr/bin/python3 - "$work" "${logs[@]}" <<'PYTHON'
import json, pathlib, re, sys
work, logs = pathlib.Path(sys.argv[1]), sys.argv[2:]
print("| flight | images | in real time, images/s | lost to a full queue | latency ms, median (p95) "
      "| mean accumulation, s | image alone | image and LiDAR | interpolated | none |")
print("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
for log in logs:
    name = pathlib.Path(log).stem
    live = (work / f"{name}.live.txt").read_text()
    rate, median, p95 = re.search(r"([\d.]+) images/s; from arrival to result (\d+) ms \(median\), (\d+) ms \(p95\)", live).groups()
    lost = sum(int(n) for n in re.findall(r"(\d+) image pushed out of the queue", live))
    results = [json.loads(line) for line in (work / f"{name}.replay" / "results.jsonl").read_text().splitlines()]
    share = lambda source: sum(r["source"] == source for r in results) / len(results)
    fed = [r["accumulation_s"] for r in results if r["source"] != "none"]
    print(f"| {name} | {len(results)} | {rate} | {lost} | {median} ({p95}) | {sum(fed) / max(1, len(fed)):.2f} | " +
          " | ".join(f"{100 * share(s):.0f} %" for s in ("image", "lidar", "fallback", "none")) + " |")
PYTHON
