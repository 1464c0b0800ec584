#!/usr/bin/env bash
# Builds alight-infer and the tests of what flies for a 64-bit ARM computer, such as a Jetson, on a computer that is none.
#   scripts/ci/build_arm64.sh                          packages, build
#   scripts/ci/build_arm64.sh --root /media/big/arm64  the packages go there (default: build/arm64-root; 2 GB)
#   scripts/ci/build_arm64.sh --jobs 2                 compilers at once (default: all cores)
#   scripts/ci/build_arm64.sh --target alight-infer    this alone; may be repeated (default: that and four test programs)
# First it fetches Debian 12's arm64 packages (350 MB) from the archives that this machine's apt uses, and unpacks them into
# the folder: nothing of them is run or installed, and root is not needed. Then it builds with this machine's clang
# (cmake --preset arm64) into build/arm64. Run again it goes on from what it has; delete the folder for newer packages.
# scripts/ci/test_arm64.sh runs what was built, in emulation.
set -euo pipefail

# Of scripts/setup.sh's list, what alight-infer and its tests need, and the C++ library.
packages=(
  libc6-dev libstdc++-12-dev
  libtorch-dev libopenblas0-pthread libopencv-dev libeigen3-dev libyaml-cpp-dev libfmt-dev libspdlog-dev
  libcli11-dev nlohmann-json3-dev libcpp-httplib-dev libgeographiclib-dev libboost-dev libturbojpeg0-dev libxxhash-dev
  librosbag-storage-dev libsensor-msgs-dev libgeometry-msgs-dev libnav-msgs-dev libstd-msgs-dev
  libgtest-dev libgmock-dev
)

say() { echo "build_arm64: $*"; }
fail() { say "$*" >&2; exit "${status:-1}"; }

cd "$(dirname "$0")/../.."
root=build/arm64-root
jobs=$(nproc)
targets=()
while [ $# -gt 0 ]; do
  case "$1" in
    --help | -h) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --root | --jobs | --target)
      [ $# -ge 2 ] || status=2 fail "$1 needs a value; --help shows examples"
      case "$1" in
        --root) root=$2 ;;
        --jobs) jobs=$2 ;;
        --target) targets+=("$2") ;;
      esac
      shift 2 ;;
    *) status=2 fail "$1 is not known; --help shows the options" ;;
  esac
done

require_tools() {
  local missing=() tool
  for tool in clang++:clang ld.lld:lld cmake:cmake ninja:ninja-build dpkg-deb:dpkg apt-get:apt tar:tar; do
    command -v "${tool%%:*}" >/dev/null || missing+=("${tool##*:}")
  done
  [ ${#missing[@]} -eq 0 ] || fail "tools are missing; apt-get install ${missing[*]}"
  local codename
  codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
  [ "$codename" = bookworm ] || fail "the packages would be those of this machine's release ($codename); \
build on Debian 12 (bookworm): that is what was tried"
}

# apt with a state of its own, below the root: the machine's package lists and database are not touched.
private_apt() {
  apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Install-Recommends=false \
    -o Acquire::Languages=none -o APT::Sandbox::User=root -o APT::Update::Post-Invoke= \
    -o Dir::State="$store" -o Dir::State::status="$store/status" -o Dir::Cache="$store" "$@"
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    grep -qx "Package: $package" "$store/status" || echo "$package"
  done
}

# One after the other; what this leaves half done is done again by the next run.
unpack() {
  local archive
  mkdir -p "$root"/usr/{bin,lib,sbin}
  for archive in bin lib sbin; do ln -sfn usr/$archive "$root/$archive"; done
  cp "$store/status" "$store/status.new"
  for archive in "$store"/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$archive" | tar -x --no-same-owner --keep-directory-symlink -C "$root"
    { dpkg-deb -f "$archive"; printf 'Status: install ok installed\n\n'; } >>"$store/status.new"
  done
  finish_root
  mv "$store/status.new" "$store/status"
  rm -f "$store"/archives/*.deb
}

# What the packages' own scripts would do on a real machine: choose the BLAS; and links that stay inside the root.
finish_root() {
  local link target
  find "$root" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
    target=$(readlink "$link")
    ln -sfn "$(realpath -m -s --relative-to="$(dirname "$link")" "$root$target")" "$link"
  done
  for link in "$root"/usr/lib/aarch64-linux-gnu/openblas-pthread/*.so.[0-9]; do
    ln -sfn "openblas-pthread/${link##*/}" "$root/usr/lib/aarch64-linux-gnu/${link##*/}"
  done
}

fetch_packages() {
  mkdir -p "$store/lists/partial" "$store/archives/partial"
  touch "$store/status"
  local missing
  mapfile -t missing < <(missing_packages)
  if [ ${#missing[@]} -eq 0 ]; then
    say "every package is in $root"
    return
  fi
  say "fetching ${#missing[@]} packages and what they depend on"
  local log=$store/apt.log
  private_apt update >"$log" 2>&1 || { tail -n 20 "$log" >&2; fail "apt-get update failed; see $log"; }
  private_apt install -y --download-only --no-upgrade "${missing[@]}" >>"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; fail "the arm64 packages cannot be fetched; see $log"; }
  say "unpacking $(find "$store/archives" -name '*.deb' | wc -l) packages into $root"
  unpack
}

require_tools
mkdir -p "$root"
root=$(realpath "$root")
store=$root/var/lib/alight-packages
fetch_packages

say "building into build/arm64"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset arm64 -DALIGHT_ARM64_ROOT="$root" >"$log" 2>&1 || { cat "$log"; exit 1; }
nice cmake --build --preset arm64 --parallel "$jobs" ${targets:+--target "${targets[@]}"}
say "done: build/arm64/bin; scripts/ci/test_arm64.sh runs it in emulation, docs/jetson.md says how it gets on board"
