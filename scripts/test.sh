#!/usr/bin/env bash
# Set-up, build, and the tests that a person waits for: all but those labelled slow; then the unit tests that are free of
# torch once more under AddressSanitizer and UBSan. The rest runs in scripts/ci/nightly.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
step() { printf '\n== %s (%d min %d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }
step "packages"
scripts/setup.sh --full
step "release build"
scripts/build.sh release
step "tests"
ctest --preset release --parallel "$(nproc)" --label-exclude slow
step "sanitizer build"
scripts/build.sh asan unit_tests
step "unit tests under sanitizers"
ctest --preset asan --parallel "$(nproc)" --label-regex unit --label-exclude slow
step "done"
