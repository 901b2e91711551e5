# The client in Java (clients/examples/), and one in C over plain LCM: what they print, also on a bus with
# other clients.

load service

# The example is the same in all builds.
need_java() {
    command -v java > /dev/null && [ -f build/examples/java/PosedPair.class ] ||
        skip "needs liblcm-java and default-jdk-headless"
}

in_java() {
    timeout 60 java -Djava.net.preferIPv4Stack=true -cp /usr/share/java/lcm.jar:build/examples/java "$@"
}

posed_pair() {
    in_java PosedPair 2> "$BATS_TEST_TMPDIR/said"
}

# Records the queries on the bus, for queries().
start_log() {
    bus_log=$BATS_TEST_TMPDIR/bus.log
    lcm-logger -q -f -c FMB_PAIR_QUERY "$bus_log" 3>&- &
    started="${started-} $!"
    # It does not say when it receives: it does once it has seen something. It writes an event when
    # the next one comes.
    seen_by_log() {
        "$FMB" query --certificate --timeout 0.001 --retries 0 clients/demo/cube.json > /dev/null 2>&1 || true # a pair query
        queries_at_least 1
    }
    wait_until seen_by_log
}

queries() {
    grep -ao FMB_PAIR_QUERY "$bus_log" | wc -l
}

queries_at_least() {
    [ "$(queries)" -ge "$1" ]
}

@test "Java: two posed bodies have their answer" {
    need_java
    start_fmbd
    [ "$(posed_pair)" = overlapping ]
    [ "$(status_of received)" -ge 1 ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

@test "C over plain LCM: a pair, whole and by handles, and the largest scene have their answers" {
    start_fmbd
    run "$TOOLS/plain"
    [ "$status" = 0 ]
    [ "$output" = "verdict 3, box 0.5 to 1
verdict 3, box 0.5 to 1
status 1
status 0, 4 verdicts, 343 handles" ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

@test "Java: the largest scene has its answer" {
    need_java
    start_fmbd
    [ "$(in_java Largest)" = 'status 0, 4 verdicts, 343 handles' ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

# The service is stopped until the client has sent its query at least three times; then all results
# come at once, among damaged ones.
@test "Java: repeats a query on a bus with damaged results" {
    need_java
    start_log
    start_fmbd
    kill -STOP "$fmbd"
    local before client
    before=$(queries)
    posed_pair > "$BATS_TEST_TMPDIR/answer" 3>&- &
    client=$!
    started="$started $client"
    wait_until queries_at_least $((before + 4))
    for type in pair_query pair_result status; do "$TOOLS/fake-peer" burst FMB_PAIR_RESULT $type; done
    kill -CONT "$fmbd"
    wait $client
    [ "$(cat "$BATS_TEST_TMPDIR/answer")" = overlapping ]
    [ "$(status_of received)" -ge 4 ]
    stop_fmbd
}

# Another client queries without a pause, pairs that are separated.
@test "Java: in a flood of another client's results it gets its own answer" {
    need_java
    start_fmbd
    while echo '{"dim":2,"bodies":[{"id":1,"shape":"box","size":[1,1]},{"id":2,"shape":"box","size":[1,1],"position":[9,0]}]}'; do :; done 2> /dev/null 3>&- |
        "$FMB" query --certificate > /dev/null 3>&- &
    flood=$!
    started="$started $flood"
    flooded() { [ "$(status_of received)" -gt 1000 ]; }
    wait_until flooded
    [ "$(posed_pair)" = overlapping ]
    # It was running to the end.
    kill $flood
    stop_fmbd
}

# A service that refuses the first query twice, then answers.
@test "Java: queries a busy service again, later" {
    need_java
    "$TOOLS/busy" 2 > "$BATS_TEST_TMPDIR/numbers" 3>&- &
    started="${started-} $!"
    [ "$(posed_pair)" = separated ]
    # More where it repeated a query without waiting for its result, on a slow machine.
    [ "$(uniq "$BATS_TEST_TMPDIR/numbers" | tr '\n' ' ')" = '0 busy 0 ' ]
    [ "$(grep -c busy "$BATS_TEST_TMPDIR/numbers")" = 2 ]
}

@test "Java: a missing service is reported" {
    need_java
    run posed_pair
    [ "$status" = 1 ]
    [ "${lines[-1]}" = 'no fmbd answered' ]
}

@test "Java: the bus is that of LCM_DEFAULT_URL" {
    need_java
    start_fmbd --lcm-url 'udpm://239.255.76.68:7700?ttl=0'
    export LCM_DEFAULT_URL='udpm://239.255.76.68:7700?ttl=0'
    [ "$(posed_pair)" = overlapping ]
    stop_fmbd
}
