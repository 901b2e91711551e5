# Logs replayed through a live service: what it finds is what a replay in process finds, whatever is
# done to the service meanwhile.

load service

setup() {
    root=$PWD
    FMB_BUILD=$(realpath "$FMB_BUILD")
    FMBD=$FMB_BUILD/fmbd
    FMB=$FMB_BUILD/fmb
    cd "$BATS_TEST_TMPDIR" || return
}

# replay OPTIONS LOG...: as JSON in the file replayed; the exit code in $code.
replay() {
    code=0
    "$FMB" replay --json --bus --retries 40 "$@" > replayed 2> stderr || code=$?
}

# is_same FILE [EXPRESSION...]: the replay in the file is that of in_process, except for times and the counts
# of the bus; and the expressions are true of it. On a slow machine the service ends its part of a scene
# earlier, after fewer pairs.
is_same() {
    local essence="del(.compute, .bus, .pairs, .channels[].pairs)" expression all=true
    for expression in "${@:2}"; do all+=" and ($expression)"; done
    jq -es "length == 2 and (map($essence) | .[0] == .[1]) and .[0].pairs >= .[1].pairs and (.[1] | $all)" \
        in_process "$1" > /dev/null || {
        diff <(jq "$essence" in_process) <(jq "$essence" "$1")
        holds "$@"
        return 1
    }
}

