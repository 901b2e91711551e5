#!/bin/bash
# commands.sh BUILD_DIR [MESH.ply]: measures the CPU time of commands, on one core, medians of nine runs. The
# files have been read once before. The commands: replays; 'fmb log info' beside cat; a page of 10,000 scenes;
# and the article's scene of two meshes, a mesh and its mirror image: MESH times 1000, or a generated one.
set -eu
here=$(dirname "$0") build=$1 mesh=${2-} folder=$1/commands
fmb=$build/fmb
mkdir -p "$folder"
TIMEFORMAT='%3U %3S'

# seconds COMMAND...: the median of user plus system time.
seconds() {
    for _ in 1 2 3 4 5 6 7 8 9; do
        { time taskset -c 0 "$@" > "$folder/out" 2> "$folder/said" < "${input:-/dev/null}"; } 2>&1
    done | awk '{ print $1 + $2 }' | sort -n | sed -n 5p
}

# row WHAT UNITS NAME COMMAND...: prints the time of the command, which processes UNITS items called NAME, and
# the items per second.
row() {
    local took
    took=$(seconds "${@:4}")
    awk -v what="$1" -v units="$2" -v name="$3" -v took="$took" \
        'BEGIN { printf "%-36s %8.3f s   %12.4g %s a second\n", what, took, units / (took > 0 ? took : 0.001), name }'
}

blast() {
    [ -f "$folder/$1.log" ] || "$build/logs/generate" --blast "${@:2}" "$folder/$1.log"
}

sed -n 's/^model name.*: //p;T;q' /proc/cpuinfo
blast scenes scenes 400
blast pairs pairs 500000
blast pairs-64-bodies pairs 500000 --bodies 64
blast pairs-whole pairs 500000 --whole
for name in scenes pairs pairs-64-bodies pairs-whole; do
    log=$folder/$name.log
    "$fmb" replay --json "$log" > "$folder/replayed" # also reads the log into memory
    pairs=$(jq '[.. | .pairs? | numbers] | max' "$folder/replayed")
    row "replay, $name" "$pairs" pairs "$fmb" replay "$log"
    row "log info, $name" "$(stat -c %s "$log")" bytes "$fmb" log info "$log"
    row "cat, $name" "$(stat -c %s "$log")" bytes cat "$log"
done

awk -v scenes=10000 -f "$here/../page/many.awk" > "$folder/many.json"
input=$folder/many.json row "page of 10,000 scenes" 10000 scenes "$fmb" query --local --json --force --html "$folder/many.html"
echo "its size: $(stat -c %s "$folder/many.html") bytes"

scale=1000
if [ -z "$mesh" ]; then
    mesh=$folder/bumpy.ply scale=60
    "$build/mesh/make-mesh" --faces 70000 --format ply-ascii > "$mesh"
fi
row mesh 1 scenes "$fmb" mesh "$mesh" --scale $scale "$mesh" --scale -$scale,$scale,$scale --translate 50,-10,0
cat "$folder/out"
