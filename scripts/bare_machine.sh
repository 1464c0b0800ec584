#!/usr/bin/env bash
# Runs a command of the last commit on a bare Debian: a debootstrap minbase chroot made for it and removed after.
#   scripts/bare_machine.sh scripts/demo.sh                     (default) on this machine's own release
#   scripts/bare_machine.sh --suite trixie scripts/test.sh      on Debian 13; bookworm: on Debian 12
#   scripts/bare_machine.sh --ccache ~/.cache/ccache ...        compiles into this compiler cache (default: one of its own)
#   scripts/bare_machine.sh --output DIR ...                    what the command writes to /output stays in DIR
#   scripts/bare_machine.sh --keep ...                          leaves the chroot and says where it is
# Of this machine it sees these two folders and ../shared, where it exists, and nothing else. Needs root and debootstrap.
set -euo pipefail
cd "$(dirname "$0")/.."
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
while [[ "${1:-}" = --* ]]; do
  case $1 in
    --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --keep) keep=true; shift; continue ;;
    --suite | --ccache | --output) ;;
    *) echo "bare_machine: $1 is not known; --help shows the options" >&2; exit 2 ;;
  esac
  [ $# -ge 2 ] || { echo "bare_machine: $1 needs a value; --help shows examples" >&2; exit 2; }
  case $1 in
    --suite) suite=$2 ;;
    --ccache) mkdir -p "$2"; ccache=$(realpath "$2") ;;
    --output) mkdir -p "$2"; output=$(realpath "$2") ;;
  esac
  shift 2
done
command=${1:-scripts/demo.sh}

source scripts/ci/bare_system.sh
start=$SECONDS
bare_system "$suite"
git clone -q --no-hardlinks . "$root/alight"
status=0
bare_run "cd /alight && $command" || status=$?
echo "bare_machine: $command on $suite ended with $status after $((SECONDS - start)) s"
exit $status
