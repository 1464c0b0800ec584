#!/usr/bin/env bash
# Configures and builds a preset with all cores: scripts/build.sh [preset [target...]]   (default: release, everything)
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
shift || true
# Every checkout of the same sources finds what another one compiled (ccache manual, "Compiling in different directories").
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset "$preset" >"$log" 2>&1 || { cat "$log"; exit 1; }
cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}
