#!/usr/bin/env bash
# Unpacks Debian's arm64 packages into build/arm64/root: the libraries of the preset rig-arm64, and the programs that a
# guest runs. Nothing in it is installed on this machine. scripts/setup arm64 and hil-arm64 call it.
# A folder, and not `apt install PACKAGE:arm64`, because liblcm-dev and libhdf5-dev exclude their amd64 versions.
set -euo pipefail
cd "$(dirname "$0")/.."
packages=(
  libc6-dev libstdc++-12-dev libeigen3-dev liblcm-dev libtomlplusplus-dev libcli11-dev libspdlog-dev nlohmann-json3-dev
  libboost-dev libhdf5-dev libzstd-dev libgtest-dev
  bash busybox-static coreutils findutils grep util-linux procps iproute2 can-utils libc-bin
)
root=build/arm64/root
. /etc/os-release  # the release of the cross compiler
[ "$VERSION_CODENAME" = bookworm ] || packages=("${packages[@]/libstdc++-12/libstdc++-14}")
wanted="$VERSION_CODENAME $(sha256sum < scripts/arm64_root.sh)"
[ "$(cat $root/complete 2>/dev/null)" != "$wanted" ] || exit 0
echo "setup: unpacking ${#packages[@]} arm64 packages of $VERSION_CODENAME, and what they need, into $root"
rm -rf $root
mkdir -p $root
# The hook makes dpkg's database, as if the packages were installed: dpkg-shlibdeps finds in it which package a library is from.
# shellcheck disable=SC2016  # expanded by the hook's shell
hook='for deb in "$1"/var/cache/apt/archives/*.deb; do
  info=$1/var/lib/dpkg/info; mkdir -p $info; echo 1 > $info/format
  name=$(dpkg-deb -f $deb Package)
  [ "$(dpkg-deb -f $deb Multi-Arch)" != same ] || name=$name:arm64
  dpkg-deb --fsys-tarfile $deb | tar -t | sed "s#^\.##; s#/\$##; /^\$/d" > $info/$name.list
  for file in symbols shlibs; do ! dpkg-deb -I $deb $file > $info/$name.$file 2>/dev/null || continue; rm $info/$name.$file; done
  { dpkg-deb -f $deb Package Version Architecture Multi-Arch Maintainer Description Provides; echo Status: install ok installed; echo; } >> $1/var/lib/dpkg/status
done'
mmdebstrap --quiet --variant=extract --arch=arm64 --include="$(IFS=,; echo "${packages[*]}")" --extract-hook="$hook" "$VERSION_CODENAME" $root
echo "$wanted" > $root/complete
