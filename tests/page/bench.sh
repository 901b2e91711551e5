#!/bin/bash
# bench.sh BUILD_DIR: writes the page of 10,000 scenes of 30 bodies, and measures it in Chromium
# without a GPU.
set -eu
here=$(dirname "$0")
folder=$1/bench-page
mkdir -p "$folder"
cp "$here"/{bench.html,bench.js,tools.js} "$folder"
awk -v scenes=10000 -f "$here/many.awk" | "$1/fmb" query --local --json --force --html "$folder/many.html" > "$folder/many.json"
"$here/browser.py" "$folder/bench.html" 1400 1043 --use-angle=swiftshader > "$folder/bench.json"
jq -c --argjson bytes "$(wc -c < "$folder/many.html")" \
    'if .errors == [] then {bytes: $bytes} + del(.errors, .console) else .errors[] | halt_error end' "$folder/bench.json"
