#!/usr/bin/env bash
# What write_events wrote, read by TensorBoard itself: tensorboard_test.sh <write_events>. Exit code 77: not installed
# and not to be had.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python=$("$here/../../../scripts/peers/python_peers.sh" tensorboard) || exit $?
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" "$work/run"
"$python" "$here/read_events.py" "$work/run"
