#!/bin/sh
# report.sh BENCH.json ACCURACY.json OUT_DIR [BUS.json]: joins what 'make bench', 'make accuracy' and,
# if the file is there, 'make bench-bus' wrote into one page, OUT_DIR/index.html, and its main picture
# only, OUT_DIR/speed-error.svg. Needs jq.
set -eu

usage='usage: report.sh BENCH.json ACCURACY.json OUT_DIR [BUS.json]'
bench=${1:?$usage} accuracy=${2:?$usage} out=${3:?$usage} bus=${4-}
here=$(dirname "$0")

fail() {
    echo "report.sh: $*" >&2
    exit 1
}

# need FILE TARGET NAME: the file is there and is a report: it has a list or a number of that name.
need() {
    [ -f "$1" ] || fail "there is no $1: 'make $2' makes it"
    jq -e ".$3 | type | . == \"array\" or . == \"number\"" "$1" > /dev/null 2>&1 ||
        fail "$1 is no report: 'make $2' makes it anew"
}

# draw NAME PROGRAM: the program's text, in the file of that name once it is whole.
draw() {
    jq -n -r -L "$here" --slurpfile bench "$bench" --slurpfile accuracy "$accuracy" \
        --slurpfile bus "$bus" \
        --rawfile page_css "$here/page.css" --rawfile picture_css "$here/picture.css" \
        "$2" > "$out/$1.part" || { rm -f "$out/$1.part" && fail "$1 could not be made"; }
    mv "$out/$1.part" "$out/$1"
}

command -v jq > /dev/null || fail "there is no jq: 'make deps-bench' installs it"
need "$bench" bench cells
need "$accuracy" accuracy families
if [ -f "$bus" ]; then need "$bus" bench-bus bus; else bus=/dev/null; fi

mkdir -p "$out"
draw speed-error.svg 'include "data"; include "speed_error";
    $accuracy[0] | sum_up | speed_error_file($picture_css)'
draw index.html 'include "page"; page($bench[0]; $accuracy[0]; $bus[0]; $page_css + $picture_css)'
echo "$out/index.html"
