#!/usr/bin/env bash
# Exported networks in ONNX Runtime: onnxruntime_test.sh EXPORT_SAMPLES FOLDER. Exit code 77: ONNX Runtime is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python=$("$here/../../scripts/python_peers.sh" onnxruntime) || exit $?
"$1" "$2"
exec "$python" "$here/onnxruntime_test.py" "$2"
