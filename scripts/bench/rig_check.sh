#!/usr/bin/env bash
# The tables of docs/calibration.md on `alight-calibrate check`: ten simulated flights, checked with the true rig and with rigs
# that are turned by known angles.
#   scripts/bench/rig_check.sh     twenty minutes on two idle cores
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ $# -gt 0 ]; then
  case $1 in
    --help | -h) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "bench/rig_check: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
fi
bin=${ALIGHT_BIN:-build/release/bin}
[ -n "${ALIGHT_NO_BUILD:-}" ] || scripts/build.sh release rig_check_bench alight-sim
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/alight-sim" -q --config configs/sim/rig_check.yaml --output "$work"
"$bin/rig_check_bench" -q --logs "$work"
