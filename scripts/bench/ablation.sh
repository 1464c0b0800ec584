#!/usr/bin/env bash
# What each loss and each way of drawing densities is worth: trains variants of configs/train/ablation.yaml at the same
# budget and writes their errors against the true depth of held-out samples as one table.
#   scripts/bench/ablation.sh [--dataset data/ten] [--work runs/ablation] [--output docs/results/ablation.md] [--set a.b=value]...
# A variant that has finished is not trained again; --set goes to all of them.
set -euo pipefail
cd "$(dirname "$0")/../.."
dataset=data/ten work=runs/ablation output=docs/results/ablation.md
common=()
while [ $# -gt 0 ]; do
  case $1 in
    --dataset) dataset=$2 ;;
    --work) work=$2 ;;
    --output) output=$2 ;;
    --set) common+=(--set "$2") ;;
    --help | -h) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "ablation: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
  shift 2
done
[ -f "$dataset/dataset.yaml" ] || {
  echo "ablation: $dataset is no data set; scripts/bench/reproduce_table.sh makes it" >&2; exit 1; }
train=build/release/bin/alight-train
[ -x "$train" ] || scripts/build.sh release alight-train

variants=(
  "all four losses, windows|"
  "without the depth loss|loss.depth_weight=0"
  "without the ratio loss|loss.ratio_weight=0"
  "without the photometric loss|loss.photometric_weight=0"
  "without the smoothness loss|loss.smoothness_weight=0"
  "depth loss squared, as in the paper|loss.depth_error=squared"
  "shares of the points, as in the paper|density.mode=share density.min_share=0.1 density.max_share=0.5"
  "shares and windows|density.mode=mixed"
  "windows, image drop-out 0.2|density.no_image_probability=0.2"
)
mkdir -p "$work"
rows=
for variant in "${variants[@]}"; do
  name=${variant%%|*}
  run=$work/$(tr -cs 'a-z0-9' '_' <<<"${name}" | sed 's/_$//')
  if [ ! -f "$run/validation.txt" ]; then
    rm -rf "$run"
    overrides=()
    for override in ${variant#*|}; do overrides+=(--set "$override"); done
    "$train" --config configs/train/ablation.yaml --set dataset="$dataset" "${overrides[@]}" "${common[@]}" \
      --output "$run" >"$run.log" 2>&1 || { tail -3 "$run.log" >&2; exit 1; }
  fi
  # The rows of the network, last column: true depth of all pixels.
  cells=$(awk '/^(P=|[0-9.]+s )/ {printf " %s |", $NF}' "$run/validation.txt")
  head=$(awk '/^(P=|[0-9.]+s )/ {printf " %s |", $1}' "$run/validation.txt")
  rule=$(awk '/^(P=|[0-9.]+s )/ {printf "---:|"}' "$run/validation.txt")
  rows+="| $name |$cells"$'\n'
  echo "$name: done"
done
{
  echo "# What each loss and each way of drawing densities is worth"
  echo
  echo "\`scripts/bench/ablation.sh\`: RMSE [mm] against the true depth of all pixels, held-out samples of the three flights that"
  echo "\`configs/train/ablation.yaml\` learns from, after 150 steps of 8 cut-outs of 128 px: the beginning of a training."
  echo "One run each with seed 1: differences of some percent say nothing, nor do larger ones without LiDAR (P=0), where"
  echo "the error still swings from step to step."
  echo
  echo "| variant |$head"
  echo "|---|$rule"
  printf '%s' "$rows"
} >"$output.partial"
mv "$output.partial" "$output"
echo "wrote $output"
