#!/bin/sh
# build.sh VERSION SOVERSION: builds the packages of Debian into build/deb, from a copy of the tree. The recipe is
# this folder. 'make deps-deb' installs what it needs.
set -eu

version=$1 soversion=$2
copy=build/deb/fmb-$version
cd "$(dirname "$0")/.."
for tool in dh lintian; do
    command -v $tool > /dev/null || { echo "make deb: no $tool here; 'make deps-deb' installs it" >&2; exit 2; }
done

rm -rf build/deb
mkdir -p "$copy"
tar --exclude=./build --exclude=./.git -c . | tar -x -C "$copy"
mv "$copy/.debian" "$copy/debian"
sed -i "s/@SOVERSION@/$soversion/g" "$copy/debian/control"
for file in "$copy"/debian/*@SOVERSION@*; do
    mv "$file" "${file%@SOVERSION@*}$soversion${file##*@SOVERSION@}"
done
sed -n '/^Permission/,$ { s/^$/./; s/^/ /; p }' LICENSE >> "$copy/debian/copyright"
# The time of the last commit. In a tarball, all files have this time.
time=$(git log -1 --format=%ct -- . 2> /dev/null) || time=
time=${time:-$(stat -c %Y Makefile)}
# Some are packaged with the time that they have here.
find "$copy" -exec touch -hd "@$time" {} +
{
    printf 'fmb (%s) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n' "$version"
    printf -- ' -- %s  %s\n' "$(sed -n 's/^Maintainer: //p' .debian/control)" "$(date -uRd "@$time")"
} > "$copy/debian/changelog"
cd "$copy"
dpkg-buildpackage -b -us -uc
lintian --fail-on error,warning ../*.changes
