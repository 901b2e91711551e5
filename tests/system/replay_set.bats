# The regression set through the service: fmbd, with every instruction set, answers the queries of
# each log as the log has them answered.

load service
load ../logs/set

# replays_the_set FMBD
replays_the_set() {
    FMBD=$1
    start_fmbd
    for log in "$LOGS"/*.log; do
        code=0
        "$FMB" replay --bus "$log" > "$BATS_TEST_TMPDIR/said" 2>&1 || code=$?
        [ $code = "$(code_of "$log")" ] ||
            { echo "$1: fmb replay --bus $log: $code"; cat "$BATS_TEST_TMPDIR/said"; return 1; }
    done
    stop_fmbd
}

@test "the service reproduces the answers of the set" {
    replays_the_set "$FMB_BUILD/fmbd"
}

@test "the service reproduces the answers of the set with plain C only" {
    replays_the_set "$FMB_BUILD/capped/fmbd-plain"
}

@test "the service reproduces the answers of the set with two lanes" {
    need_set two
    replays_the_set "$FMB_BUILD/capped/fmbd-two"
}

@test "the service reproduces the answers of the set with AVX2" {
    need_set avx2
    replays_the_set "$FMB_BUILD/capped/fmbd-avx2"
}

@test "a replay with a prefix queries the instance with that prefix" {
    FMBD=$FMB_BUILD/fmbd
    start_fmbd --prefix LAB_
    "$FMB" replay --bus --prefix LAB_ "$LOGS/foreign.log"
    stop_fmbd
}
