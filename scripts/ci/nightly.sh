#!/usr/bin/env bash
# What is too long to wait for at every change; run before a release, or every night:
#   scripts/ci/nightly.sh                        all of it, in this order
#   scripts/ci/nightly.sh slow sanitizers        these parts alone
# slow        the tests labelled slow
# sanitizers  all tests that are free of torch, under AddressSanitizer and UBSan; threads under ThreadSanitizer
# gcc         everything compiles without a warning by gcc, too
# tidy        clang-tidy over all sources
# coverage    which lines the unit tests run: build/coverage/coverage/index.html
# fuzz        a minute of every fuzz target, and damaged bags (scripts/ci/fuzz.sh)
# suites      as root with debootstrap: the tests and the demo on bare Debian 12 and 13, and both releases' results compared
# packages    as root with debootstrap: Debian packages on a bare system
# A part that fails does not keep the next from running. Exit code 1 if one failed. Logs: out/nightly/.
set -uo pipefail
cd "$(dirname "$0")/../.."
jobs=$(nproc)

slow() { scripts/build.sh release && ctest --preset release --parallel "$jobs" --label-regex slow; }
sanitizers() {
  scripts/build.sh asan && ctest --preset asan --parallel "$jobs" &&
    scripts/build.sh tsan onboard_tests web_tests &&
    TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp build/tsan/bin/onboard_tests &&
    TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp build/tsan/bin/web_tests
}
gcc() { scripts/build.sh gcc; }
tidy() {
  cmake --preset dev >/dev/null && cmake --build --preset dev --target alight_torch_pch alight_event_file &&
    run-clang-tidy -quiet -p build/dev -j "$jobs" "$PWD/(?!build)"
}
coverage() { scripts/build.sh coverage coverage; }
fuzz() { scripts/ci/fuzz.sh --jobs "$jobs"; }
suites() {
  local suite status=0
  for suite in bookworm trixie; do
    scripts/bare_machine.sh --suite $suite --ccache ~/.cache/ccache scripts/test.sh || status=1
    scripts/bare_machine.sh --suite $suite --ccache ~/.cache/ccache scripts/demo.sh || status=1
  done
  scripts/ci/compare_releases.sh || status=1
  return $status
}
packages() { scripts/build.sh release && scripts/ci/package_check.sh; }

all=(slow sanitizers gcc tidy coverage fuzz suites packages)
[ "${1:-}" != --help ] || { sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 0; }
for part in "$@"; do
  [[ " ${all[*]} " = *" $part "* ]] || { echo "nightly: $part is no part (parts: ${all[*]})" >&2; exit 2; }
done
[ $# -gt 0 ] || set -- "${all[@]}"
scripts/setup.sh --nightly || exit 1
mkdir -p out/nightly
failed=()
for part in "$@"; do
  begin=$SECONDS
  "$part" >out/nightly/"$part".log 2>&1 || failed+=("$part")
  printf '%-10s %-6s %3d min   out/nightly/%s.log\n' "$part" \
    "$([[ " ${failed[*]} " = *" $part "* ]] && echo failed || echo ok)" $(((SECONDS - begin) / 60)) "$part"
done
[ ${#failed[@]} -eq 0 ]
