# The soak's trials, a second or two each: 'make soak' runs them for a minute.

: "${FMB_BUILD:=build}"

# trial NAME [SECONDS]: what it prints is in $report.
trial() {
    mkdir -p "$FMB_BUILD/soak"
    report=$(timeout 120 tests/soak/soak.sh "$FMB_BUILD" "${2:-1}" "$1" 3>&-)
    echo "$report"
}

status_was() {
    jq -e "$2" "$FMB_BUILD/soak/$1.status"
}

# bats test_tags=release
@test "no answer is lost or wrong, to pairs and to scenes" {
    FMB_SOAK_RATE=1000 trial rate 2
    jq -e '.queries > 1000' <<< "$report"
    trial pairs
    status_was pairs '.pairs > 100 and .scenes == 0'
    trial scenes
    status_was scenes '.scenes > 10'
}

# bats test_tags=release
@test "no answer is lost or wrong with sixteen clients at once" {
    trial crowd
    jq -e '.clients == 16 and .queries >= 16' <<< "$report"
}

# bats test_tags=release
@test "no answer is lost or wrong while the service is killed and started again" {
    trial killed 2
    jq -e '.outages >= 1 or .repeated >= 1' <<< "$report"
}

@test "no answer is lost or wrong where packets come that crash liblcm" {
    trial crash-packets 2
    status_was crash-packets '.foreign > 10'
}

@test "no answer is lost or wrong among damaged messages" {
    trial hostile
    status_was hostile '.malformed > 1000'
}

# bats test_tags=release
@test "no answer is lost or wrong where one datagram in a hundred is lost and one overtaken" {
    [ "$FMB_NETNS" = own ] || skip "needs a network namespace"
    trial lossy
    jq -e '.repeated > 0' <<< "$report"
}

# bats test_tags=release
@test "no answer is lost or wrong where half of the queries or their results are lost" {
    [ "$FMB_NETNS" = own ] || skip "needs a network namespace"
    trial halved
    jq -e '.repeated > .pairs / 2 and .repeated < 2 * .pairs' <<< "$report"
}

# resident_kb: at the start, then after each tenth. Sanitizers keep what was freed.
# bats test_tags=release
@test "an endless stream of new bodies takes no memory" {
    case $FMB_BUILD in *asan*) skip "sanitizers take memory of their own" ;; esac
    FMB_SOAK_IDS=200000 trial ids
    jq -e '.good and (.resident_kb | length) == 11 and .resident_kb[10] - .resident_kb[1] < 200' <<< "$report"
}

@test "foreign channels take no memory" {
    case $FMB_BUILD in *asan*) skip "sanitizers take memory of their own" ;; esac
    FMB_SOAK_CHANNELS=10000 trial channels
    jq -e '.good and .resident_kb[10] - .resident_kb[1] < 200' <<< "$report"
}
