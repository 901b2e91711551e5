# Clients in other LCM languages (clients/examples/), and in C over plain LCM: what they print, also
# on a bus with other clients.

load service

lua_is_there() {
    command -v lua5.2 > /dev/null && lua5.2 -e 'require "lcm"' 2> /dev/null
}

java_is_there() {
    command -v java > /dev/null && [ -f build/examples/java/AskPair.class ]
}

# need LANGUAGE: skips where it cannot run here. The examples are the same in all builds.
need() {
    case $1 in
    lua) lua_is_there || skip "needs lua5.2 and liblcm-lua" ;;
    java) java_is_there || skip "needs liblcm-java and default-jdk-headless" ;;
    esac
}

# ask LANGUAGE [SECONDS [TRIES]]: never longer than a minute.
ask() {
    local language=$1
    shift
    case $language in
    lua) LUA_PATH='build/examples/lua/?.lua;;' timeout 60 lua5.2 clients/examples/ask_pair.lua "$@" ;;
    java) timeout 60 java -Djava.net.preferIPv4Stack=true \
        -cp /usr/share/java/lcm.jar:build/examples/java AskPair "$@" ;;
    esac
}

# expected SECONDS: what fmb makes of the scene for two stretches of so many seconds.
expected() {
    for step in 0 1; do
        jq -c --argjson seconds "$1" --argjson step $step '.duration = $seconds
            | .bodies[1].origin[0] += $step * $seconds * .bodies[1].velocity[0]' clients/demo/cube.json |
            "$FMB" query --local --box --json |
            jq -r '.pairs[0] | [.verdict, .contact[]?, .box.min[]?, .box.max[]?] | join(" ")' |
            awk '{ printf "%s", $1 }
                NF > 2 { printf " from %g to %g s, box (%g %g %g) to (%g %g %g)", $2, $3, $4, $5, $6, $7, $8, $9 }
                { print "" }'
    done
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

first_answers() {
    need "$1"
    start_fmbd
    ask "$1" > "$BATS_TEST_TMPDIR/answers"
    [ "$(head -n 1 "$BATS_TEST_TMPDIR/answers")" = 'overlapping from 0.666667 to 1 s, box (0.5 0 0) to (1 1 1)' ]
    [ "$(status_of received)" = 2 ]
    [ "$(status_of results.OK)" = 2 ]
    for seconds in 0.25 0.8 1 3; do
        ask "$1" $seconds > "$BATS_TEST_TMPDIR/answers"
        expected $seconds | cmp - "$BATS_TEST_TMPDIR/answers"
    done
    [ "$(status_of misses)" = 2 ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

@test "Lua: prints what fmb says, and what the README shows" {
    first_answers lua
}

@test "Java: prints what fmb says, and what the README shows" {
    first_answers java
}

@test "Lua: two posed bodies" {
    need lua
    start_fmbd
    run env LUA_PATH='build/examples/lua/?.lua;;' timeout 60 lua5.2 clients/examples/posed_pair.lua
    [ "$output" = overlapping ]
    stop_fmbd
}

@test "Java: two posed bodies" {
    need java
    start_fmbd
    timeout 60 java -Djava.net.preferIPv4Stack=true \
        -cp /usr/share/java/lcm.jar:build/examples/java PosedPair > "$BATS_TEST_TMPDIR/output" \
        2> "$BATS_TEST_TMPDIR/said"
    [ "$(cat "$BATS_TEST_TMPDIR/output")" = overlapping ]
    stop_fmbd
}

# A cache of one frame does not hold both bodies when the second query comes with their handles.
bodies_not_held() {
    need "$1"
    start_fmbd --frames 1
    ask "$1" > "$BATS_TEST_TMPDIR/answers"
    expected 1 | cmp - "$BATS_TEST_TMPDIR/answers"
    [ "$(status_of results.UNKNOWN_BODY)" = 1 ]
    [ "$(status_of received)" = 3 ]
    stop_fmbd
}

@test "Lua: queries by handle, and sends bodies whole again where they are not held" {
    bodies_not_held lua
}

@test "Java: queries by handle, and sends bodies whole again where they are not held" {
    bodies_not_held java
}

@test "C over plain LCM: a pair, and the largest scene" {
    start_fmbd
    run "$FMB_BUILD/plain"
    [ "$status" = 0 ]
    [ "$output" = "verdict 3, box 0.5 to 1
status 0, 115 verdicts, 384 handles" ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

@test "Java: the largest scene, and a page of definitions" {
    need java
    start_fmbd
    timeout 60 java -Djava.net.preferIPv4Stack=true \
        -cp /usr/share/java/lcm.jar:build/examples/java Largest > "$BATS_TEST_TMPDIR/largest"
    [ "$(head -n 1 "$BATS_TEST_TMPDIR/largest")" = 'status 0, 115 verdicts, 384 handles' ]
    [ "$(tail -n 1 "$BATS_TEST_TMPDIR/largest")" = 'status 0, 384 bodies' ]
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

# The service is stopped until the client has sent its query at least three times; then all results
# come at once, more than the client waits for.
repeats() {
    need "$1"
    start_log
    start_fmbd
    kill -STOP "$fmbd"
    local before client
    before=$(queries)
    ask "$1" 0.8 100 > "$BATS_TEST_TMPDIR/answers" 3>&- &
    client=$!
    started="$started $client"
    wait_until queries_at_least $((before + 4))
    kill -CONT "$fmbd"
    wait $client
    expected 0.8 | cmp - "$BATS_TEST_TMPDIR/answers"
    [ "$(status_of received)" -ge 4 ]
    stop_fmbd
}

@test "Lua: repeats a query under the same number, and ignores second results" {
    repeats lua
}

@test "Java: repeats a query under the same number, and ignores second results" {
    repeats java
}

# The sequence numbers are the same, and the results come at once: only the client ids differ.
@test "clients with the same numbers get each its own answers, on a bus with damaged results" {
    need lua
    start_log
    start_fmbd
    kill -STOP "$fmbd"
    clients=
    durations='0.7 0.8 0.9'
    languages=lua
    if java_is_there; then languages='java lua'; fi
    for language in $languages; do
        for duration in $durations; do
            before=$(queries)
            ask $language $duration 100 > "$BATS_TEST_TMPDIR/$language.$duration" 3>&- &
            clients="$clients $!"
            started="$started $!"
            wait_until queries_at_least $((before + 1))
        done
    done
    for type in pair_query pair_result status; do "$FMB_BUILD/poke" FMB_PAIR_RESULT $type; done
    kill -CONT "$fmbd"
    for client in $clients; do wait "$client"; done
    for language in $languages; do
        for duration in $durations; do
            expected $duration | cmp - "$BATS_TEST_TMPDIR/$language.$duration"
        done
    done
    stop_fmbd
}

# Other clients query without a pause, with other bodies under the same ids.
@test "in a flood of other clients' results each gets its own answers" {
    need lua
    start_fmbd
    random_scene 3 30 > "$BATS_TEST_TMPDIR/scene.json"
    while cat "$BATS_TEST_TMPDIR/scene.json"; do :; done 2> /dev/null 3>&- |
        "$FMB" query > /dev/null 3>&- &
    flood=$!
    started="$started $flood"
    flooded() { [ "$(status_of received)" -gt 1000 ]; }
    wait_until flooded
    languages=lua
    if java_is_there; then languages='lua java'; fi
    for language in $languages; do
        ask $language 0.8 100 > "$BATS_TEST_TMPDIR/answers"
        expected 0.8 | cmp - "$BATS_TEST_TMPDIR/answers"
    done
    # It was running to the end.
    kill $flood
    stop_fmbd
}

# A service that refuses the first query twice, then answers: tests/system/busy.lua.
queries_later() {
    need lua
    need "$1"
    LUA_PATH='build/examples/lua/?.lua;;' lua5.2 tests/system/busy.lua \
        2 > "$BATS_TEST_TMPDIR/numbers" 3>&- &
    started="${started-} $!"
    ask "$1" 1 100 > "$BATS_TEST_TMPDIR/answers"
    printf 'separated\nseparated\n' | cmp - "$BATS_TEST_TMPDIR/answers"
    [ "$(tr '\n' ' ' < "$BATS_TEST_TMPDIR/numbers")" = '1 busy 1 busy 1 2 ' ]
}

@test "Lua: queries a busy service again, later" {
    queries_later lua
}

@test "Java: queries a busy service again, later" {
    queries_later java
}

fails() {
    need "$1"
    run ask "$1" 1 1
    [ "$status" = 1 ]
    [[ "${lines[-1]}" == *"no fmbd answered on channel FMB_PAIR_RESULT of udpm://"*"start one with 'fmbd &'" ]]
    start_fmbd
    run ask "$1" -1
    [ "$status" = 1 ]
    [[ "${lines[-1]}" == *"refused with status 9: duration: "?* ]]
    [[ "$output" != *"overlapping"* ]]
    stop_fmbd
    LCM_DEFAULT_URL=nonsense run ask "$1"
    [ "$status" = 1 ]
    [[ "$output" == *"cannot open the bus nonsense"* ]]
    for wrong in 'x' '1 0' '1 x' '1 2 3'; do
        run ask "$1" $wrong
        [ "$status" = 2 ]
        [[ "${lines[-1]}" == *"usage: "* ]]
    done
}

@test "Lua: no service, refused, no bus, wrong arguments: exit codes 1, 1, 1, 2" {
    fails lua
}

@test "Java: no service, refused, no bus, wrong arguments: exit codes 1, 1, 1, 2" {
    fails java
}

other_bus() {
    need "$1"
    start_fmbd --lcm-url 'udpm://239.255.76.68:7700?ttl=0'
    LCM_DEFAULT_URL='udpm://239.255.76.68:7700?ttl=0' ask "$1" > "$BATS_TEST_TMPDIR/answers"
    expected 1 | cmp - "$BATS_TEST_TMPDIR/answers"
    stop_fmbd
}

@test "Lua: the bus is that of LCM_DEFAULT_URL" {
    other_bus lua
}

@test "Java: the bus is that of LCM_DEFAULT_URL" {
    other_bus java
}
