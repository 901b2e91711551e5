#!/bin/sh
# unpack_aarch64.sh: unpacks the libraries of AArch64 that fmb is linked with into build/aarch64. They
# come from the package sources of this machine. apt's files of that architecture stay in that folder
# too, and nothing is installed. Needs no root.
set -eu

cd "$(dirname "$0")/.."
root=$PWD/build/aarch64 apt=$PWD/build/aarch64/apt
[ ! -d "$root/usr" ] || exit 0
libraries='liblcm1|libcjson1|libexpat1|libgmp10|libglib2.0-0|libpcre2-8-0|libseccomp2|zlib1g'
headers='liblcm-dev|libcjson-dev|libexpat1-dev|libgmp-dev|libglib2.0-dev|libseccomp-dev|zlib1g-dev'

mkdir -p "$apt/lists/partial" "$apt/archives/partial"
: > "$apt/status"
in_folder() {
    command=$1
    shift
    "$command" -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$apt" \
        -o Dir::State::status="$apt/status" -o Dir::Cache="$apt" -o APT::Sandbox::User= "$@"
}

in_folder apt-get update
# Debian 13 marks libraries whose times have 64 bits everywhere.
packages=$(in_folder apt-cache search --names-only "^(($libraries)(t64)?|$headers)\$" | cut -d ' ' -f 1)
cd "$apt"
# shellcheck disable=SC2086
in_folder apt-get download $packages
for package in *.deb; do
    dpkg -x "$package" unpacked
done
mv unpacked/usr "$root"
