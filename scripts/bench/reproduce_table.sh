#!/usr/bin/env bash
# The tables of docs/evaluation_*.md: flies the ten simulated flights, builds their data set and judges the shipped
# networks beside everything simpler, on the held-out parts of familiar flights and on flights over unknown looks.
#   scripts/bench/reproduce_table.sh             from the shipped weights: about 10 minutes to fly and build, then the tables
#   scripts/bench/reproduce_table.sh --train     from nothing: trains both networks first, hours on two cores; goes on where it
#                                          was interrupted
#   --work DIR    for logs, data set and runs (default: the repository)
#   --every N     every N-th sample is judged (default 5; 1: all)
#   --output DIR  for the tables (default: out/evaluation)
set -euo pipefail
cd "$(dirname "$0")/../.."
source=$PWD work=$PWD every=5 output= train=false
while [ $# -gt 0 ]; do
  case $1 in
    --train) train=true; shift ;;
    --work) work=$(realpath -m "$2"); shift 2 ;;
    --every) every=$2; shift 2 ;;
    --output) output=$(realpath -m "$2"); shift 2 ;;
    --help | -h) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "reproduce_table: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
output=${output:-$work/out/evaluation}
bin=$source/build/release/bin
scripts/setup.sh
scripts/build.sh release alight-sim alight-dataset alight-train alight-evaluate alight-export

flights=(village_1 village_2 village_3 forest_1 forest_2 farmland_1 farmland_2 farmland_3 rocky_unknown urban_unknown)
mkdir -p "$work"/logs/ten "$work"/data "$work"/runs "$output"
logs=()
for flight in "${flights[@]}"; do
  logs+=(--log "$work/logs/ten/$flight.bag")
  [ -f "$work/logs/ten/$flight.bag" ] ||
    "$bin"/alight-sim --config configs/sim/ten_flights.yaml --flight "$flight" --output "$work"/logs/ten
done
[ -d "$work"/data/ten ] ||
  "$bin"/alight-dataset build --config configs/dataset/ten_flights.yaml "${logs[@]}" --output "$work"/data/ten

# What lies in models/weights was exported from these two runs.
default=models/weights/default.pt paper=models/weights/paper_half.pt
if $train; then
  for name in default paper_half; do
    run=$work/runs/$name
    if [ -f "$run"/config.yaml ]; then
      "$bin"/alight-train --resume "$run"
    else
      "$bin"/alight-train --config configs/train/$name.yaml --set dataset="$work"/data/ten --output "$run"
    fi
    "$bin"/alight-export --checkpoint "$run"/best.pt --output "$run"/$name.pt
  done
  default=$work/runs/default/default.pt paper=$work/runs/paper_half/paper_half.pt
fi
for part in held_out unknown; do
  "$bin"/alight-evaluate --checkpoint "$default" --checkpoint "$paper" --data "$work"/data/ten \
    --split configs/train/default.yaml --part $part --every "$every" --output "$output"/evaluation_$part.md
done
