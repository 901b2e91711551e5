# fmb record: what passes on the bus is in the log, byte for byte, with the bodies that queries name;
# what is not there is reported.

load service

setup() {
    log=$BATS_TEST_TMPDIR/log
    messages=$BATS_TEST_TMPDIR/messages
    report=$BATS_TEST_TMPDIR/report
}

# The events of logs, without numbers and times: channel, size, checksum.
events() {
    for file in "$@"; do "$TOOLS/events" "$file" || return; done | cut -d ' ' -f 3-
}

# count_events CHANNEL FILE...
count_events() {
    local channel=$1
    shift
    events "$@" | grep -c "^$channel " || true
}

has_events() {
    [ "$(count_events "$1" "$2")" -ge "$3" ]
}

query() {
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query "$@" "$BATS_TEST_TMPDIR/scene.json" > /dev/null
}

# is FILTER...: of the summary.
is() {
    holds "$report" "$@" || {
        cat "$messages"
        return 1
    }
}

@test "a log has the messages of a service and its clients, byte for byte" {
    start_fmbd
    lcm-logger -q "$BATS_TEST_TMPDIR/witness" 3>&- &
    witness=$!
    started="$started $witness"
    wait_until [ -e "$BATS_TEST_TMPDIR/witness" ]
    start_record "$log"
    "$FMB" status > /dev/null
    query
    query --certificate
    query --box
    "$FMB" status > /dev/null
    finish_record
    kill "$witness"
    wait "$witness"
    is '.lost == 0 and .malformed == 0 and .received.others == 0'
    # Where the machine is slow, clients repeat queries.
    is '.received.pair_queries >= .received.pair_results and .received.pair_results >= 66' \
        '.received.scene_queries >= .received.scene_results and .received.scene_results >= 2' \
        '.received.heartbeats >= 2' \
        ".files == [\"$log\"] and .bytes == $(stat -c %s "$log") and .receive_buffer > 0"
    [ "$(events "$log" | wc -l)" = "$(jq .events "$report")" ]
    # Definitions come besides, of bodies that queries named by handle.
    is ".events == (.received | add) + $(count_events FMB_DEFINITION "$log")"
    # The other one may have lost some, and received a heartbeat more. Datagrams of one sender, which
    # has channels of its own, arrive in order; those of two need not.
    events "$log" | grep '^FMB_[PS].*_[QR]' | sort -s -k 1,1 > "$BATS_TEST_TMPDIR/ours"
    events "$BATS_TEST_TMPDIR/witness" | grep '^FMB_[PS].*_[QR]' | sort -s -k 1,1 > "$BATS_TEST_TMPDIR/theirs"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/theirs")" -gt 10 ]
    awk 'NR == FNR { ours[++count] = $0; next }
         { while (++at <= count && ours[at] != $0) continue }
         at > count { print "not in the log: " $0; exit 1 }' "$BATS_TEST_TMPDIR/ours" "$BATS_TEST_TMPDIR/theirs"
    stop_fmbd
}

@test "events are numbered from 0, and have their times of arrival" {
    start_fmbd
    before=$(date +%s%6N)
    start_record "$log"
    query
    finish_record
    after=$(date +%s%6N)
    "$TOOLS/events" "$log" | awk -v before="$before" -v after="$after" '
        $1 != NR - 1 || $2 < before || $2 > after || $2 < last { print "event " $0; bad = 1 }
        { last = $2 }
        END { exit bad || !NR }'
    stop_fmbd
}

# bats test_tags=release
@test "SIGINT and SIGTERM end a recording with all earlier messages" {
    for signal in INT TERM; do
        start_record "$log.$signal"
        "$TOOLS/fake-peer" numbers 5 $(seq 1000)
        finish_record $signal
        is '.events == 1000 and .received.pair_queries == 1000 and .lost == 0'
        [ "$(count_events FMB_PAIR_QUERY "$log.$signal")" = 1000 ]
    done
}

@test "messages in the socket at the end are recorded" {
    start_record "$log"
    kill -STOP "$record"
    "$TOOLS/fake-peer" burst numbers 5 $(seq 100)
    kill -INT "$record"
    kill -CONT "$record"
    wait "$record"
    is '.events == 100 and .lost == 0'
}

