#!/usr/bin/env bash
set -euo pipefail
usage() {
  cat <<'TEXT'
Times training steps of alight-train and of the same network, losses and data in Python with PyTorch, in turns on this
machine, and prints a Markdown table: medians of the rounds (their range), ours / peer.
  scripts/bench/train.sh [--dataset DIR] [--config FILE] [--steps N] [--rounds R] [--set KEY=VALUE]...
    --dataset DIR   folder of alight-dataset (default: data/ten)
    --config FILE   configuration of alight-train (default: configs/train/paper_half.yaml)
    --steps N       steps timed of each kind in each run (default: 10)
    --rounds R      runs of each program in each form (default: 3)
    --set K=V       override one key of the configuration, for both
Forms: float32 contiguous, float32 channels last, bfloat16 channels last; in each the peer does as we do. A plain PyTorch
script is the peer in float32 contiguous.
With loading: every image is read and decoded, by one worker. Fixed batch: the step alone. Augmentation is off for both.
Peak memory: of the process; the peer's worker process comes on top. Run it while nothing else wants the cores.
Needs scripts/setup.sh --full.
TEXT
}
cd "$(dirname "$0")/../.."

dataset=data/ten config=configs/train/paper_half.yaml steps=10 rounds=3 overrides=()
while [ $# -gt 0 ]; do
  case $1 in --dataset | --config | --steps | --rounds | --set)
    [ $# -ge 2 ] || { echo "bench/train: $1 needs a value" >&2; exit 2; } ;;
  esac
  case $1 in
    --dataset) dataset=$2 ;;
    --config) config=$2 ;;
    --steps) steps=$2 ;;
    --rounds) rounds=$2 ;;
    --set) overrides+=(--set "$2") ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
  shift 2
done
if [ ! -f "$dataset/dataset.yaml" ]; then
  cat >&2 <<TEXT
bench/train: $dataset is no data set; name one with --dataset, or make data/ten:
  alight-sim --config configs/sim/ten_flights.yaml --output logs/ten
  alight-dataset build --config configs/dataset/ten_flights.yaml \$(printf -- '--log %s ' logs/ten/*.bag) --output data/ten
TEXT
  exit 1
fi
/usr/bin/python3 -c 'import torch, yaml, numpy, cv2' || { echo "bench/train: run scripts/setup.sh --full" >&2; exit 1; }

# A setting of the user counts for both; alight-train would set the same one for itself alone.
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-1000} OMP_NUM_THREADS=${OMP_NUM_THREADS:-$(nproc)}
train=build/release/bin/alight-train
[ -x "$train" ] || scripts/build.sh release alight-train >&2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# No cache: the peer decodes every image, so do we. The peer has no augmentation.
same=(--set "dataset=$dataset" --set train.cache_mb=0 --set train.workers=1 --set optimizer.accumulate=1
  --set "compute.threads=$OMP_NUM_THREADS")
for look in horizontal_flip vertical_flip quarter_turn jitter; do
  same+=(--set "augmentation.${look}_probability=0")
done
for ((round = 1; round <= rounds; ++round)); do
  for form in "float32 contiguous" "float32 channels_last" "bfloat16 channels_last"; do
    "$train" --config "$config" "${same[@]}" "${overrides[@]}" --set "compute.precision=${form% *}" \
      --set "compute.memory_format=${form#* }" --print-config >"$work/resolved.yaml"
    for who in ours peer; do
      echo "round $round of $rounds, $form: $who" >&2
      if [ $who = ours ]; then
        result=$("$train" --config "$work/resolved.yaml" --benchmark --benchmark-steps "$steps" --json)
      else
        result=$(/usr/bin/python3 scripts/bench/train.py --config "$work/resolved.yaml" --steps "$steps")
      fi
      echo "{\"form\": \"${form/_/ }\", \"who\": \"$who\", \"result\": $result}" >>"$work/results.jsonl"
    done
  done
done

echo "$config, $steps steps a run, $rounds rounds, $OMP_NUM_THREADS threads,$(
  sed -n 's/^model name.*:/ /p' /proc/cpuinfo | head -1), $(date -u +%Y-%m-%d)"
echo
/usr/bin/python3 scripts/bench/train.py --table "$work/results.jsonl"
