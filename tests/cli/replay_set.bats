# The regression set: fmb answers the queries of each log again, and says that all is as it was: as
# recorded in the log, and as in the results that are kept beside it, to the byte. These with every
# instruction set; and this suite runs on what each compiler makes, with sanitizers and without.

load ../logs/set

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# The other programs need no comparison with what was recorded: their results are the same bytes.
@test "the set replays without differences" {
    for log in tests/logs/*.log; do as_it_was "$FMB_BUILD/fmb" "$log"; done
    "$FMB_BUILD/fmb" replay --prefix LAB_ tests/logs/foreign.log
    replays_the_set "$FMB_BUILD/fmb"
}

@test "the set replays without differences with plain C only" {
    replays_the_set "$FMB_BUILD/capped/fmb-plain"
}

@test "the set replays without differences with two lanes" {
    need_set two
    replays_the_set "$FMB_BUILD/capped/fmb-two"
}

@test "the set replays without differences with AVX2" {
    need_set avx2
    replays_the_set "$FMB_BUILD/capped/fmb-avx2"
}

@test "the results of another log are differences" {
    run "$FMB_BUILD/fmb" replay --golden tests/logs/stack.golden tests/logs/arm.log
    [ "$status" != 0 ]
}
