#!/usr/bin/env bash
# Runs a script of the last commit on a bare Debian 12: a debootstrap minbase chroot made for it and removed after.
#   scripts/bare_machine.sh scripts/demo.sh          (default)
#   scripts/bare_machine.sh scripts/test.sh
# Needs root and debootstrap. --keep leaves the folder and says where it is.
set -euo pipefail
cd "$(dirname "$0")/.."
keep=false
if [ "${1:-}" = --keep ]; then keep=true; shift; fi
command=${1:-scripts/demo.sh}

source scripts/bare_system.sh
bare_system bookworm
git archive --format=tar --prefix=alight/ HEAD | tar -x -C "$root"
start=$SECONDS
status=0
bare_run "cd /alight && $command" || status=$?
echo "bare_machine: $command ended with $status after $((SECONDS - start)) s"
exit $status
