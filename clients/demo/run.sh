#!/bin/sh
# run.sh BUILD_DIR: lets the service answer a scene, shows the answers, and writes a page that plays
# them. Runs in a private network, leaves nothing running, and ends by itself.
set -u

build=${1:?usage: run.sh BUILD_DIR}
inside=${2-}
out=$build/demo
page=$out/scene.html
arm=$(dirname "$0")/arm.json
fmbd=

say() {
    printf '\n== %s\n' "$*"
}

explain() {
    # A scene of one's own, to begin with.
    cp "$(dirname "$0")/cube.json" "$out/mine.json"
    say "your own scene: change $out/mine.json, then query it in process, without a network"
    echo "$build/fmb query --local --box $out/mine.json"
    "$build/fmb" query --local --box "$out/mine.json"
    say "or the service on the bus"
    echo "$build/fmbd &"
    echo "$build/fmb query --box $out/mine.json"
    robot=$(dirname "$0")/robot
    say "a URDF robot with meshes, on a path: what it meets between the rows of its table"
    set -- path "$robot/robot.urdf" --joints-csv "$robot/path.csv" --with "$robot/world.json" --ignore base,table
    echo "$build/fmb $*"
    "$build/fmb" "$@"
    say "--json for programs, --html FILE for a page; $build/fmb query --help says more"
}

# query [OPTIONS]: what meets in the scenes of the arm.
query() {
    "$build/fmb" query --contacts --html "$page" "$@" "$arm"
}

stop_fmbd() {
    [ -z "$fmbd" ] && return
    kill "$fmbd" 2> /dev/null
    wait "$fmbd" 2> /dev/null
    fmbd=
}

# Waits until the service is ready: 10 s at most, and no longer than it lives.
wait_for_fmbd() {
    tries=100
    while ! grep -q ready "$out/fmbd.log"; do
        tries=$((tries - 1))
        if [ $tries = 0 ] || ! kill -0 "$fmbd" 2> /dev/null; then
            echo "run.sh: fmbd did not start:" >&2
            cat "$out/fmbd.log" >&2
            return 1
        fi
        sleep 0.1
    done
}

on_the_bus() {
    trap stop_fmbd EXIT
    trap 'exit 1' HUP INT TERM
    "$build/fmbd" 2> "$out/fmbd.log" &
    fmbd=$!
    wait_for_fmbd || return 1
    say "$build/fmb query --contacts --html $page $arm"
    query || return 1
    say "$build/fmb status"
    "$build/fmb" status
}

in_process() {
    say "network namespaces are forbidden here, and there is no route for multicast:" \
        "the same scene without the bus"
    say "$build/fmb query --contacts --local --html $page $arm"
    query --local
}

mkdir -p "$out" || exit 1
if [ "$inside" = inside ]; then
    on_the_bus
    exit
fi

"$build/netns" "$0" "$build" inside
code=$?
if [ $code = 77 ]; then
    in_process
    code=$?
fi
[ $code = 0 ] || exit $code
say "the page: $page (open it in a browser)"
explain
