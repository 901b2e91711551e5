# The regression set: fmb answers the queries of each log again, and says that all is as it was: as
# recorded in the log, and as in the results that are kept beside it, to the byte. With every
# instruction set; and this suite runs on what each compiler makes, with sanitizers and without.

load ../logs/set

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# as_it_was FMB LOG OPTIONS...
as_it_was() {
    fmb=$1 log=$2
    shift 2
    code=0
    "$fmb" replay --json "$@" "$log" > "$BATS_TEST_TMPDIR/said" 2> "$BATS_TEST_TMPDIR/log" || code=$?
    [ $code = "$(code_of "$log")" ] && jq -e '.different == 0 and .same > 0' "$BATS_TEST_TMPDIR/said" > /dev/null ||
        { echo "$fmb replay $* $log: $code"; cat "$BATS_TEST_TMPDIR/said" "$BATS_TEST_TMPDIR/log"; return 1; }
}

# replays_the_set FMB
replays_the_set() {
    for log in tests/logs/*.log; do
        as_it_was "$1" "$log"
        as_it_was "$1" "$log" --golden "${log%.log}.golden" \
            --force --write-golden "$BATS_TEST_TMPDIR/golden"
        cmp "$BATS_TEST_TMPDIR/golden" "${log%.log}.golden"
    done
    "$1" replay --prefix LAB_ tests/logs/foreign.log
}

@test "the set replays without differences" {
    replays_the_set "$FMB_BUILD/fmb"
}

@test "the set replays without differences with plain C only" {
    replays_the_set "$FMB_BUILD/capped/fmb-plain"
}

@test "the set replays without differences with SSE2" {
    need_set sse2
    replays_the_set "$FMB_BUILD/capped/fmb-sse2"
}

@test "the set replays without differences with AVX2" {
    need_set avx2
    replays_the_set "$FMB_BUILD/capped/fmb-avx2"
}

@test "the results of another log are differences" {
    run "$FMB_BUILD/fmb" replay --golden tests/logs/stack.golden tests/logs/arm.log
    [ "$status" != 0 ]
}
