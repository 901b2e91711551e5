#!/bin/bash
# bench.sh BUILD_DIR: writes the page of 10,000 scenes of 30 bodies, and measures it in Chromium
# without a GPU.
set -eu
here=$(dirname "$0")
BATS_FILE_TMPDIR=$(realpath "$1")/bench-page
. "$here/chromium.bash"
mkdir -p "$BATS_FILE_TMPDIR"
cp "$here"/{bench.html,bench.js,tools.js} "$BATS_FILE_TMPDIR"
awk -v scenes=10000 -f "$here/many.awk" | "$1/fmb" query --local --json --force --html "$BATS_FILE_TMPDIR/many.html" > "$BATS_FILE_TMPDIR/many.json"
cp "$BATS_FILE_TMPDIR/bench.html" "$BATS_FILE_TMPDIR/drive.html"
as_chromium bench 1 '--enable-unsafe-swiftshader --use-angle=swiftshader --window-size=1400,1043'
jq -c --argjson bytes "$(wc -c < "$BATS_FILE_TMPDIR/many.html")" '{bytes: $bytes} + .' "$BATS_FILE_TMPDIR/bench.json"
