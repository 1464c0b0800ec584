#!/usr/bin/env bash
# The campaign of docs/campaign.md: landings in worlds that nobody looked at before, as many without failures as with one at
# a random moment, most of which pass after 2 to 10 s. Stopped at any time, it goes on where it was.
#   scripts/campaign.sh                             1,000 and 1,000; five to six hours of one core
#   scripts/campaign.sh --worlds 300 --jobs 2       fewer, two at a time (default: all cores)
#   scripts/campaign.sh --report                    only report what was flown so far
#   scripts/campaign.sh --output DIR                default: out/campaign
set -euo pipefail
cd "$(dirname "$0")/.."
worlds=1000 jobs=$(nproc) output=out/campaign report=
while [ $# -gt 0 ]; do
  case $1 in
    --worlds) worlds=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --output) output=$2; shift 2 ;;
    --report) report=--report; shift ;;
    --help | -h) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "campaign: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
bin=build/release/bin/alight-sim
[ -x $bin ] || scripts/build.sh release alight-sim >&2
mkdir -p "$output"
fly() {  # name of the part, options of its own
  local part=$1
  shift
  if [ -n "$report" ]; then
    $bin campaign --report --output "$output/$part"
  else
    $bin campaign --config configs/closed_loop/coarse.yaml --lidar-only --worlds "$worlds" --jobs "$jobs" --output "$output/$part" "$@"
  fi
}
echo "## Without failures"
fly calm --first-seed 100000
echo "## With one failure"
fly failing --first-seed 102000 --faults all --fault-from 2 --fault-to 20 --fault-duration 2,10 --lasting-share 0.2
