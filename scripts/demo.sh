#!/usr/bin/env bash
# From nothing to a landing site: set-up, build, then a simulated flight log becomes sparse depth maps, a network
# learns from them and picks a landing site from a log that it has not seen.
# ALIGHT_DEMO_DIR (default: the repository) is where logs/ data/ runs/ out/ go.
set -euo pipefail
cd "$(dirname "$0")/.."
source=$PWD
work=${ALIGHT_DEMO_DIR:-$source}

scripts/setup.sh
scripts/build.sh release alight-sim alight-dataset alight-train alight-infer
bin=$source/build/release/bin

# The demo's own folders are made anew each time.
rm -rf "$work"/logs/demo "$work"/data/demo "$work"/runs/demo "$work"/out/demo
mkdir -p "$work"/logs "$work"/data "$work"/runs "$work"/out
step() { printf '\n== %s\n' "$*"; }

step "1/5 simulate three flights (two to learn from, one held out)"
"$bin"/alight-sim --config configs/sim/demo.yaml --output "$work"/logs/demo

step "2/5 flight logs -> sparse depth maps"
"$bin"/alight-dataset build --config configs/dataset/default.yaml \
  --log "$work"/logs/demo/village_train.bag --log "$work"/logs/demo/farmland_train.bag \
  --log "$work"/logs/demo/village_held_out.bag \
  --output "$work"/data/demo

step "3/5 train the completion network"
"$bin"/alight-train --config configs/train/demo.yaml --set dataset="$work"/data/demo --output "$work"/runs/demo

# Fewer refinement steps than the default (0, 1, 4, 10 packets): a few minutes of training leave every place unfamiliar.
step "4/5 fly: depth and landing sites of the held-out flight"
"$bin"/alight-infer --config configs/infer/default.yaml --checkpoint "$work"/runs/demo/best.pt \
  --set engine.image.step_growth=4 \
  --log "$work"/logs/demo/village_held_out.bag --output "$work"/out/demo

step "5/5 are the accepted sites truly safe?"
"$bin"/alight-sim score --truth "$work"/logs/demo/village_held_out.truth --results "$work"/out/demo/results.jsonl \
  --require-accepted 1

step "pictures: $work/out/demo"
find "$work"/out/demo -name '*.png' | sort | head -5