@test "a recording is summarised as text" {
    "$FMB" record "$log" > "$report" 2> "$messages" 3>&- &
    record=$!
    started=$record
    wait_until has "$messages" 'recording to'
    "$TOOLS/fake-peer" numbers 5 $(seq 1 1500) 1503
    finish_record
    grep -Eqx "$log: 1,501 messages in [0-9.]+ s, [0-9,]+ bytes" "$report"
    grep -Eqx '  pair queries +1,501' "$report"
    grep -Eqx '  pair results +0' "$report"
    grep -Eqx '  lost +0' "$report"
    run ! grep -q malformed "$report"
    grep -qx 'fmb: lost: 0 datagrams .*, 2 queries by their sequence numbers, bodies of 0 handles' "$messages"
    [ "$(wc -l < "$messages")" = 4 ] # the first and this one; that there is no service
}

# bats test_tags=release
@test "a recording ends after a number of messages, or a time" {
    "$FMB" record --json --count 7 "$log" > "$report" 2> "$messages" 3>&- &
    record=$!
    started=$record
    wait_until has "$messages" 'recording to'
    "$TOOLS/fake-peer" numbers 5 $(seq 100)
    wait "$record"
    is '.events == 7'
    [ "$(events "$log" | wc -l)" = 7 ]
    "$FMB" record --json --duration 0.2 "$log.2" > "$report" 2> "$messages"
    is '.events == 0 and .seconds >= 0.2 and .seconds < 100 and .lost == 0'
    [ "$(stat -c %s "$log.2")" = 0 ]
}

# ---- Files -----------------------------------------------------------------------------------

# bats test_tags=release
@test "a file is overwritten with --force only" {
    echo precious > "$log"
    run --separate-stderr "$FMB" record --duration 0.1 "$log"
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [ "$stderr" = "fmb: $log: File exists; --force overwrites it" ]
    [ "$(cat "$log")" = precious ]
    "$FMB" record --force --duration 0.1 "$log"
    [ "$(stat -c %s "$log")" = 0 ]
}

@test "a file that cannot be created is reported" {
    run --separate-stderr "$FMB" record --duration 0.1 "$BATS_TEST_TMPDIR/no/such/log"
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [ "$stderr" = "fmb: $BATS_TEST_TMPDIR/no/such/log: No such file or directory" ]
}

@test "files of bounded size divide no event, and concatenated they are the log" {
    start_record --split-mb 0.05 "$log"
    "$TOOLS/fake-peer" numbers 5 $(seq 1000)
    finish_record
    # The files after the first one begin with the names.
    is '.received.pair_queries == 1000 and (.files | length) > 5 and .events == 999 + (.files | length)' \
        ".files[0] == \"$log.000\" and .files[1] == \"$log.001\""
    [ "$(ls "$log".* | wc -l)" = "$(jq '.files | length' "$report")" ]
    for file in "$log".*; do
        [ "$(stat -c %s "$file")" -le 52428 ]
        "$TOOLS/events" "$file" > /dev/null
    done
    [ "$(cat "$log".* | wc -c)" = "$(jq .bytes "$report")" ]
    cat "$log".* > "$BATS_TEST_TMPDIR/all"
    [ "$(count_events FMB_PAIR_QUERY "$BATS_TEST_TMPDIR/all")" = 1000 ]
    [ ! -e "$log" ]

    # They are all protected, and all overwritten.
    rm "$log.000"
    run --separate-stderr "$FMB" record --split-mb 1 --duration 0.1 "$log"
    [ "$status" = 2 ]
    [[ $stderr == "fmb: $log.0"*": File exists; --force overwrites it" ]]
    "$FMB" record --split-mb 1 --force --duration 0.1 "$log"
    [ "$(cd "$BATS_TEST_TMPDIR" && echo log.*)" = log.000 ]
}

# ---- Disks -----------------------------------------------------------------------------------

