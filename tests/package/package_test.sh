#!/usr/bin/env bash
# Installs the build tree; flies the installed tools from another folder, by the shipped files, before and after the prefix
# has moved; builds the examples against the installed CMake package and runs them.
#   package_test.sh <build folder> <C++ compiler>
set -euo pipefail
build=$1
compiler=$2
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; cat "$work/log"; exit 1; }
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }; }
# expect <text> <command...>: the command succeeds and says the text.
expect() { quietly "${@:2}"; grep -qF -- "$1" "$work/log" || fail "no \"$1\" by ${*:2}:"; }
# refused <exit code> <text> <command...>: it ends with that and says the text.
refused() {
  local status=0
  "${@:3}" >"$work/log" 2>&1 || status=$?
  [ $status -eq "$1" ] && grep -qF -- "$2" "$work/log" || fail "ended with $status, or no \"$2\", by ${*:3}:"
}

echo "== install, once with DESTDIR, and move it"
DESTDIR="$work/stage" quietly cmake --install "$build" --prefix /opt/alight
[ ! -f "$work"/stage/opt/alight/lib/systemd/system/alight-node.service ] ||
  grep -q ExecStart=/opt/alight/bin/alight_node "$work"/stage/opt/alight/lib/systemd/system/alight-node.service
prefix=$work/moved
mv "$work/stage/opt/alight" "$prefix"
for tool in "$prefix"/bin/alight-*; do expect "alight " "$tool" --version; done
bin=$prefix/bin

echo "== fly from another folder"
mkdir "$work/user"
cd "$work/user"
expect "comes with the program, $prefix/share/alight/configs/sim/quick.yaml" \
  "$bin/alight-sim" --config configs/sim/quick.yaml --output logs
expect "comes with the program, $prefix/share/alight/configs/rigs/paper.yaml" \
  "$bin/alight-infer" --log logs/quick.bag --output default
grep -qF "network: $prefix/share/alight/models/weights/default.pt" "$work/log" || fail "not the shipped network:"
quietly "$bin/alight-dataset" build --config configs/dataset/default.yaml --log logs/quick.bag --output data
quietly "$bin/alight-export" --checkpoint models/weights/default.pt --size 64 --output net.onnx
quietly "$bin/alight-train" --config configs/train/paper.yaml --print-config
quietly "$bin/alight-evaluate" --checkpoint models/weights/default.pt --data data --every 20 --output table.md
quietly "$bin/alight-sim" land --config configs/landing/default.yaml --print-config
refused 2 "configs/rigs/nowhere.yaml: is not in $work/user, and not among the files that come with the program" \
  "$bin/alight-infer" --set rig=configs/rigs/nowhere.yaml --log logs/quick.bag --output none
refused 2 "none.yaml: cannot be opened" "$bin/alight-calibrate" check --log logs/quick.bag --rig none.yaml

echo "== the same by the build tree, and by a user's own file of a shipped one's name"
expect "comes with the program, $source/configs/rigs/paper.yaml" \
  "$build/bin/alight-infer" --lidar-only --log logs/quick.bag --output by_build_tree
mkdir -p configs/rigs
cp "$prefix/share/alight/configs/rigs/paper.yaml" configs/rigs/
sed -i 's|/livox/lidar|/my_lidar|' configs/rigs/paper.yaml
refused 1 /my_lidar "$bin/alight-infer" --lidar-only --log logs/quick.bag --output own

echo "== examples on the installed package"
package=$(dirname "$(find "$prefix" -name alightConfig.cmake)")
grep -rnE '[";> (]('"/usr|/opt|$source|$build)/" "$package" >"$work/log" && fail "a path of this machine in the package:"
[ "$(ls "$prefix/include")" = alight ]
quietly cmake -S "$prefix/share/doc/libalight-dev/examples" -B "$work/examples" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix"
quietly cmake --build "$work/examples"
expect " s of LiDAR " "$work/examples/depth_of_log" logs/quick.bag "$prefix/share/alight/configs/rigs/paper.yaml" \
  "$prefix/share/alight/models/weights/default.pt"
expect "landing site of " "$work/examples/site_of_depth"
expect "1 point, 1.00 m ahead" "$work/examples/own_lidar"
# A library that is not there is named, with its package.
refused 1 "CLI11 (libcli11-dev)" cmake -S "$prefix/share/doc/libalight-dev/examples" -B "$work/without" -G Ninja \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON
