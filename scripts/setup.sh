#!/usr/bin/env bash
# Installs what Alight needs from the package archive of Debian 13 or 12: the names are the same, the versions are not. Safe to
# run again; needs root or sudo.
#   scripts/setup.sh          what the build and the tests need
#   scripts/setup.sh --full   and what the comparisons with LibTorch's Python side, the ROS node's test and the test in a
#                             browser need (else skipped)
#   scripts/setup.sh --nightly  and what scripts/ci/nightly.sh needs
set -euo pipefail

packages=(
  # tool chain
  clang lld libomp-dev clang-format-19 libclang-rt-dev cmake ninja-build ccache git ca-certificates pkg-config
  file dpkg-dev  # for cpack
  # libraries
  libtorch-dev libgloo-dev libopenblas0-pthread libopencv-dev libeigen3-dev libyaml-cpp-dev libfmt-dev libspdlog-dev
  libcli11-dev nlohmann-json3-dev libcpp-httplib-dev libgeographiclib-dev libembree-dev libtbb-dev libonnx-dev libprotobuf-dev
  libceres-dev protobuf-compiler libboost-dev libturbojpeg0-dev libxxhash-dev
  # ROS 1 logs
  librosbag-storage-dev libsensor-msgs-dev libgeometry-msgs-dev libnav-msgs-dev libstd-msgs-dev
  # ROS 1 node (its build; a machine that has these but no master skips the node's test)
  libroscpp-dev libtopic-tools-dev libdiagnostic-msgs-dev libstd-srvs-dev libtf2-msgs-dev libvisualization-msgs-dev
  # tests and benchmarks
  libgtest-dev libgmock-dev libbenchmark-dev python3-rosbag python3-venv
)
full_packages=(python3-torch python3-yaml python3-numpy python3-opencv chromium
               opencv-doc                     # real stereo images of a chessboard
               python3-roslaunch python3-rosmaster rosout)  # a ROS 1 master; python3-rosbag plays
nightly_packages=(g++ clang-tidy debootstrap doxygen gcovr)

case "${1:-}" in
  "") ;;
  --full) packages+=("${full_packages[@]}") ;;
  --nightly) packages+=("${full_packages[@]}" "${nightly_packages[@]}") ;;
  *) echo "usage: scripts/setup.sh [--full | --nightly]" >&2; exit 2 ;;
esac
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case $release in
  bookworm | trixie) ;;
  *) echo "setup: this is $release, not Debian 13 (trixie) or 12 (bookworm); its packages may not fit" >&2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "setup: every package is installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: root or sudo is needed to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup: installing ${#missing[@]} packages"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
