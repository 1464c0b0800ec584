#!/usr/bin/env bash
# Set-up, build, all tests; then the torch-free tests once more under AddressSanitizer and UBSan.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --full
scripts/build.sh asan
scripts/build.sh release
ctest --preset asan --parallel "$(nproc)"
ctest --preset release
