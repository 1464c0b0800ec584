#!/usr/bin/env bash
# Times the onboard network beside Python PyTorch (eager, same version), ONNX Runtime and OpenVINO on the exported file,
# in turns on this machine and with the same number of threads; prints medians of the rounds (their range) as Markdown.
#   scripts/bench/infer.sh [--checkpoint models/weights/default.pt] [--runs 40] [--rounds 3] [--threads N]
# Peers that cannot be had are left out with a message. Run it while nothing else wants the cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
checkpoint=models/weights/default.pt runs=40 rounds=3 threads=$(nproc)
while [ $# -gt 0 ]; do
  case $1 in
    --checkpoint) checkpoint=$2 ;;
    --runs) runs=$2 ;;
    --rounds) rounds=$2 ;;
    --threads) threads=$2 ;;
    --help | -h) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "bench/infer: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
  shift 2
done
bin=build/release/bin
[ -x $bin/alight-infer ] && [ -x $bin/alight-export ] || scripts/build.sh release alight-infer alight-export >&2
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-1000} OMP_NUM_THREADS=$threads
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
$bin/alight-export --checkpoint "$checkpoint" --output "$work/net.onnx" --graph whole >/dev/null

ours() { # precision
  mkdir -p "$work/dump_$1"
  $bin/alight-infer --checkpoint "$checkpoint" --set network.precision="$1" --set network.threads="$threads" \
    --set network.device=cpu --benchmark-network --benchmark-runs "$runs" --json --dump "$work/dump_$1" 2>/dev/null
}
note() { echo "{\"who\": \"$1\", \"result\": $2}" >>"$work/results.jsonl"; }
peer() { # name, interpreter, model
  local result
  result=$("$2" scripts/bench/infer.py "$1" "$3" "$work/dump_float32" "$runs" "$threads")
  note "$1" "$result"
}
/usr/bin/python3 -c 'import torch, yaml' 2>/dev/null && has_torch=1 ||
  { has_torch=; echo "bench/infer: no Python PyTorch; scripts/setup.sh --full installs it" >&2; }
ort=$(scripts/peers/python_peers.sh onnxruntime) || ort=
openvino=$(scripts/peers/python_peers.sh openvino) || openvino=

for ((round = 1; round <= rounds; ++round)); do
  echo "round $round of $rounds" >&2
  for precision in float32 bfloat16; do
    ours $precision >"$work/ours_$precision.json"
    /usr/bin/python3 - "$work" $precision >"$work/line" <<'PYTHON'
import json, pathlib, sys, array
work, precision = pathlib.Path(sys.argv[1]), sys.argv[2]
result = json.loads((work / f"ours_{precision}.json").read_text())["learned full pass"]
def depth(name):
    values = array.array("f")
    values.frombytes((work / f"dump_{name}" / "depth_m.f32").read_bytes())
    return values
result["largest_relative_error"] = max(abs(a / b - 1) for a, b in zip(depth(precision), depth("float32")))
print(json.dumps(result))
PYTHON
    note "ours, $precision" "$(cat "$work/line")"
  done
  [ -z "$has_torch" ] || peer torch /usr/bin/python3 "$checkpoint"
  [ -z "$ort" ] || peer onnxruntime "$ort" "$work/net.onnx"
  if [ -n "$openvino" ]; then
    peer openvino "$openvino" "$work/net.onnx"
    peer openvino_bfloat16 "$openvino" "$work/net.onnx"
  fi
done
echo "$checkpoint, $runs passes a run, $rounds rounds, $threads threads,$(
  sed -n 's/^model name.*:/ /p' /proc/cpuinfo | head -1), $(date -u +%Y-%m-%d)"
echo
/usr/bin/python3 scripts/bench/infer.py table "$work/results.jsonl"
echo
for precision in float32 bfloat16; do
  echo "ours, $precision: $(cat "$work/ours_$precision.json")"
done
