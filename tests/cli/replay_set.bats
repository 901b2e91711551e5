# The regression set: fmb answers the queries of each log again, and says that all is as it was: as
# recorded in the log, and as in the results that are kept beside it. With every instruction set.

load ../logs/set

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# replays_the_set FMB
replays_the_set() {
    for log in tests/logs/*.log; do
        "$1" replay "$log" > "$BATS_TEST_TMPDIR/said" 2>&1 ||
            { echo "$1 replay $log:"; cat "$BATS_TEST_TMPDIR/said"; return 1; }
        "$1" replay --golden "${log%.log}.golden" "$log" > "$BATS_TEST_TMPDIR/said" 2>&1 ||
            { echo "$1 replay --golden ${log%.log}.golden $log:"; cat "$BATS_TEST_TMPDIR/said"; return 1; }
    done
    "$1" replay --prefix LAB_ tests/logs/foreign.log
}

@test "all is as it was" {
    replays_the_set "$FMB_BUILD/fmb"
}

@test "all is as it was with plain C alone" {
    replays_the_set "$FMB_BUILD/capped/fmb-plain"
}

@test "all is as it was with SSE2" {
    need_set sse2
    replays_the_set "$FMB_BUILD/capped/fmb-sse2"
}

@test "all is as it was with AVX2" {
    need_set avx2
    replays_the_set "$FMB_BUILD/capped/fmb-avx2"
}

@test "another answer is another one: with the results of another log nothing is as it was" {
    run "$FMB_BUILD/fmb" replay --golden tests/logs/stack.golden tests/logs/arm.log
    [ "$status" != 0 ]
}