# as_in_process OPTIONS LOG... [-- EXPRESSION...]: the replay through the service has the exit code,
# counts and differences of the one in process; and the expressions are true of it.
as_in_process() {
    local expected=0 arguments=()
    while [ $# != 0 ] && [ "$1" != -- ]; do
        arguments+=("$1")
        shift
    done
    "$FMB" replay --json "${arguments[@]}" > in_process 2> /dev/null || expected=$?
    replay "${arguments[@]}"
    [ "$code" = "$expected" ]
    is_same replayed '.bus.end == null' "${@:2}"
}

# byte_at FILE OFFSET BYTE: replaces it; BYTE as three octal digits.
byte_at() {
    printf "\\$3" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# place_of LOG CHANNEL N: where the data of its event N on the channel begin, from 1.
place_of() {
    echo $(($(grep -abo "$2" "$1" | sed -n "$3s/:.*//p") + ${#2}))
}

# begin_watch: starts $watch, a process that ends after the next results: more than a replay has under way, so
# that it has received the first of them.
begin_watch() {
    "$FMB" watch --count 200 > /dev/null 2> watched 3>&- &
    watch=$!
    started="$started $watch"
    wait_until has watched 'watching '
}

answered_or_ended() {
    ! kill -0 "$watch" 2> /dev/null || ! kill -0 "$replay" 2> /dev/null
}

# begin_replay OPTIONS: starts $replay on a log of $many queries; returns while most are not answered yet.
begin_replay() {
    many=50000
    [[ $FMB_BUILD != *asan* ]] || many=5000
    generate --blast pairs $many --by-handle many.log
    begin_watch
    # A shell's background job ignores SIGINT; env gives it back.
    env --default-signal=INT "$FMB" replay --json --bus "$@" many.log > replayed 2> stderr 3>&- &
    replay=$!
    started="$started $replay"
    wait "$watch"
}

# event LOG CHANNEL: appends an event with the data of standard input.
event() {
    local hex i size
    cat > data
    size=$(stat -c %s data)
    hex=eda1da01$(printf '%016x%016x%08x%08x' 0 1000000 ${#2} "$size")
    for ((i = 0; i < ${#hex}; i += 2)); do printf "\\x${hex:i:2}"; done >> "$1"
    printf %s "$2" >> "$1"
    cat data >> "$1"
}

@test "replays through a service match those in process, for every kind of log" {
    start_fmbd
    for kind in arm stack crowd hard-2d hard-3d hard-3d-moving turns refused clients foreign; do
        generate $kind $kind.log
        as_in_process $kind.log -- \
            '.queries > 0 and .different == 0 and .bus.answered == .queries' \
            '.bus.services == 1 and .bus.unreadable == 0'
    done
    # Those that are refused for their ids, too.
    replay refused.log
    holds replayed '.same > 80'
    stop_fmbd
}

@test "pairs that a scene ignores are not counted" {
    start_fmbd
    "$FMB" record scene.log > recorded 2> messages 3>&- &
    record=$!
    started="${started-} $record"
    wait_until has messages 'recording to'
    for ignored in '[1,2],[2,1],[3,1]' '[1,2],[1,3],[2,3],[4,1],[4,2]'; do
        jq -n --argjson ignore "[$ignored]" '{dim: 2, $ignore, bodies: [range(1; 5) | {id: ., shape: "box", size: [1, 1]}]}'
    done > scenes.json
    "$FMB" query --json scenes.json > answers
    kill -INT "$record"
    wait "$record"
    [ "$(jq '.pairs | length' answers | paste -sd ' ')" = '4 1' ]
    as_in_process scene.log -- '.channels | map(.pairs) == [0, 5]'
    stop_fmbd
}

# bats test_tags=release
@test "several logs, and goldens of both replay through a service" {
    start_fmbd
    generate arm arm.log
    generate clients clients.log
    generate hard-2d hard.log
    as_in_process arm.log clients.log hard.log
    # The same ids again and again: each query has its own result.
    generate --blast pairs 10 few.log
    as_in_process few.log few.log few.log -- '.same == 30'
    "$FMB" replay --write-golden golden clients.log
    as_in_process --golden golden clients.log -- '.same == .queries'
    "$FMB" replay --bus --write-golden live clients.log
    "$FMB" replay --golden live clients.log
    as_in_process --golden live clients.log
    # The goldens of a process and of a service are the same but for who answered.
    "$FMB" replay --golden golden --write-golden again --bus clients.log
    stop_fmbd
}

# bats test_tags=release
@test "an altered verdict is a difference" {
    start_fmbd
    generate --blast pairs 500 pairs.log
    at=$(place_of pairs.log FMB_PAIR_RESULT 217)
    # After fingerprint, ids, server, bodies, handles, status, an empty detail and method.
    verdict=$((at + 104))
    before=$(od -An -tu1 -j $verdict -N 1 pairs.log)
    as_in_process pairs.log
    [ "$code" = 0 ]
    byte_at pairs.log $verdict 00$((before == 3 ? 2 : 3))
    as_in_process pairs.log -- \
        '.different == 1 and .same == 499' \
        '.differences | length == 1 and (.[0] | .kind == "verdict" and .then != .now)'
    [ "$code" = 1 ]
    "$FMB" replay --bus --junit junit.xml pairs.log > text && false
    grep -q 'verdict: ' text
    grep -q '^fmbd answered 500 queries in ' text
    grep -q '<failure message="1 of 500 queries' junit.xml
    grep -q 'the service answered all' junit.xml
    stop_fmbd
}

# bats test_tags=release
@test "bodies that the service does not hold are sent whole" {
    generate --blast pairs 3000 --by-handle handles.log
    generate clients clients.log
    generate crowd crowd.log
    start_fmbd
    for log in handles clients crowd; do
        as_in_process $log.log
    done
    # What it holds is used.
    before=$(status_of hits)
    as_in_process handles.log
    [ $(($(status_of hits) - before)) -ge 3000 ]
    stop_fmbd
    start_fmbd --frames 2
    as_in_process handles.log -- '.bus.sent_whole > 0 and .same == 3000'
    stop_fmbd
}

@test "scenes too long for a datagram with their frames are sent by handle" {
    generate --blast scenes 60 scenes.log
    "$FMB" log cut --from 0.001 scenes.log -o cut.log
    start_fmbd
    as_in_process cut.log -- '.pairs > 100000 and .bus.supplied > 0 and .not_defined == 0'
    [ "$code" = 0 ]
    stop_fmbd
    # A service that cannot hold as many bodies.
    start_fmbd --frames 10
    replay scenes.log
    [ "$code" = 2 ]
    holds replayed '.not_held > 0 and .not_defined == 0 and .same + .not_held == .queries'
    grep -Fx "fmb: queries left out because their bodies do not fit into the cache (fmbd --frames): $(jq .not_held replayed)" stderr
    stop_fmbd
}

@test "queries longer than a service receives are counted as not sent" {
    generate hard-2d hard.log
    # A pair whose second placement ends with a velocity of so many zeros.
    for numbers in 8120 8173; do
        {
            dd if=hard.log bs=1 skip="$(place_of hard.log FMB_PAIR_QUERY 1)" count=8 status=none
            head -c 128 /dev/zero
            for ((i = 24; i >= 0; i -= 8)); do printf "\\x$(printf %02x $((numbers >> i & 255)))"; done
            head -c $((8 * numbers)) /dev/zero
        } | event long.log FMB_PAIR_QUERY
    done
    "$FMB" replay --write-golden golden long.log
    start_fmbd
    as_in_process --golden golden long.log -- '.same == 2 and .bus.not_sent == 2 and .bus.answered == 2'
    [ "$code" = 0 ]
    "$FMB" replay --bus --golden golden long.log > text
    grep -q '2 that cannot be sent' text
    stop_fmbd
}

@test "every query is answered when the service is killed and restarted" {
    start_fmbd
    begin_replay --timeout 0.1 --retries 1000
    for ((kills = 0; kills < 3; kills++)); do
        if ! kill -0 $replay 2> /dev/null; then break; fi
        kill -KILL "$fmbd"
        start_fmbd
        begin_watch
        wait_until answered_or_ended
    done
    [ $kills -gt 0 ]
    wait $replay
    holds replayed ".same == $many and .exit == 0"
    stop_fmbd
}

# bats test_tags=release
@test "a service that stops repeatedly is given up only when it does not come back" {
    start_fmbd
    begin_replay --timeout 0.05 --retries 400
    # Each answer gives it another 20 seconds.
    for _ in 1 2 3 4; do
        kill -STOP "$fmbd"
        begin_watch
        sleep 0.3 # the length of the outage
        kill -CONT "$fmbd"
        wait_until answered_or_ended
    done
    wait $replay
    holds replayed ".same == $many and .exit == 0 and .bus.services == 1 and .bus.sent_again > 0"
    stop_fmbd
}

@test "every query is answered when datagrams are lost and reordered" {
    [ "$FMB_NETNS" = own ] || skip "needs a network namespace"
    generate clients clients.log
    generate refused refused.log
    generate --blast pairs 300 --by-handle handles.log
    start_fmbd
    "$TOOLS/soak-relay" 7667 7668 10 10 3>&- &
    started="$started $!"
    through=(--lcm-url 'udpm://239.255.76.67:7668?ttl=0' --timeout 0.05)
    for log in clients refused handles; do
        "$FMB" replay --json $log.log > in_process
        replay "${through[@]}" --retries 400 $log.log
        [ "$code" = 0 ]
        is_same replayed '.bus.sent_again > 0'
    done
    stop_fmbd
}

@test "replays match beside floods and damaged results, several at a time" {
    generate clients clients.log
    generate --blast pairs 300 --by-handle handles.log
    start_fmbd
    "$TOOLS/fake-peer" flood pair_query 101 60 > /dev/null 3>&- &
    flood=$!
    started="$started $flood"
    "$TOOLS/fake-peer" burst FMB_PAIR_RESULT pair_result > /dev/null 3>&- &
    started="$started $!"
    for i in 1 2 3; do
        "$FMB" replay --json --bus --retries 100 handles.log clients.log > replayed.$i 3>&- &
        replays="${replays-} $!"
    done
    for pid in $replays; do wait "$pid"; done
    kill $flood
    "$FMB" replay --json handles.log clients.log > in_process
    for i in 1 2 3; do is_same replayed.$i; done
    stop_fmbd
}

# bats test_tags=release
@test "SIGINT ends a replay with a report so far" {
    start_fmbd
    begin_replay
    kill -INT $replay
    code=0
    wait $replay || code=$?
    [ "$code" = 2 ]
    grep -q '^fmb: ended by a signal; counts are of [0-9,]* queries, answered so far$' stderr
    holds replayed '.exit == 2 and .bus.end == "signal"' ".queries > 5 and .queries < $many" \
        '.different == 0 and .no_result == 0 and .same >= .queries - 1 and .same <= .queries'
    stop_fmbd
}

# bats test_tags=release
@test "a missing service, and one that is gone, are reported" {
    generate arm arm.log
    code=0
    "$FMB" replay --bus --timeout 0.05 --retries 2 arm.log > stdout 2> stderr || code=$?
    [ "$code" = 2 ]
    [ ! -s stdout ]
    grep -q '^fmb: no fmbd answered on FMB_PAIR_RESULT and FMB_SCENE_RESULT of .* within 0.15 s$' stderr
    grep -q "^fmb: start one with 'fmbd .*&'" stderr # with --lcm-url where there is no network namespace
    [ "$(wc -l < stderr)" = 2 ]
    # Another service does not answer.
    start_fmbd --prefix P
    "$FMB" replay --bus --timeout 0.05 --retries 2 arm.log 2> stderr && false
    grep -q 'no fmbd answered' stderr
    stop_fmbd
    start_fmbd
    begin_replay --timeout 0.5 --retries 3 --junit junit.xml
    stop_fmbd
    code=0
    wait $replay || code=$?
    [ "$code" = 2 ]
    grep -q '^fmb: fmbd answered [0-9,]* queries, and then nothing for 2 s; the next one is event [0-9]* (offset [0-9]*) of many.log$' stderr
    holds replayed '.exit == 2 and .bus.end == "no service answers" and .queries == .bus.answered'
    grep -q '<error message="it answered [0-9,]* queries"/>' junit.xml
}

# bats test_tags=release
@test "a log of another prefix and a missing bus are reported" {
    generate arm arm.log
    start_fmbd
    replay --prefix P arm.log
    [ "$code" = 2 ]
    holds replayed '.queries == 0 and .other_events > 0 and .bus.answered == 0'
    stop_fmbd
    code=0
    "$FMB" replay --bus --lcm-url udpm://239.255.76.67 --write-golden golden arm.log > stdout 2> stderr || code=$?
    [ "$code" = 2 ]
    grep -q 'is not an LCM bus' stderr
    # Nothing was begun.
    [ ! -s stdout ]
    [ ! -e golden ]
}

