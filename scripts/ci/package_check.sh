#!/usr/bin/env bash
# Makes the Debian packages of a build tree. As root with debootstrap: installs `alight` on a bare system of this machine's
# Debian release and flies there, from a folder of its own, by nothing but what the package brought.
#   scripts/ci/package_check.sh [--keep] [build folder]      (default: build/release; --keep leaves the bare system)
set -euo pipefail
cd "$(dirname "$0")/../.."
keep=false
if [ "${1:-}" = --keep ]; then keep=true; shift; fi
build=$(cd "${1:-build/release}" && pwd)
packages=$build/packages

rm -rf "$packages"
cpack --config "$build/CPackConfig.cmake" -B "$packages" >"$build/cpack.log" 2>&1 || { cat "$build/cpack.log"; exit 1; }
rm -rf "$packages/_CPack_Packages"
for package in "$packages"/*.deb; do
  echo "package_check: $package, $(du -h "$package" | cut -f1)"
  dpkg-deb --field "$package" Package Version Section Depends
done
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "package_check: not installed: that needs root and debootstrap"
  exit 0
fi

source scripts/ci/bare_system.sh
bare_system "$(. /etc/os-release && echo "$VERSION_CODENAME")"
cp "$packages"/alight_*.deb "$root/root/"
bare_run "apt-get update -q && apt-get install -y -q --no-install-recommends /root/alight_*.deb" >"$build/cpack.log" 2>&1 ||
  { cat "$build/cpack.log"; exit 1; }
bare_run "mkdir /root/flights && cd /root/flights &&
  alight-sim --config configs/sim/quick.yaml --output logs &&
  alight-infer --log logs/quick.bag --output out &&
  alight-sim score --truth logs/quick.truth --results out/results.jsonl --require-accepted 1 --require-safe-share 1 &&
  dpkg --verify alight"
echo "package_check: flew to accepted sites on a bare system"
