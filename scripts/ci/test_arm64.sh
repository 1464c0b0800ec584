#!/usr/bin/env bash
# Runs what scripts/ci/build_arm64.sh built, in emulation (qemu): the unit tests; then two simulated flights of ten images, each
# replayed through the onboard program of this machine and through that for ARM, and compared.
#   scripts/ci/test_arm64.sh                           builds what is missing of both first
#   scripts/ci/test_arm64.sh --root /media/big/arm64   where the arm64 packages are (default: build/arm64-root)
#   scripts/ci/test_arm64.sh --bin DIR                 alight-sim and alight-infer of this machine (default: build/release/bin)
#   scripts/ci/test_arm64.sh --no-build                tests what there is
#   scripts/ci/test_arm64.sh --replay                  without the unit tests
# The network computes in float32 on one thread in both. Exit code 1 if a test fails or the two disagree; the results stay
# in build/arm64/replay. Emulation tells whether the program is right, not how fast it is.
set -euo pipefail

say() { echo "test_arm64: $*"; }
fail() { say "$*" >&2; exit "${status:-1}"; }

cd "$(dirname "$0")/../.."
root=build/arm64-root
here=
build=true
unit_tests=true
while [ $# -gt 0 ]; do
  case "$1" in
    --help | -h) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --no-build) build=false; shift ;;
    --replay) unit_tests=false; shift ;;
    --root | --bin)
      [ $# -ge 2 ] || status=2 fail "$1 needs a value; --help shows examples"
      if [ "$1" = --root ]; then root=$2; else here=$2; fi
      shift 2 ;;
    *) status=2 fail "$1 is not known; --help shows the options" ;;
  esac
done

qemu=$(command -v qemu-aarch64-static || command -v qemu-aarch64) ||
  fail "the emulator is missing; apt-get install qemu-user-static"
/usr/bin/python3 -c 'import cv2, numpy' 2>/dev/null ||
  fail "the comparison needs apt-get install python3-numpy python3-opencv"
if $build; then
  scripts/ci/build_arm64.sh --root "$root"
  [ -n "$here" ] || scripts/build.sh release alight-sim alight-infer
fi
here=${here:-build/release/bin}
arm=build/arm64/bin
for program in "$here"/alight-sim "$here"/alight-infer "$arm"/alight-infer; do
  [ -x "$program" ] || fail "$program is missing; leave --no-build out"
done
emulate() { "$qemu" -L "$root" "$@"; }

failed=()
run_unit_tests() {
  local test begin log
  mkdir -p build/arm64/logs
  for test in geometry landing; do
    log=build/arm64/logs/${test}_tests.txt
    begin=$SECONDS
    emulate "$arm/${test}_tests" >"$log" 2>&1 || failed+=("${test}_tests ($log)")
    printf '%-15s %-40s %4d s\n' "${test}_tests" \
      "$(grep -E '^\[  (PASSED|FAILED|SKIPPED)  ?\] [0-9]' "$log" | sed 's/^\[ *\([A-Z]*\) *\] /\L\1 /' | paste -sd, || true)" \
      $((SECONDS - begin))
  done
}

# replay LOG OUTPUT PROGRAM...
replay() {
  local flight=$1 output=$2 begin=$SECONDS
  shift 2
  "$@" --quiet --log "$flight" --output "$output" --set depth_every=1 --set overlay_every=0 --set network.precision=float32 \
    --set network.threads=1 >"$output.txt" 2>&1 || { tail -n 20 "$output.txt" >&2; fail "the replay into $output failed"; }
  say "replayed into $output in $((SECONDS - begin)) s"
}

if $unit_tests; then run_unit_tests; fi

work=build/arm64/replay
rm -rf "$work"
mkdir -p "$work"
"$here"/alight-sim --quiet --config configs/sim/ten_images.yaml --output "$work"/logs >/dev/null
for flight in field town; do
  replay "$work"/logs/$flight.bag "$work"/$flight.here "$here"/alight-infer
  replay "$work"/logs/$flight.bag "$work"/$flight.arm64 emulate "$arm"/alight-infer
  scripts/bench/compare_results.py "$work"/$flight.here "$work"/$flight.arm64 --tolerance 1e-4 ||
    failed+=("the replay over the $flight ($work)")
done

[ ${#failed[@]} -eq 0 ] || fail "failed: ${failed[*]}"
say "all of it agrees"
