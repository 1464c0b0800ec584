#!/usr/bin/env bash
# How fast data sets are built: beside the same job in Python with python3-rosbag, numpy and OpenCV, and beside what the
# codecs of the images alone would allow. Alternating runs; prints Markdown, medians (lowest to highest).
#   scripts/bench/dataset.sh                a simulated flight at the paper's rates, made first (about a minute)
#   scripts/bench/dataset.sh --log A.bag    a log of your own; the peer reads the simulator's rig and topics only
#   --rounds N                              runs of each (default 5)
#   --work DIR                              for log and results (default: out/bench_dataset)
# Run it while nothing else wants the cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
rounds=5 log='' work=out/bench_dataset
while [ $# -gt 0 ]; do
  case $1 in
    --log) log=$2; shift 2 ;;
    --rounds) rounds=$2; shift 2 ;;
    --work) work=$2; shift 2 ;;
    --help | -h) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "bench/dataset: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
/usr/bin/python3 -c 'import rosbag, numpy, cv2, yaml' 2>/dev/null ||
  { echo "bench/dataset: the peer needs python3-rosbag, python3-numpy, python3-opencv, python3-yaml: scripts/setup.sh --full" >&2; exit 1; }
bin=build/release/bin
scripts/build.sh release alight-dataset alight-bench-dataset alight-sim >&2
mkdir -p "$work"
if [ -z "$log" ]; then
  log=$work/familiar.bag
  [ -f "$log" ] || $bin/alight-sim --config configs/sim/realtime.yaml --flight familiar --output "$work" >&2
fi
# The simulator's true depth is not part of the job.
ln -sf "$(realpath "$log")" "$work/job.bag"
config=configs/dataset/default.yaml peer=(/usr/bin/python3 scripts/peers/dataset_peer.py "$work/job.bag" "$work/peer" --rig configs/rigs/paper.yaml)
rm -f "$work"/*.jsonl
for _ in $(seq "$rounds"); do
  rm -rf "$work"/{peer,data,data.partial,codec}
  "${peer[@]}" --maps-only >>"$work/peer_maps.jsonl"
  "$bin/alight-bench-dataset" --quiet --config $config --log "$work/job.bag" --work "$work/codec" >>"$work/ours.jsonl"
  "${peer[@]}" >>"$work/peer_build.jsonl"
  begin=$(date +%s.%N)
  "$bin/alight-dataset" --quiet build --config $config --log "$work/job.bag" --output "$work/data" >/dev/null 2>&1
  echo "$begin $(date +%s.%N)" >>"$work/build.jsonl"
done
echo "$(nproc) cores,$(sed -n 's/^model name.*:/ /p' /proc/cpuinfo | head -1), $(date -u +%Y-%m-%d), $rounds rounds"
echo
/usr/bin/python3 - "$work" <<'PYTHON'
import json, pathlib, statistics, sys
import cv2
import numpy as np
work = pathlib.Path(sys.argv[1])
rows = lambda name: [json.loads(line) for line in (work / f"{name}.jsonl").read_text().splitlines()]
ours, peer_maps, peer_build = rows("ours"), rows("peer_maps"), rows("peer_build")
builds = [float(b) - float(a) for a, b in (line.split() for line in (work / "build.jsonl").read_text().splitlines())]
maps = ours[0]["maps"]
assert maps == peer_maps[0]["maps"] == peer_build[0]["maps"], "the programs made different numbers of maps"
flight = work / "data" / "job"
differing = pixels = 0
for name in ("left", "right", "depth", "offset"):
    for file in sorted((flight / name).glob("*.png")):
        a, b = (cv2.imread(str(path), cv2.IMREAD_UNCHANGED).astype(int) for path in (file, work / "peer" / name / file.name))
        differing += int((np.abs(a - b) > 1).sum())
        pixels += a.size
print(f"{maps} samples; {differing} of {pixels} values of the two programs' images differ by more than one step")
assert differing < 1e-5 * pixels, "the programs do not agree"
print()
print("| | seconds | ratio |")
print("|---|---:|---:|")
def line(name, values, ratio=""):
    print(f"| {name} | {statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f}) | {ratio} |")
ratios = lambda a, b: f"{statistics.median(x / y for x, y in zip(a, b)):.2f}"
our_maps, peer_map_s = [r["maps_seconds"] for r in ours], [r["seconds"] for r in peer_maps]
peer_build_s, codec = [r["seconds"] for r in peer_build], [r["codec_seconds"] for r in ours]
line("depth maps alone, Python", peer_map_s)
line("depth maps alone, Alight", our_maps, ratios(peer_map_s, our_maps) + " x as fast")
line("whole build, Python", peer_build_s)
line("whole build, Alight", builds, ratios(peer_build_s, builds) + " x as fast")
line("decoding and encoding the images alone, all cores", codec, ratios(codec, builds) + " of that rate is reached by the whole build")
PYTHON
