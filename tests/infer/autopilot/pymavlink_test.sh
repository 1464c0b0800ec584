#!/usr/bin/env bash
# Our MAVLink frames in pymavlink: pymavlink_test.sh MAVLINK_SAMPLES. Exit code 77: pymavlink is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
python=$("$here/../../../scripts/peers/python_peers.sh" pymavlink) || exit $?
"$1" | "$python" "$here/pymavlink_test.py"
