# Functions for scripts that work in a root file system of another Debian: test-on, package wheel. Root only.

# Makes a root file system with debootstrap, unless it is there: nothing but minbase, certificates and PACKAGES.
make_root() {  # arguments: SYSTEM ROOT [PACKAGE..]
  local release system=$1 root=$2
  shift 2
  case $system in debian12) release=bookworm ;; debian13) release=trixie ;; esac
  [ ! -f "$root/../complete" ] || return 0
  echo "$(basename "$0"): making $system ($release) in $root"
  rm -rf "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase --include="$(tr ' ' , <<< "ca-certificates $*")" "$release" "$root" > "$root/../debootstrap.log"
  # As Debian's installer leaves it: a release without its updates has a browser that is too old for the tests
  cat > "$root/etc/apt/sources.list" <<< "deb http://deb.debian.org/debian $release main
deb http://deb.debian.org/debian $release-updates main
deb http://deb.debian.org/debian-security $release-security main"
  touch "$root/../complete"
}

# Runs a command inside the root file system: own mounts, the machine's certificates and proxies, and `settings` (an array
# of NAME=VALUE); otherwise a clean environment.
enter_root() {  # arguments: ROOT COMMAND
  local keep=(HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 CCACHE_DIR=/ccache)
  keep+=(SSL_CERT_FILE=/etc/ssl/certs/ca-certificates.crt PIP_CERT=/etc/ssl/certs/ca-certificates.crt
    NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt)
  for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
    [ -z "${!name:-}" ] || keep+=("$name=${!name}")
  done
  keep+=("${settings[@]}")
  unshare --mount --pid --fork --kill-child bash -c '
    root=$1 command=$2; shift 2
    mount --bind "$root" "$root"
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --rbind /sys "$root/sys"
    mount -t tmpfs tmpfs "$root/tmp"
    mount --bind /etc/ssl/certs "$root/etc/ssl/certs"
    mount --bind "$(readlink -f /etc/resolv.conf)" "$root/etc/resolv.conf"
    exec env -i "$@" chroot "$root" bash -c "$command"' enter_root "$1" "$2" "${keep[@]}"
}
