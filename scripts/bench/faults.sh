#!/usr/bin/env bash
# The tables of docs/failures.md: every failure on a simulated flight, by the LiDAR alone and with the shipped network, and the false
# alarms of healthy flights.
#   scripts/bench/faults.sh [--logs DIR]     about five minutes on two idle cores
#   --logs DIR    flight logs (*.bag) that are healthy: counts the results with a finding
#   --output FILE (default: docs/failures.md)
set -euo pipefail
cd "$(dirname "$0")/../.."
logs= output=docs/failures.md
while [ $# -gt 0 ]; do
  case $1 in
    --logs) logs=$(realpath -m "$2"); shift 2 ;;
    --output) output=$(realpath -m "$2"); shift 2 ;;
    --help | -h) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "faults: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
bin=build/release/bin
[ -n "${ALIGHT_NO_BUILD:-}" ] || scripts/build.sh release faults_tests alight-infer
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
ALIGHT_FAULTS_THOROUGH=1 ALIGHT_FAULT_TABLE=$work/rows GOMP_SPINCOUNT=1000 $bin/faults_tests >"$work/log" 2>&1 || failed=1

table() {  # makers
  echo "| failure | noticed after | finding | state | frames with depth | sites accepted | of them unsafe |"
  echo "|---|---:|---|---|---:|---:|---:|"
  sed -n "s/^| $1 | /| /p" "$work/rows"
}
{
  sed '/^<!-- What follows/q' docs/failures.md
  printf '\n## With the shipped network\n\n'
  table network
  printf '\n## By the LiDAR alone\n\n'
  table 'LiDAR alone'
  if [ -n "$logs" ]; then
    printf '\n## False alarms\n\nResults of healthy simulated flights, and those with a finding:\n\n'
    printf '| flight | results | with a finding |\n|---|---:|---:|\n'
    for log in "$logs"/*.bag "$logs"/*/*.bag; do
      [ -f "$log" ] || continue
      flight=$(basename "$log" .bag)
      $bin/alight-infer --quiet --lidar-only --set overlay_every=0 --log "$log" --output "$work/$flight" >/dev/null 2>&1
      results=$work/$flight/results.jsonl
      printf '| %s | %d | %d |\n' "$flight" "$(wc -l <"$results")" "$(grep -vc '"health":{"state":"ok"' "$results" || true)"
    done
  fi
} >"$work/page"
mv "$work/page" "$output"
[ $failed = 0 ] || { grep -E '^\[  FAILED' "$work/log"; exit 1; }
