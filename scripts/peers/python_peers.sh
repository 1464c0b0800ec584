#!/usr/bin/env bash
# Other people's programs that our files and results are tested against, in a virtual environment of their own:
#   scripts/peers/python_peers.sh tensorboard [peer...]
# Prints the environment's interpreter. The environment is build/peers, or where ALIGHT_PEERS points; what is in it
# already is not fetched again. Exit code 77, which ctest counts as skipped: it cannot be made here.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(realpath -m "${ALIGHT_PEERS:-build/peers}")

# peer -> its module, which tells whether it is there, and what pip installs
module_of() {
  case $1 in
    tensorboard) echo tensorboard ;;
    onnxruntime) echo onnxruntime ;;
    openvino) echo openvino ;;
    pymavlink) echo pymavlink ;;
    *) return 1 ;;
  esac
}
packages_of() {
  case $1 in
    tensorboard) echo 'tensorboard>=2.15,<3' pillow ;;
    onnxruntime) echo 'onnxruntime>=1.16,<2' ;;
    openvino) echo 'openvino>=2024' ;;
    pymavlink) echo 'pymavlink>=2.4.40,<3' ;;
  esac
}

skip() {
  echo "python_peers: $1" >&2
  exit 77
}

[ $# -gt 0 ] || { echo "usage: scripts/peers/python_peers.sh peer...   (peers: tensorboard, onnxruntime, openvino, pymavlink)" >&2; exit 2; }
for peer in "$@"; do
  module_of "$peer" >/dev/null || { echo "python_peers: $peer: no such peer (peers: tensorboard, onnxruntime, openvino, pymavlink)" >&2; exit 2; }
done

mkdir -p "$(dirname "$folder")"
exec 9>"$folder.lock"
flock 9 # tests run in parallel and share the environment

if ! "$folder/bin/python" -m pip --version >/dev/null 2>&1; then
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import ensurepip, venv' 2>/dev/null; then maker=$candidate; break; fi
  done
  [ -n "${maker:-}" ] || skip "no python3 with venv; install Debian's python3-venv (scripts/setup.sh does)"
  "$maker" -m venv "$folder" >&2 || skip "$folder: the virtual environment cannot be made"
fi
for peer in "$@"; do
  "$folder/bin/python" -c "import $(module_of "$peer")" 2>/dev/null && continue
  echo "python_peers: installing $peer into $folder" >&2
  read -ra packages <<<"$(packages_of "$peer")"
  "$folder/bin/python" -m pip install -q --disable-pip-version-check --timeout 20 --retries 1 "${packages[@]}" >&2 ||
    skip "$peer cannot be installed; is the Python package index within reach?"
done
echo "$folder/bin/python"