# failed MESSAGE: it ended by itself and reported why; the log has whole events only.
failed() {
    code=0
    wait "$record" || code=$?
    [ $code = 1 ]
    grep -qx "fmb: $log: $1" "$messages"
    "$TOOLS/events" "$log" > "$BATS_TEST_TMPDIR/left"
    is ".events >= $(wc -l < "$BATS_TEST_TMPDIR/left") and .bytes == $(stat -c %s "$log")"
    grep -qx '  no damage' <<< "$("$FMB" log info "$log")"
}

# Scenes of one client: its bodies go by handle from the second on.
feed_until_it_ends() {
    while kill -0 "$record" 2> /dev/null; do feed 100; done |
        "$FMB" query --json - > /dev/null
}

publish_until_it_ends() {
    local first=1
    while kill -0 "$record" 2> /dev/null && [ $first -lt 100000 ]; do
        "$TOOLS/fake-peer" numbers 5 $(seq $first $((first + 499)))
        first=$((first + 500))
    done
}

@test "a file that may not grow ends the recording" {
    (
        ulimit -f 100
        exec "$FMB" record --json "$log" > "$report" 2> "$messages" 3>&-
    ) &
    record=$!
    started=$record
    wait_until has "$messages" 'recording to'
    publish_until_it_ends
    failed 'File too large; no larger file is allowed there: write several'
    [ "$(stat -c %s "$log")" -le 102400 ]
    is '.events > 100'
}

@test "a full disk ends the recording" {
    mkdir "$BATS_TEST_TMPDIR/disk"
    log=$BATS_TEST_TMPDIR/disk/log
    # In a namespace of its own, whose end is the disk's too: what is left is copied out of it.
    cat > "$BATS_TEST_TMPDIR/on_a_small_disk" << END
mount -t tmpfs -o size=256k none "$BATS_TEST_TMPDIR/disk" || exit 77
"$FMB" record --json "$log" > "$report" 2> "$messages"
code=\$?
cp "$log" "$BATS_TEST_TMPDIR/left_over"
exit \$code
END
    unshare -m sh "$BATS_TEST_TMPDIR/on_a_small_disk" 3>&- 2> "$BATS_TEST_TMPDIR/err" &
    record=$!
    started=$record
    begun_or_ended() { has "$messages" 'recording to' 2> /dev/null || ! kill -0 "$record" 2> /dev/null; }
    wait_until begun_or_ended
    if [ ! -e "$messages" ]; then skip "no disk can be mounted: $(cat "$BATS_TEST_TMPDIR/err")"; fi
    publish_until_it_ends
    cp "$BATS_TEST_TMPDIR/left_over" "$log"
    failed 'No space left on device; free space there, or write elsewhere'
    is '.events > 100'
}

# bats test_tags=release
@test "a failure of standard output is a failure of the recording" {
    run --separate-stderr bash -c '"$0" record --duration 0.1 "$1" > /dev/full' "$FMB" "$log"
    [ "$status" = 1 ]
    [[ $stderr == *"fmb: standard output: No space left on device" ]]
}

@test "a log that is deleted or truncated ends the recording" {
    for what in 'rm' 'truncate -s 100'; do
        start_record --force "$log"
        "$TOOLS/fake-peer" numbers 5 $(seq 100)
        wait_until has_events FMB_PAIR_QUERY "$log" 100
        $what "$log"
        code=0
        wait "$record" || code=$?
        [ $code = 1 ]
        grep -qx "fmb: $log: deleted or truncated by another program" "$messages"
    done
    # Also right before the end.
    start_record --force "$log"
    "$TOOLS/fake-peer" numbers 5 1
    wait_until has_events FMB_PAIR_QUERY "$log" 1
    rm "$log"
    code=0
    finish_record || code=$?
    [ $code = 1 ]
}

@test "a log that is truncated under traffic ends the recording at once" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    for traffic in 'publish FMB_PAIR_QUERY' 'feed FMB_SCENE_QUERY'; do
        start_record --force --duration 30 "$log"
        "${traffic% *}_until_it_ends" &
        sender=$!
        started="$started $sender"
        wait_until has_events "${traffic#* }" "$log" 1000
        truncate -s 0 "$log"
        code=0
        wait "$record" || code=$?
        [ $code = 1 ]
        wait "$sender" || true
        grep -qx "fmb: $log: deleted or truncated by another program" "$messages"
        # What was being written in that moment may be there.
        grep -qE '  no damage|: empty' <<< "$("$FMB" log info "$log")"
        [ "$(stat -c %s "$log")" -lt 1000000 ]
    done
    stop_fmbd
}

