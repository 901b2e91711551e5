# The small form of the benchmark of the bus: it runs, its report is complete, and no process of it
# remains. No test depends on times.

load service

# Beside other programs a comparison may lose messages in every block: then it is measured again.
setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    for _ in 1 2 3 4; do
        timeout 300 "${FMB_BUILD:-build}/bus/bench-bus" --quick --json "$BATS_FILE_TMPDIR/report.json" \
            > "$BATS_FILE_TMPDIR/table" 2> "$BATS_FILE_TMPDIR/said" 3>&- && return
        grep -q 'lost something' "$BATS_FILE_TMPDIR/said" || break
    done
    cat "$BATS_FILE_TMPDIR/said"
    return 1
}

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    FMB_BUILD=${FMB_BUILD:-build}
    BENCH=$FMB_BUILD/bus/bench-bus
    JSON=$BATS_FILE_TMPDIR/report.json
}

# Processes that run the programs of this build, in this network namespace.
remaining_processes() {
    local program
    for program in $(find /proc/[0-9]*/exe -maxdepth 0 \( -lname '*/fmbd' -o -lname '*/bus/echo' -o -lname '*/bus/bench-bus' \)); do
        [ "$(readlink "${program%exe}ns/net")" != "$(readlink /proc/self/ns/net)" ] || echo "$program"
    done 2> /dev/null
}

nothing_left() {
    [ -z "$(remaining_processes)" ]
}

# all_there: the benchmark, fmbd and the echo run.
all_there() {
    [ "$(remaining_processes | wc -l)" -ge 3 ]
}

@test "bench-bus --quick measures every section, and its numbers are consistent" {
    wait_until nothing_left
    # Three forms of a pair, and of scenes of two sizes, on each number of cores. A placement takes 182
    # bytes whole and 85 by handle, a velocity 24. Results have handles of bodies that came whole.
    holds "$JSON" "([.pairs[].cores] | max) as \$cores | \$cores == $(($(nproc) < 2 ? 1 : 2))
            and (.pairs | length == 3 * \$cores) and (.scenes | length == 6 * \$cores)" \
        '.machine.receive_buffer > 0' \
        'all(.pairs[] | select(.form == "by handle"); .query_bytes == 48 + 2 * 89 + 24)' \
        'all(.pairs[] | select(.form != "by handle"); .query_bytes == 48 + 2 * 186 + 24)' \
        'all(.scenes[]; .pairs == 200 and .query_bytes <= 63900 and
            .query_bytes == 85 + 4 * .pairs + .bodies * (if .form == "by handle" then 89 else 186 end))' \
        'all(.scenes[]; .result_bytes > .pairs + (if .form == "by handle" then 0 else 16 * .bodies end))' \
        'all((.pairs + .scenes)[] | .service, .echo;
            .p50_us.median > 0 and .p50_us.median <= .p99_us.median and
            .p99_us.median <= .max_us.median and .p50_us.low <= .p50_us.high)' \
        'all((.pairs + .scenes)[]; .ratio_p50.median > 0 and .ratio_p99.median > 0 and
            .compute_us.median > 0 and .compute_us.median < .service.p50_us.high)'
}

@test "a section is measured by itself" {
    timeout 120 "$BENCH" --quick --section scenes --json "$BATS_TEST_TMPDIR/scenes.json" > "$BATS_TEST_TMPDIR/table" 3>&-
    wait_until nothing_left
    holds "$BATS_TEST_TMPDIR/scenes.json" 'has("scenes") and (has("pairs") | not)'
}

@test "its programs end with it, on a signal and when it is killed" {
    for signal in INT TERM KILL; do
        # A shell's background job ignores SIGINT; env gives it back.
        env --default-signal=INT "$BENCH" > "$BATS_TEST_TMPDIR/table" 3>&- &
        bench=$!
        wait_until all_there
        kill -$signal $bench
        wait $bench || true
        wait_until nothing_left
    done
}

@test "bench-bus reports a wrong option" {
    run "$BENCH" --section nowhere
    [ "$status" = 2 ]
    run "$BENCH" --quick more
    [ "$status" = 2 ]
    run "$BENCH" --help
    [ "$status" = 0 ]
}
