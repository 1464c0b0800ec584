#!/usr/bin/env bash
# Exported networks in ONNX Runtime: onnxruntime_test.sh EXPORT_SAMPLES. Exit code 77: ONNX Runtime is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python=$("$here/../../../scripts/peers/python_peers.sh" onnxruntime) || exit $?
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" "$work"
"$python" "$here/onnxruntime_test.py" "$work"
