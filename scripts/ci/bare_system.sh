# For scripts that need a bare Debian (source it): a debootstrap minbase chroot, made in $root, removed at exit.
#   bare_system <suite>      makes it; needs root and debootstrap
#   bare_run <command>       runs a command line in it, with mounts and processes of its own that end with it
# keep=true leaves the folder and says where it is. Of this machine a command sees ../shared, where it exists, the folder
# $ccache as its compiler cache and the folder $output as /output, where they are set, and nothing else.
keep=${keep:-false}
ccache=${ccache:-}
output=${output:-}

bare_clean() { if $keep; then echo "bare_system: kept $root"; else rm -rf --one-file-system "$root"; fi; }

bare_system() {
  [ "$(id -u)" -eq 0 ] || { echo "bare_system: needs root (chroot, mount)" >&2; exit 1; }
  command -v debootstrap >/dev/null || { echo "bare_system: install debootstrap" >&2; exit 1; }
  [[ $1 =~ ^(bookworm|trixie)$ ]] || { echo "bare_system: suite $1 is not supported; name bookworm or trixie" >&2; exit 2; }
  root=$(mktemp -d /var/tmp/alight-bare.XXXXXX)
  trap bare_clean EXIT
  debootstrap --variant=minbase "$1" "$root" >"$root.log" 2>&1 || { cat "$root.log"; rm -f "$root.log"; exit 1; }
  rm -f "$root.log"
  chmod 755 "$root"  # apt downloads as a user of its own
  mkdir -p "$root/shared" "$root/output" "$root/root/.cache/ccache"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  # The authorities that this machine trusts, its network's own among them.
  local certificates=/etc/ssl/certs/ca-certificates.crt
  if [ -e $certificates ]; then cp -L $certificates "$root/etc/machine-certificates.crt"; fi
  # No fsync for every file of a package: the folder is thrown away.
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/throw-away"
}

bare_run() {
  unshare --mount --pid --fork --kill-child bash -euc '
    root=$1 shared=$2 ccache=$3 output=$4 command=$5
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sys "$root/sys"
    mount --bind /dev "$root/dev"
    mount -t devpts -o newinstance,ptmxmode=0666,mode=0620,gid=5 devpts "$root/dev/pts"
    mount --bind "$root/dev/pts/ptmx" "$root/dev/ptmx"
    mount -t tmpfs tmpfs "$root/dev/shm"
    if [ -d "$shared" ]; then mount --bind -o ro "$shared" "$root/shared"; fi
    if [ -n "$ccache" ]; then mount --bind "$ccache" "$root/root/.cache/ccache"; fi
    if [ -n "$output" ]; then mount --bind "$output" "$root/output"; fi
    trust=()
    if [ -e "$root/etc/machine-certificates.crt" ]; then
      trust=(SSL_CERT_FILE=/etc/machine-certificates.crt PIP_CERT=/etc/machine-certificates.crt)
    fi
    chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive "${trust[@]}" bash -c "$command"
  ' bare_run "$root" "$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/shared" "$ccache" "$output" "$1"
}