# ---- Bodies ----------------------------------------------------------------------------------

# feed COUNT: the same scene so often, of one client: its bodies go by handle from the second on.
feed() {
    head -n "$1" <(yes "$(tr '\n' ' ' < "$BATS_TEST_TMPDIR/scene.json")")
}

# resolves FILE...: a replay finds each query the same, and all bodies defined. A query that the client repeated
# is in the log twice, and may have one result.
resolves() {
    "$FMB" replay --json "$@" > "$BATS_TEST_TMPDIR/replay" || {
        cat "$BATS_TEST_TMPDIR/replay"
        return 1
    }
    "$FMB" replay "$@" | awk '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "not") column = i; next }
        /^FMB_/ { queries += $2; same += $4; undefined += $8; none += $9 }
        END { exit !(same > 0 && same + none == queries && undefined == 0) }'
}

@test "a recorder that starts after the clients knows their bodies" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    mkfifo "$BATS_TEST_TMPDIR/scenes"
    "$FMB" query --json - < "$BATS_TEST_TMPDIR/scenes" > "$BATS_TEST_TMPDIR/answers" 3>&- &
    client=$!
    started="$started $client"
    exec 9> "$BATS_TEST_TMPDIR/scenes"
    feed 2 >&9
    wait_until has_lines "$BATS_TEST_TMPDIR/answers" 2
    start_record "$log"
    feed 20 >&9
    wait_until has_events FMB_SCENE_RESULT "$log" 20
    exec 9>&-
    wait "$client"
    finish_record
    # All twelve are defined again if the service is slow and the recorder repeats its request.
    is '.lost == 0 and .unresolved_handles == 0' '.defined_bodies >= 12 and .defined_bodies % 12 == 0'
    resolves "$log"
    stop_fmbd
}

# A ball meets three bodies with ends: one moves, one turns, one does both. It does both in two consecutive
# windows. All numbers are written as they are printed.
ends() {
    jq -nc --argjson middle '{"position":[0.4,0.1,-0.3],"orientation":[0.9,0.1,-0.2,0.3]}' '
        {position: [1.1,-0.7,0.3], orientation: [-0.8,0.3,0.1,0.4]} as $last | ({shape: "box", size: [2,0.3,0.1]}) as $rod |
        [$middle, $last] | ., [$last, $middle] | {label: "ends", dim: 3, duration: 0.7, bodies: [
        {id: 1, name: "ball", shape: "sphere", radius: 0.2}, {id: 2, shape: "box", size: [1,1,1], position: [-2,0,0], end: {position: [-0.65,0,0]}},
        ($rod + {id: 3, position: [0,0.6,0], orientation: [1,0,0,0], end: {position: [0,0.6,0], orientation: [1,0,0,0.4]}}),
        ($rod + {id: 4} + .[0] + {end: .[1]})]}'
}

@test "bodies with an end are answered, recorded, printed and replayed with the bits of --local" {
    ends > "$BATS_TEST_TMPDIR/ends.json"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/ends.json")" = 2 ]
    "$FMB" query --json --gap --point --local "$BATS_TEST_TMPDIR/ends.json" > "$BATS_TEST_TMPDIR/local" || true
    start_fmbd
    start_record "$log"
    "$FMB" query --json --gap --point "$BATS_TEST_TMPDIR/ends.json" > "$BATS_TEST_TMPDIR/served" || true
    cmp "$BATS_TEST_TMPDIR/served" "$BATS_TEST_TMPDIR/local"
    wait_until has_events FMB_SCENE_RESULT "$log" 2
    finish_record
    stop_fmbd
    "$FMB" replay --json "$log" > "$BATS_TEST_TMPDIR/replay"
    jq -e '.same >= 2 and .different == 0' "$BATS_TEST_TMPDIR/replay"
    "$FMB" log cut -o "$BATS_TEST_TMPDIR/cut" --channel 'FMB_SCENE_.*' "$log"
    for event in 1 3; do
        "$FMB" log scene --event $event "$BATS_TEST_TMPDIR/cut" 2> "$messages"
    done > "$BATS_TEST_TMPDIR/scenes"
    "$FMB" query --json --gap --point --local "$BATS_TEST_TMPDIR/scenes" | cmp - "$BATS_TEST_TMPDIR/local"
    # The scenes have the given numbers.
    jq -S 'del(.pairs)' "$BATS_TEST_TMPDIR/ends.json" > "$BATS_TEST_TMPDIR/given"
    jq -S 'del(.pairs)' "$BATS_TEST_TMPDIR/scenes" | diff "$BATS_TEST_TMPDIR/given" -
}

