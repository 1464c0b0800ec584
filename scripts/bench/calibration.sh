#!/usr/bin/env bash
# The table of docs/calibration.md: boards before 20 random mountings of the LiDAR, simulated, calibrated, held against the
# truth. Fails where a requirement is not met.
#   scripts/bench/calibration.sh [--mountings N] [--first-seed N]     four to six minutes on two idle cores
set -euo pipefail
cd "$(dirname "$0")/../.."
mountings=20
first_seed=101
while [ $# -gt 0 ]; do
  case $1 in
    --mountings) mountings=$2; shift 2 ;;
    --first-seed) first_seed=$2; shift 2 ;;
    --help | -h) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "bench/calibration: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
bin=${ALIGHT_BIN:-build/release/bin}
[ -n "${ALIGHT_NO_BUILD:-}" ] || scripts/build.sh release calibration_bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/calibration_bench" --config configs/sim/board.yaml --work "$work" --mountings "$mountings" --first-seed "$first_seed"
