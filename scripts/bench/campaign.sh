#!/usr/bin/env bash
# The campaign of docs/results/campaign.md: landings in worlds that nobody looked at before. Stopped at any time, it goes on where it was.
#   scripts/bench/campaign.sh                       every part; 1,000 worlds cost two to four hours of a core, a hundred landings with camera three
#   scripts/bench/campaign.sh --part calm           one part only:
#       calm     no failures; no camera is flown, the LiDAR lands alone (configs/closed_loop/coarse.yaml)
#       failing  one failure of LiDAR, pose or clocks at a random moment, four of five over after 2 to 10 s; likewise without camera
#       coarse   50 worlds without camera
#       full     the same 50 with both cameras and the network
#       cameras  50 worlds with both cameras and the network, one failure of a camera at a random moment
#   scripts/bench/campaign.sh --worlds 300 --jobs 2 fewer worlds for calm and failing, two landings at a time (default: all cores)
#   scripts/bench/campaign.sh --report              only report what was flown so far
#   scripts/bench/campaign.sh --output DIR          default: out/campaign
set -euo pipefail
cd "$(dirname "$0")/../.."
worlds=1000 jobs=$(nproc) output=out/campaign report= only=
while [ $# -gt 0 ]; do
  case $1 in
    --worlds) worlds=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --output) output=$2; shift 2 ;;
    --part) only=$2; shift 2 ;;
    --report) report=--report; shift ;;
    --help | -h) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "campaign: unknown option $1 (see --help)" >&2; exit 2 ;;
  esac
done
case $only in '' | calm | failing | coarse | full | cameras) ;; *) echo "campaign: no part $only (see --help)" >&2; exit 2 ;; esac
bin=build/release/bin/alight-sim
[ -x $bin ] || scripts/build.sh release alight-sim >&2
mkdir -p "$output"
fly() {  # name of the part, options of its own
  local part=$1
  shift
  [ -z "$only" ] || [ "$only" = "$part" ] || return 0
  echo "## $part"
  if [ -n "$report" ]; then
    [ ! -d "$output/$part" ] || $bin campaign --report --output "$output/$part"
  else
    $bin campaign --jobs "$jobs" --output "$output/$part" "$@"
  fi
}
without_camera=(--config configs/closed_loop/coarse.yaml --lidar-only)
with_camera=(--set network.threads=1)  # landings at a time, not threads at a landing
passing=(--fault-from 2 --fault-to 20 --fault-duration 2,10 --lasting-share 0.2)
cameras="camera lost,camera frozen,camera black,camera over-exposed,right camera lost,cameras swapped,right camera 0.2 s late"
cameras+=",both cameras 0.2 s late with stamps as if not,camera clock 0.3 s ahead,camera clock 2 s behind"
others="LiDAR lost,LiDAR half of the points,LiDAR frozen,LiDAR rain,LiDAR mirrored left-right,LiDAR mirrored front-back"
others+=",LiDAR clock 2 s ahead,LiDAR clock 0.1 s behind,position jumps by 2 m,position lost,attitude lost,attitude frozen"
others+=",autopilot clock 1 s ahead,messages mixed up by up to 0.2 s,all messages 0.4 s late"
fly calm "${without_camera[@]}" --worlds "$worlds" --first-seed 100000
fly failing "${without_camera[@]}" --worlds "$worlds" --first-seed 104000 --faults "$others" "${passing[@]}"
fly coarse "${without_camera[@]}" --worlds 50 --first-seed 300000
fly full "${with_camera[@]}" --worlds 50 --first-seed 300000
fly cameras "${with_camera[@]}" --worlds 50 --first-seed 302100 --faults "$cameras" "${passing[@]}"