# bats test_tags=release
@test "of a rotation that keeps two files each query can be resolved" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    start_record --split-mb 0.1 --max-files 2 "$log"
    feed 600 | query_in_step
    finish_record
    is '.lost == 0 and .unresolved_handles == 0 and (.files | length) == 2' \
        '.received.scene_queries >= 600 and .bytes > 600000'
    resolves "$log".*
    for file in "$log".*; do
        [ "$(stat -c %s "$file")" -le 104857 ]
        [ "$(count_events FMB_DEFINITION "$file")" -ge 1 ]
    done
    # The newer file does not need the older one.
    rm "$(jq -r '.files[0]' "$report")"
    "$FMB" log cut "$(jq -r '.files[1]' "$report")" -o "$log.cut" --json | jq -e '.unknown_handles == 0'
    stop_fmbd
}

# bats test_tags=release
@test "files of bounded size have space for definitions in their middle" {
    start_fmbd
    random_scene 3 12 1 > "$BATS_TEST_TMPDIR/one.json"
    random_scene 3 12 2 | sed 's/"id":/"id":1/g' > "$BATS_TEST_TMPDIR/two.json"
    # A file has space for the definitions, the query and the result of one scene, and for the query of
    # the other one, but not for its definitions too.
    start_record --split-mb 0.005 "$log"
    for _ in $(seq 60); do cat "$BATS_TEST_TMPDIR/one.json" "$BATS_TEST_TMPDIR/two.json"; done |
        query_in_step
    finish_record
    is '.lost == 0 and (.files | length) > 60 and .defined_bodies > 700'
    for file in "$log".*; do [ "$(stat -c %s "$file")" -le 5242 ]; done
    resolves "$log".*
    stop_fmbd
}

@test "bodies that the service does not define are counted" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    start_record "$log"
    feed 3 | "$FMB" query - > /dev/null
    finish_record
    stop_fmbd
    # The same messages once more, without a service and from the first query by handles on: these are
    # smaller than the first query of all, and its repetitions.
    offset=$("$TOOLS/events" "$log" | awk '{ size[NR] = 28 + length($3) + $4; query[NR] = $3 == "FMB_SCENE_QUERY" }
        query[NR] && (!least || size[NR] < least) { least = size[NR] }
        END { for (i = 1; !(query[i] && size[i] == least); i++) offset += size[i]; print offset + 0 }')
    tail -c +$((offset + 1)) "$log" > "$log.late"
    start_record "$log.2"
    lcm-logplayer "$log.late" 3>&-
    finish_record
    is '.unresolved_handles == 12 and .defined_bodies == 0'
    grep -qx 'fmb: lost: 0 datagrams .*, 0 queries by their sequence numbers, bodies of 12 handles' "$messages"
}

