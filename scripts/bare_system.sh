# For scripts that need a bare Debian (source it): a debootstrap minbase chroot, made in $root, removed at exit.
# bare_system <suite> makes it; needs root and debootstrap. bare_run <command> runs a command line in it.
# keep=true leaves the folder and says where it is.
keep=${keep:-false}

bare_clean() {
  local mount
  for mount in dev/shm dev/pts dev sys proc; do mountpoint -q "$root/$mount" && umount "$root/$mount"; done
  $keep && echo "bare_system: kept $root" || rm -rf --one-file-system "$root"
}

bare_system() {
  [ "$(id -u)" -eq 0 ] || { echo "bare_system: needs root (chroot, mount)" >&2; exit 1; }
  command -v debootstrap >/dev/null || { echo "bare_system: install debootstrap" >&2; exit 1; }
  root=$(mktemp -d /var/tmp/alight-bare.XXXXXX)
  trap bare_clean EXIT
  debootstrap --variant=minbase "$1" "$root" >"$root.log" 2>&1 || { cat "$root.log"; exit 1; }
  rm -f "$root.log"
  mount -t proc proc "$root/proc"
  mount -t sysfs sys "$root/sys"
  mount --bind /dev "$root/dev"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  [ ! -d /etc/ssl/certs ] || { mkdir -p "$root/etc/ssl" && cp -rL /etc/ssl/certs "$root/etc/ssl/"; }
}

bare_run() {
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive bash -c "$1"
}
