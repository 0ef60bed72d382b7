#!/usr/bin/env bash
# arm64_sysroot.sh DIR PACKAGE...: arm64 packages of this Debian release with their dependencies, unpacked in DIR/sysroot.
# apt works on a state of its own in DIR/apt: nothing is installed, and the system's architectures stay as they are.
set -euo pipefail
mkdir -p "$1"
cd "$1"
shift
WANTED="$* libc6-dev libstdc++-12-dev"
[ "$(cat sysroot/.packages 2>/dev/null)" != "$WANTED" ] || exit 0
echo "arm64 sysroot: downloading and unpacking packages in $PWD" >&2

rm -rf sysroot apt
mkdir -p apt/lists/partial apt/archives/partial
: >apt/status
export APT_CONFIG=$PWD/apt/apt.conf
cat >"$APT_CONFIG" <<TEXT
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "";
Binary::apt-get::APT::Keep-Downloaded-Packages "true";
Dir::State "$PWD/apt";
Dir::State::status "$PWD/apt/status";
Dir::Cache "$PWD/apt";
TEXT
apt-get update -qq
# shellcheck disable=SC2086  # a list
apt-get install -qq --download-only --yes $WANTED >/dev/null

LIBRARIES=usr/lib/aarch64-linux-gnu
mkdir -p sysroot/usr/{lib,bin,sbin}
for folder in lib bin sbin; do ln -s usr/$folder sysroot/$folder; done
for package in apt/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink --no-same-owner -C sysroot --exclude='./usr/share/doc' \
    --exclude='./usr/share/man' --exclude='./usr/share/locale' --exclude='./dev'
done
rm -r apt/archives
# BLAS and LAPACK are chosen by update-alternatives when they are installed.
for library in blas lapack; do ln -s $library/lib$library.so.3 sysroot/$LIBRARIES/lib$library.so.3; done
find sysroot -type l -lname '/*' | while read -r link; do
  ln -snfr "sysroot$(readlink "$link")" "$link"
done
echo "$WANTED" >sysroot/.packages