@test "each file has the names, a cut of it too, and every reader prints them" {
    start_fmbd
    cat > "$BATS_TEST_TMPDIR/scene.json" << 'END'
{"dim": 2, "bodies": [{"id": 1, "name": "table <top>", "shape": "box", "size": [1, 1]},
    {"id": 2, "shape": "box", "size": [1, 1], "position": [0.5, 0]},
    {"id": 3, "name": "näpf", "shape": "box", "size": [1, 1], "position": [5, 0]}]}
END
    start_record --split-mb 0.01 "$log"
    feed 60 | query_in_step
    finish_record
    is '.lost == 0 and (.files | length) > 3'
    second=$log.001
    cut=$BATS_TEST_TMPDIR/cut
    "$FMB" log cut --json --from 0.0001 --channel 'FMB_SCENE.*|FMB_DEFINITION' "$second" -o "$cut" > "$report"
    is '.added_names == 2 and .names == 0 and .unknown_handles == 0 and .scene_queries > 0'
    for file in "$second" "$cut"; do
        event=$("$TOOLS/events" "$file" | awk '$3 == "FMB_SCENE_QUERY" && !found++ { print $1 }')
        "$FMB" log scene --event "$event" "$file" > "$BATS_TEST_TMPDIR/again.json"
        [ "$(jq -c '[.bodies[].name]' "$BATS_TEST_TMPDIR/again.json")" = '["table <top>",null,"näpf"]' ]
        # The query of the first result may be in the file before.
        "$TOOLS/edit-log" --flip 2 "$file" "$BATS_TEST_TMPDIR/flipped"
        run "$FMB" replay --junit "$BATS_TEST_TMPDIR/junit" "$BATS_TEST_TMPDIR/flipped"
        [ "$status" = 1 ]
        [[ ${lines[0]} == 'event '*'  bodies table <top> 2  verdict: '* ]]
        grep -q 'bodies table &lt;top&gt; 2  verdict' "$BATS_TEST_TMPDIR/junit"
        "$FMB" replay --json "$BATS_TEST_TMPDIR/flipped" > "$BATS_TEST_TMPDIR/replay" || true
        [ "$(jq -c .differences[0].names "$BATS_TEST_TMPDIR/replay")" = '["table <top>",null]' ]
    done
    stop_fmbd
}

# ---- What does not come ----------------------------------------------------------------------

@test "datagrams that the kernel drops are counted, with a remedy" {
    url=${LCM_DEFAULT_URL:-udpm://239.255.76.67:7667?ttl=0}
    start_record --lcm-url "$url&recv_buf_size=20000" "$log"
    kill -STOP "$record"
    "$TOOLS/fake-peer" burst numbers 5 $(seq 1000)
    kill -CONT "$record"
    finish_record
    is '.lost > 100 and .lost + .events == 1000 and .receive_buffer == 40000' \
        '.skipped <= .lost'
    lost=$(jq .lost "$report") skipped=$(jq .skipped "$report")
    grep -qx "fmb: lost: $lost datagrams that the kernel dropped (receive buffer of 40,000 bytes), $skipped queries by their sequence numbers, bodies of 0 handles" "$messages"
    # The report for people has the number too.
    : > "$messages"
    "$FMB" record --force --lcm-url "$url&recv_buf_size=20000" "$log" > "$report" 2> "$messages" 3>&- &
    record=$!
    started="$started $record"
    wait_until has "$messages" 'recording to'
    kill -STOP "$record"
    "$TOOLS/fake-peer" burst numbers 5 $(seq 900)
    kill -CONT "$record"
    finish_record
    recorded=$(awk '/pair queries/ { print $NF }' "$report")
    grep -Eqx "  lost +$((900 - recorded))" "$report"
    grep -q "^fmb: lost: $((900 - recorded)) datagrams that the kernel dropped" "$messages"
}

@test "messages that cannot be decoded are recorded and counted" {
    start_record "$log"
    sent=0
    for type in pair_query pair_result scene_query scene_result status; do
        sent=$((sent + $("$TOOLS/fake-peer" FMB_PAIR_QUERY $type)))
        sent=$((sent + $("$TOOLS/fake-peer" FMB_SCENE_RESULT $type)))
        sent=$((sent + $("$TOOLS/fake-peer" FMB_STATUS $type)))
    done
    finish_record
    is ".malformed == $sent and .events == $sent"
    [ "$(events "$log" | wc -l)" = $sent ]
    # The report for people has the number too.
    : > "$messages"
    "$FMB" record --force "$log" > "$report" 2> "$messages" 3>&- &
    record=$!
    started="$started $record"
    wait_until has "$messages" 'recording to'
    sent=$("$TOOLS/fake-peer" FMB_PAIR_QUERY status)
    finish_record
    grep -Eqx "  malformed +$sent" "$report"
}

# ---- Channels --------------------------------------------------------------------------------

# bats test_tags=release
@test "the channels of another prefix are not recorded" {
    start_fmbd --prefix P
    start_record "$log"
    query --prefix P
    finish_record
    is '.events == 0'
    start_record --prefix P "$log.P"
    query --prefix P
    finish_record
    is '.received.scene_queries > 0 and .lost == 0'
    [ "$(count_events PFMB_SCENE_QUERY "$log.P")" = "$(jq .received.scene_queries "$report")" ]
    stop_fmbd
}

# bats test_tags=release
@test "other channels are recorded on request, and those of the service once" {
    others=0
    for options in '--channel ONE|T.*O' '--all' ''; do
        start_record --force $options "$log"
        one=$("$TOOLS/fake-peer" ONE status) two=$("$TOOLS/fake-peer" TWO status)
        three=$("$TOOLS/fake-peer" THREE status)
        "$TOOLS/fake-peer" numbers 5 1 2 4
        finish_record
        case $options in
        --all) others=$((one + two + three)) ;;
        --channel*) others=$((one + two)) ;;
        '') others=0 ;;
        esac
        is ".received.others == $others and .received.pair_queries == 3 and .malformed == 0" \
            ".events == $((others + 3)) and .lost == 0"
        [ "$(events "$log" | grep -c '^ONE ')" = "$([ "$options" ] && echo "$one" || echo 0)" ]
        [ "$(events "$log" | grep -c '^FMB_')" = 3 ]
    done
}

