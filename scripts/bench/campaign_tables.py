#!/usr/bin/env python3
"""The tables of docs/results/campaign.md, from the landings themselves.

  scripts/bench/campaign_tables.py out/campaign                        tables of what scripts/bench/campaign.sh has flown so far
  scripts/bench/campaign_tables.py out/campaign --csv landings.csv     and a line for every landing
  scripts/bench/campaign_tables.py docs/results/campaign.csv                   tables of such a file
"""
import argparse
import collections
import csv
import json
import math
import pathlib
import sys

COLUMNS = ["part", "seed", "look", "failure", "from_s", "for_s", "outcome", "reason", "time_s", "sites", "least_bad",
           "east_m", "north_m", "clearance_m", "widest_safe_m"]
PARTS = ["calm", "failing", "coarse", "full", "cameras"]
WANTED_RADIUS_M = 3.0  # as flight.wanted_radius_m


def number(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def line_of(part, row):
    """One row of a campaign's rows.jsonl as a line of the table of landings."""
    footprint = row["footprint"]
    reason = row["reason"].split(":")[0].split(" (")[0]
    return dict(zip(COLUMNS, [
        part, str(row["seed"]), row["look"], "" if row["fault"] == "none" else row["fault"],
        "" if row["fault"] == "none" else number(row["fault_s"], 1), number(row["fault_lasts_s"], 1), row["outcome"], reason,
        number(row["duration_s"], 1), str(row["attempts"]), "yes" if row["least_bad"] else "", number(row["p_end"][0], 2),
        number(row["p_end"][1], 2), number(footprint and footprint["clearance_m"], 2), number(row["safe_radius_m"], 1)]))


def read_folder(folder):
    lines = []
    for part in PARTS:
        rows = folder / part / "rows.jsonl"
        if rows.exists():
            lines += [line_of(part, json.loads(text)) for text in rows.read_text().splitlines() if text]
    return sorted(lines, key=lambda line: (PARTS.index(line["part"]), int(line["seed"])))


def wilson(successes, trials):
    z = 1.959963984540054
    p = successes / trials
    middle = (p + z * z / (2 * trials)) / (1 + z * z / trials)
    half = z / (1 + z * z / trials) * math.sqrt(p * (1 - p) / trials + z * z / (4 * trials * trials))
    return max(0.0, middle - half), min(1.0, middle + half)


def share(successes, trials, digits=1):
    if trials == 0:
        return "-"
    low, high = wilson(successes, trials)
    return f"{100 * successes / trials:.{digits}f} % ({100 * low:.{digits}f} to {100 * high:.{digits}f})"


def safe(lines):
    return [line for line in lines if line["outcome"] == "safe"]


def unsafe(lines):
    return [line for line in lines if line["outcome"] in ("unsafe", "collided")]


def gave_up(lines):
    return [line for line in lines if line["outcome"] not in ("safe", "unsafe", "collided")]


def by_duration(lines):
    """Of landings with a failure those in which it was over after a while, and those in which it stayed."""
    failed = [line for line in lines if line["failure"]]
    return [line for line in failed if line["for_s"]], [line for line in failed if not line["for_s"]]


def times(lines):
    seconds = sorted(float(line["time_s"]) for line in safe(lines))
    if not seconds:
        return "-"
    return ", ".join(f"{seconds[int(q * (len(seconds) - 1))]:.0f}" for q in (0.5, 0.9))


def second_sites(lines):
    return sum(int(line["sites"]) > 1 for line in safe(lines))


def least_clearance(lines):
    clearances_m = [float(line["clearance_m"]) for line in safe(lines)]
    return f"{min(clearances_m):.1f} m" if clearances_m else "-"


def summary(name, lines):
    reach = [line for line in lines if float(line["widest_safe_m"]) >= WANTED_RADIUS_M]
    seeds = [int(line["seed"]) for line in lines]
    low, high = wilson(len(unsafe(lines)), len(lines))
    print(f"| {name} | {min(seeds)} to {max(seeds)} | {len(lines)} | {len(reach)} | {share(len(safe(reach)), len(reach))} "
          f"| {len(unsafe(lines))} ({100 * low:.2f} to {100 * high:.2f} %) | {len(gave_up(lines))} | {times(lines)} | {second_sites(lines)} | {least_clearance(lines)} |")


def print_summary(parts):
    print("| part of `scripts/bench/campaign.sh` | world seeds | landings | site within reach | landed safely where there was one (95 %) "
          "| unsafe touchdowns, collisions (95 %) | gave up | time to land, s (median, 90 %) | safe, but not at the first site "
          "| least true clearance |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for part, lines in parts.items():
        summary(part, lines)
        for name, some in zip(("over after a while", "lasting"), by_duration(lines)):
            if some:
                summary(f"... {name}", some)


def print_looks(lines):
    """Of landings without failures."""
    print("| look | landings | landed safely (95 %) | unsafe touchdowns, collisions | time to land, s (median, 90 %) | went to another site "
          "| least true clearance |\n|---|---:|---:|---:|---:|---:|---:|")
    for look in sorted({line["look"] for line in lines}):
        some = [line for line in lines if line["look"] == look]
        print(f"| {look} | {len(some)} | {share(len(safe(some)), len(some))} | {len(unsafe(some))} | {times(some)} | {second_sites(some)} "
              f"| {least_clearance(some)} |")


def print_failures(lines):
    print("| failure | over after a while: landed safely | lasting: landed safely | unsafe touchdowns, collisions | how the others ended |"
          "\n|---|---:|---:|---:|---|")
    by_failure = collections.defaultdict(list)
    for line in lines:
        by_failure[line["failure"]].append(line)
    for failure, some in sorted(by_failure.items()):
        over, lasting = (f"{len(safe(chosen))} of {len(chosen)}" for chosen in by_duration(some))
        ends = collections.Counter(line["reason"] for line in gave_up(some))
        print(f"| {failure} | {over} | {lasting} | {len(unsafe(some))} "
              f"| {', '.join(f'{n} {reason}' for reason, n in ends.most_common())} |")


def print_agreement(without, with_camera):
    """The same worlds with and without camera."""
    pairs = [(a, b) for a in without for b in with_camera if a["seed"] == b["seed"]]
    if not pairs:
        return
    apart_m = sorted(math.hypot(float(a["east_m"]) - float(b["east_m"]), float(a["north_m"]) - float(b["north_m"]))
                     for a, b in pairs if a["outcome"] == b["outcome"] == "safe")
    longer = sum(float(b["time_s"]) > 1.5 * float(a["time_s"]) for a, b in pairs)
    shorter = sum(float(a["time_s"]) > 1.5 * float(b["time_s"]) for a, b in pairs)
    print(f"\nOf {len(pairs)} worlds flown with and without camera {sum(a['outcome'] == b['outcome'] for a, b in pairs)} have the same verdict. "
          f"Touchdowns are {apart_m[len(apart_m) // 2]:.1f} m apart in the median. "
          f"With camera {longer} took more than half as long again, without it {shorter}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("landings", type=pathlib.Path, help="output of scripts/bench/campaign.sh, or the CSV made of one")
    parser.add_argument("--csv", type=pathlib.Path, help="also write a line for every landing here")
    options = parser.parse_args()
    if options.landings.is_dir():
        lines = read_folder(options.landings)
    elif options.landings.is_file():
        with options.landings.open(newline="") as file:
            lines = list(csv.DictReader(file))
    else:
        lines = []
    if not lines or list(lines[0]) != COLUMNS:
        print(f"campaign_tables: {options.landings}: holds no landings; name the output of scripts/bench/campaign.sh or a CSV of --csv",
              file=sys.stderr)
        return 1
    if options.csv:
        temporary = options.csv.with_name(options.csv.name + ".tmp")
        with temporary.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(lines)
        temporary.rename(options.csv)
    parts = {part: [line for line in lines if line["part"] == part] for part in PARTS}
    parts = {part: some for part, some in parts.items() if some}
    print_summary(parts)
    print()
    if "calm" in parts:
        print_looks(parts["calm"])
        print()
    failed = [line for line in lines if line["failure"]]
    if failed:
        print_failures(failed)
    print_agreement(parts.get("coarse", []), parts.get("full", []))
    return 0


if __name__ == "__main__":
    sys.exit(main())
