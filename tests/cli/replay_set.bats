# The regression set: fmb answers the queries of each log again. The results are those recorded in the
# log and, to the byte, the goldens kept beside it. Each instruction set is compared with the goldens.
# This suite runs in each build, with sanitizers and without.

load ../ran
load ../logs/set

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# The other instruction sets need no comparison with the log: their results are the same bytes.
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

# bats test_tags=release
@test "the set replays without differences with AVX2" {
    need_set avx2
    replays_the_set "$FMB_BUILD/capped/fmb-avx2"
}

@test "the results of another log are differences" {
    run "$FMB_BUILD/fmb" replay --golden tests/logs/stack.golden tests/logs/arm.log
    [ "$status" != 0 ]
}