@test "large messages on other channels are recorded whole" {
    # An event log of one event: 40,000 bytes on channel OTHER.
    {
        printf '\xed\xa1\xda\x01'
        head -c 16 /dev/zero
        printf '\0\0\0\5\0\0\x9c\x40OTHER'
        head -c 40000 <(seq 100000)
    } > "$BATS_TEST_TMPDIR/large"
    for options in '--channel OTH.*' '--all'; do
        start_record --force $options "$log"
        lcm-logplayer "$BATS_TEST_TMPDIR/large" 3>&-
        finish_record
        is '.received.others == 1 and .events == 1 and .lost == 0'
        [ "$(events "$log")" = "$(events "$BATS_TEST_TMPDIR/large")" ]
    done
}

@test "packets that crash LCM do not harm the recorder" {
    start_record "$log"
    for packets in wrap short; do
        "$TOOLS/crash-liblcm" $packets FMB_PAIR_QUERY
        "$TOOLS/crash-liblcm" $packets OTHER
    done
    "$TOOLS/fake-peer" numbers 5 1
    finish_record
    is '.events == 1'
}

# ---- The terminal ----------------------------------------------------------------------------

# bats test_tags=release
@test "progress is shown on a terminal only" {
    script -qfc true /dev/null < /dev/null > /dev/null 2>&1 3>&- || skip 'there is no pseudo-terminal'
    mkfifo "$BATS_TEST_TMPDIR/keys"
    script -qfc "'$FMB' record --json '$log' > '$report'" "$BATS_TEST_TMPDIR/screen" \
        < "$BATS_TEST_TMPDIR/keys" > /dev/null 3>&- &
    script=$!
    started=$script
    exec 9> "$BATS_TEST_TMPDIR/keys"
    wait_until has "$BATS_TEST_TMPDIR/screen" 'recording to'
    "$TOOLS/fake-peer" numbers 5 $(seq 1000) 1003
    wait_until has "$BATS_TEST_TMPDIR/screen" "fmb: 1,001 messages, 0 MB, 0 lost"
    printf '\003' >&9
    wait "$script"
    exec 9>&-
    is '.events == 1001'
    # To a file there is one line, although more than the second between two heartbeats passes.
    start_fmbd
    start_record "$log.2"
    "$TOOLS/fake-peer" numbers 5 $(seq 1000)
    wait_until has_events FMB_STATUS "$log.2" 2
    finish_record
    stop_fmbd
    is '.received.pair_queries >= 1000'
    [ "$(wc -l < "$messages")" = 1 ]
}

# ---- Buses -----------------------------------------------------------------------------------

