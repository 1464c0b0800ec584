#!/usr/bin/env bash
# What a change that only moves code must not change: simulated logs, a data set, trained weights, replays and a landing of
# fixed seeds, as a hash a file. Two builds agree if the lines are the same:
#   scripts/ci/result_hashes.sh before/build/release/bin DIR1 >before.txt
#   scripts/ci/result_hashes.sh build/release/bin DIR2 >after.txt && diff before.txt after.txt
# DIR is made, and holds what the lines are about. About a minute on two cores.
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
bin=$(realpath "$1")
work=$(realpath -m "$2")
cd "$(dirname "$0")/../.."
configs=$PWD/configs
mkdir "$work"
cd "$work"
ln -s "$configs" configs
run() { "$bin/$@" >>log.txt 2>&1 || { tail -n 20 log.txt >&2; echo "result_hashes: failed: $*" >&2; exit 1; }; }

run alight-sim -q --config configs/sim/ten_images.yaml --output logs
run alight-sim -q --config configs/sim/quick.yaml --output logs
run alight-dataset build -q --config configs/dataset/default.yaml --output data \
  --log logs/field.bag --log logs/town.bag --log logs/quick.bag
exact=(--set network.precision=float32 --set network.threads=1)
for flight in field town quick; do
  run alight-infer -q --log logs/$flight.bag --output replay/$flight --set depth_every=1 "${exact[@]}"
done
run alight-infer -q --lidar-only --log logs/quick.bag --output replay/lidar_only --set depth_every=1
run alight-infer -q --config configs/infer/paper.yaml --lidar-only --log logs/quick.bag --output replay/paper --set depth_every=1
run alight-train -q --config configs/train/demo.yaml --output run --set dataset=data --set 'split.unknown_flights=[quick]' \
  --set train.epochs=1 --set train.steps_per_epoch=6 --set validation.samples=2 --set validation.final_samples=2 \
  --set compute.threads=1
run alight-export --checkpoint run/best.pt --output weights.onnx
run alight-sim land -q --world 7 --config configs/closed_loop/coarse.yaml --lidar-only --no-bag --output landing

# Times of this machine, versions and paths are not results.
without_times() { sed -E 's/"(stages_ms|cost_s)": ?(\{[^}]*\}|[-0-9.e+]+),?//g' "$1"; }
find logs data replay landing weights.onnx -type f | LC_ALL=C sort | while read -r file; do
  case $file in
    */config.yaml | */build.yaml | *.log | */dataset.yaml | */summary.*) ;;
    *.json | *.jsonl) echo "$(without_times "$file" | sha256sum | cut -c1-16)  $file" ;;
    *) echo "$(sha256sum <"$file" | cut -c1-16)  $file" ;;
  esac
done
