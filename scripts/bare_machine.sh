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
[ "$(id -u)" -eq 0 ] || { echo "bare_machine: needs root (chroot, mount)" >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "bare_machine: install debootstrap" >&2; exit 1; }

root=$(mktemp -d /var/tmp/alight-bare.XXXXXX)
clean() {
  for mount in dev/shm dev/pts dev sys proc; do mountpoint -q "$root/$mount" && umount "$root/$mount"; done
  $keep && echo "bare_machine: kept $root" || rm -rf --one-file-system "$root"
}
trap clean EXIT

debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$root.log" 2>&1 || { cat "$root.log"; exit 1; }
rm -f "$root.log"
mount -t proc proc "$root/proc"
mount -t sysfs sys "$root/sys"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf /etc/hosts "$root/etc/"
[ -d /etc/ssl/certs ] && mkdir -p "$root/etc/ssl" && cp -rL /etc/ssl/certs "$root/etc/ssl/"
git archive --format=tar --prefix=alight/ HEAD | tar -x -C "$root"
start=$SECONDS
status=0
chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  bash -c "cd /alight && $command" || status=$?
echo "bare_machine: $command ended with $status after $((SECONDS - start)) s"
exit $status
