#!/usr/bin/env bash
# Configures and builds a preset (default: release) with all cores.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
cmake --preset "$preset" >"/tmp/alight-configure-$$.log" || { cat "/tmp/alight-configure-$$.log"; exit 1; }
rm -f "/tmp/alight-configure-$$.log"
cmake --build --preset "$preset" --parallel "$(nproc)"