# bats test_tags=release
@test "a bus that does not open is reported" {
    run --separate-stderr "$FMB" record -l tcpq://127.0.0.1:1 "$log"
    [ "$status" = 1 ]
    [ "$output" = '' ]
    [ ! -e "$log" ]
}

@test "a recording without messages is an empty log" {
    run --separate-stderr "$FMB" record --duration 0.01 --prefix quiet- "$log"
    [ "$status" = 0 ]
    [[ ${lines[0]} =~ ^"$log: 0 messages in "[0-9]+\.[0-9]" s, 0 bytes"$ ]]
    [ "${lines[6]}" = '  lost                           0' ]
    [ "${#lines[@]}" = 7 ]
    [[ $stderr = "fmb: recording to $log"*$'\nfmb: no heartbeat on channel quiet-FMB_STATUS of '*" within "*" s
fmb: start one with 'fmbd "*"--prefix quiet- &'" ]]
    [ -f "$log" ]
    [ ! -s "$log" ]
    # Neither where a service answers, though it has sent no heartbeat yet.
    start_record --count 2 --prefix P "$log.2"
    start_fmbd --prefix P
    "$FMB" query --prefix P clients/demo/cube.json > /dev/null
    wait "$record"
    run ! grep -q 'no heartbeat' "$messages"
    stop_fmbd
    "$FMB" record --json --duration 0.01 --prefix quiet- --split-mb 1 "$log" > "$report"
    [ "$(jq -c '[.files, .events, .bytes, .lost, .receive_buffer > 0]' "$report")" = \
        "[[\"$log.000\"],0,0,0,true]" ]
    [ "$(wc -l < "$report")" = 1 ]
}

# The bodies of the demo's table; two are renamed in the log to bytes that are no text.
@test "watch prints what a recording holds, with the names and labels that clients sent" {
    sed 's/{"dim"/{"label": "shelf", "dim"/' clients/demo/table.json > "$BATS_TEST_TMPDIR/table.json"
    start_fmbd
    start_watch --json
    start_record "$log"
    for options in '' --box --point --certificate --gap; do
        # shellcheck disable=SC2086
        "$FMB" query $options "$BATS_TEST_TMPDIR/table.json" > /dev/null
        query $options
    done
    "$TOOLS/fake-peer" wait
    finish_record
    stop_fmbd
    "$FMB" log results --json --all "$log" > "$BATS_TEST_TMPDIR/results"
    kill -INT "$watch"
    wait "$watch"
    grep -q '"label": "shelf".*"names": \["table", "cube"\]' "$BATS_TEST_TMPDIR/results"
    jq -en --slurpfile watch "$watched" --slurpfile results "$BATS_TEST_TMPDIR/results" '
        def contacts: if .pairs then .pairs |= map(select(.verdict != "separated" or .gap)) else . end;
        ($results | map(del(.scene) | contacts)) as $found
        | ($found | length) >= 8 and $found - ($watch | map(contacts)) == []'
    "$FMB" log results "$log" | grep ' of shelf: '
    "$FMB" log results "$log" | grep ' table     cube  touching '
    LC_ALL=C sed 's/cube/\x1b,"\xff/g; s/shelf/a\n\x9b"b/g' "$log" > "$log.raw"
    "$FMB" log results --json "$log.raw" | jq -es 'any(.[]; .pairs and any(.pairs[]; .names == ["table", "\u001b,\"\ufffd"]))'
    "$FMB" log results --csv "$log.raw" > "$BATS_TEST_TMPDIR/csv"
    grep -q '^[0-9]*,[0-9]*,"a\\x0a�""b",1,2,"table","\\x1b,""�",touching,' "$BATS_TEST_TMPDIR/csv"
    "$FMB" log results "$log.raw" > "$BATS_TEST_TMPDIR/table"
    grep -q ' table  \\x1b,"�  touching ' "$BATS_TEST_TMPDIR/table"
    grep -qF ' of a\x0a�"b: ' "$BATS_TEST_TMPDIR/table"
    ! LC_ALL=C grep -q -e $'\033' -e $'\233' "$BATS_TEST_TMPDIR/csv" "$BATS_TEST_TMPDIR/table"
}
