#!/usr/bin/env bash
# Half an hour on board: a simulated flight at the paper's rates, over and over in real time, with the shipped network, the
# flight recorder, the ground station and a viewer that looks. Fails if memory grows or a result comes too late.
#   scripts/bench/soak.sh                          30 minutes of the familiar flight of configs/sim/realtime.yaml
#   scripts/bench/soak.sh --minutes 5 LOG.bag      another duration, your own flight
#   scripts/bench/soak.sh --growth-mb 64 --late-ms 1500   what counts as growth (after the first two minutes) and as too late
# Writes memory.csv (s, MB) and the program's own summary to out/soak. Exit code 1 if a limit is passed.
set -euo pipefail
cd "$(dirname "$0")/../.."
minutes=30 growth_mb=64 late_ms=1500 log= port=18080
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=$2; shift 2 ;;
    --growth-mb) growth_mb=$2; shift 2 ;;
    --late-ms) late_ms=$2; shift 2 ;;
    --help | -h) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "soak: unknown option $1 (see --help)" >&2; exit 2 ;;
    *) log=$1; shift ;;
  esac
done
bin=build/release/bin work=out/soak
[ -x $bin/alight-infer ] && [ -x $bin/alight-sim ] && [ -x $bin/alight-dataset ] ||
  scripts/build.sh release alight-infer alight-sim alight-dataset >&2
mkdir -p $work
if [ -z "$log" ]; then
  log=$work/familiar.bag
  [ -f $log ] || $bin/alight-sim --config configs/sim/realtime.yaml --flight familiar --output $work >&2
fi
duration_s=$($bin/alight-dataset inspect "$log" 2>/dev/null | sed -n '1s/.* topics, \([0-9.]*\) s from.*/\1/p')
rounds=$(/usr/bin/python3 -c "import math; print(math.ceil($minutes * 60 / $duration_s))")

rm -rf $work/record
$bin/alight-infer --quiet --realtime --repeat "$rounds" --log "$log" --record $work/record --web ":$port" >$work/summary.txt 2>$work/log.txt &
engine=$!
/usr/bin/python3 - $port <<'PYTHON' &
# Looks as the page does: waits for a new frame, then takes its pictures.
import json, sys, time, urllib.request
address, seen = f"http://127.0.0.1:{sys.argv[1]}", 0
def get(path):
    with urllib.request.urlopen(address + path, timeout=3) as answer:
        return answer.read()
while True:
    try:
        number = json.loads(get(f"/state?after={seen}"))["number"]
        if number != seen:
            seen = number
            for name in "left", "depth", "safe":
                get(f"/image/{name}.jpg?frame={seen}")
    except OSError:
        time.sleep(0.5)
PYTHON
viewer=$!
trap 'kill $engine $viewer 2>/dev/null || true' EXIT
begin=$SECONDS
echo "s,resident_mb" >$work/memory.csv
while kill -0 $engine 2>/dev/null; do
  resident_kb=$(sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\).*/\1/p' /proc/$engine/status 2>/dev/null) || break
  [ -z "$resident_kb" ] || echo "$((SECONDS - begin)),$((resident_kb * 1024 / 1000000))" >>$work/memory.csv
  sleep 5
done
wait $engine || { echo "soak: alight-infer failed" >&2; cat $work/log.txt >&2; exit 1; }
cat $work/summary.txt
/usr/bin/python3 - $work "$growth_mb" "$late_ms" <<'PYTHON'
import csv, pathlib, re, statistics, sys
work, growth_mb, late_ms = pathlib.Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
rows = [(int(r["s"]), int(r["resident_mb"])) for r in csv.DictReader((work / "memory.csv").open())]
last = rows[-1][0]
settled_s = min(120, last / 3)
early = statistics.median(mb for s, mb in rows if settled_s <= s < settled_s + max(60, last / 10))
late = statistics.median(mb for s, mb in rows if s > last - max(60, last / 10))
worst = float(re.search(r"([\d.]+) ms at most", (work / "summary.txt").read_text()).group(1))
print(f"{last / 60:.0f} minutes; resident memory {early:.0f} MB after {settled_s:.0f} s, {late:.0f} MB at the end, "
      f"{max(mb for _, mb in rows)} MB at most; latest result {worst:.0f} ms after its image")
failed = [text for text, bad in ((f"memory grew by more than {growth_mb:.0f} MB", late - early > growth_mb),
                                 (f"a result came later than {late_ms:.0f} ms", worst > late_ms)) if bad]
print("; ".join(failed) or "within the limits")
sys.exit(1 if failed else 0)
PYTHON
