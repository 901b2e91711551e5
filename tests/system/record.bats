# fmb record: what passes on the bus is in the log, byte for byte, and what is not there is told.

load service

bats_require_minimum_version 1.5.0

setup() {
    log=$BATS_TEST_TMPDIR/log
    said=$BATS_TEST_TMPDIR/said
    heard=$BATS_TEST_TMPDIR/heard
}

# start_record [OPTIONS] FILE: records until finish_record. The pid is in $record.
start_record() {
    "$FMB" record --json "$@" > "$heard" 2> "$said" 3>&- &
    record=$!
    started="${started-} $record"
    wait_until grep -qs 'recording to' "$said"
}

# finish_record [SIGNAL]: what it says is in $heard.
finish_record() {
    kill -"${1:-INT}" "$record"
    wait "$record"
}

# The events of logs, without numbers and times: channel, size, checksum.
events() {
    for file in "$@"; do "$FMB_BUILD/events" "$file" || return; done | cut -d ' ' -f 3-
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

ask() {
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query "$@" "$BATS_TEST_TMPDIR/scene.json" > /dev/null
}

# is FILTER: of the summary.
is() {
    jq -e "$1" "$heard" || {
        cat "$heard" "$said"
        return 1
    }
}

@test "what a service and its clients say is in the log, byte for byte" {
    start_fmbd
    lcm-logger -q "$BATS_TEST_TMPDIR/witness" 3>&- &
    witness=$!
    started="$started $witness"
    wait_until [ -e "$BATS_TEST_TMPDIR/witness" ]
    start_record "$log"
    "$FMB" status > /dev/null
    ask
    ask --certificate
    ask --box
    "$FMB" status > /dev/null
    finish_record
    kill "$witness"
    wait "$witness"
    is '.lost == 0 and .malformed == 0 and .unwritten == 0 and .heard.others == 0'
    is '.heard.pair_queries == 66 and .heard.pair_results == 66'
    is '.heard.scene_queries >= 2 and .heard.scene_queries == .heard.scene_results'
    is '.heard.heartbeats >= 2'
    is ".files == [\"$log\"] and .bytes == $(stat -c %s "$log") and .receive_buffer > 0"
    [ "$(events "$log" | wc -l)" = "$(jq .events "$heard")" ]
    [ "$(jq .events "$heard")" = "$(jq '.heard | add' "$heard")" ]
    # The other one may have lost some, and heard a heartbeat more.
    events "$log" | grep '^FMB_[PS].*_[QR]' > "$BATS_TEST_TMPDIR/ours"
    events "$BATS_TEST_TMPDIR/witness" | grep '^FMB_[PS].*_[QR]' > "$BATS_TEST_TMPDIR/theirs"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/theirs")" -gt 10 ]
    awk 'NR == FNR { ours[++count] = $0; next }
         { while (++at <= count && ours[at] != $0) continue }
         at > count { print "not in the log: " $0; exit 1 }' "$BATS_TEST_TMPDIR/ours" "$BATS_TEST_TMPDIR/theirs"
    stop_fmbd
}

@test "events are numbered from 0, and their times are when they came" {
    start_fmbd
    before=$(date +%s%6N)
    start_record "$log"
    ask
    finish_record
    after=$(date +%s%6N)
    "$FMB_BUILD/events" "$log" | awk -v before="$before" -v after="$after" '
        $1 != NR - 1 || $2 < before || $2 > after || $2 < last { print "event " $0; bad = 1 }
        { last = $2 }
        END { exit bad || !NR }'
    stop_fmbd
}

@test "lcm-logplayer plays a log, and another recording of that holds the same" {
    start_fmbd
    start_record "$log"
    ask
    ask --certificate
    finish_record
    stop_fmbd
    [ "$(events "$log" | wc -l)" -ge 134 ]
    start_record "$log.2"
    lcm-logplayer -s 10 "$log" 3>&-
    finish_record
    events "$log" > "$BATS_TEST_TMPDIR/played"
    events "$log.2" | cmp - "$BATS_TEST_TMPDIR/played"
}

@test "it ends on SIGINT and SIGTERM with all that came before" {
    for signal in INT TERM; do
        start_record "$log.$signal"
        "$FMB_BUILD/poke" numbers 5 $(seq 1000)
        finish_record $signal
        is '.events == 1000 and .heard.pair_queries == 1000 and .lost == 0'
        [ "$(count_events FMB_PAIR_QUERY "$log.$signal")" = 1000 ]
    done
}

@test "what waits when it is to end is recorded too" {
    start_record "$log"
    kill -STOP "$record"
    "$FMB_BUILD/poke" numbers 5 $(seq 100)
    kill -INT "$record"
    kill -CONT "$record"
    wait "$record"
    is '.events == 100 and .lost == 0'
}

@test "it says for people what it recorded" {
    "$FMB" record "$log" > "$heard" 2> "$said" 3>&- &
    record=$!
    started=$record
    wait_until grep -qs 'recording to' "$said"
    "$FMB_BUILD/poke" numbers 5 $(seq 1 1500) 1503
    finish_record
    grep -Eqx "$log: 1,501 messages in [0-9.]+ s, [0-9,]+ bytes" "$heard"
    grep -Eqx '  pair queries +1,501' "$heard"
    grep -Eqx '  pair results +0' "$heard"
    grep -Eqx '  lost +2' "$heard"
    grep -qx 'fmb: 2 queries did not come, by their sequence numbers' "$said"
    ! grep -q malformed "$heard"
}

@test "after a number of messages, or a time, it ends by itself" {
    "$FMB" record --json --count 7 "$log" > "$heard" 2> "$said" 3>&- &
    record=$!
    started=$record
    wait_until grep -qs 'recording to' "$said"
    "$FMB_BUILD/poke" numbers 5 $(seq 100)
    wait "$record"
    is '.events == 7'
    [ "$(events "$log" | wc -l)" = 7 ]
    "$FMB" record --json --duration 0.2 "$log.2" > "$heard" 2> "$said"
    is '.events == 0 and .seconds >= 0.2 and .lost == 0'
    [ "$(stat -c %s "$log.2")" = 0 ]
}

# ---- Files -----------------------------------------------------------------------------------

@test "what is there is overwritten with --force alone" {
    echo precious > "$log"
    run --separate-stderr "$FMB" record --duration 0.1 "$log"
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [ "$stderr" = "fmb: $log: File exists; --force overwrites it" ]
    [ "$(cat "$log")" = precious ]
    "$FMB" record --force --duration 0.1 "$log"
    [ "$(stat -c %s "$log")" = 0 ]
}

@test "a file that cannot be created" {
    run --separate-stderr "$FMB" record --duration 0.1 "$BATS_TEST_TMPDIR/no/such/log"
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [ "$stderr" = "fmb: $BATS_TEST_TMPDIR/no/such/log: No such file or directory" ]
}

@test "files of bounded size divide no event, and one behind the other they are the log" {
    start_record --split-mb 0.05 "$log"
    "$FMB_BUILD/poke" numbers 5 $(seq 1000)
    finish_record
    is '.events == 1000 and (.files | length) > 5'
    is ".files[0] == \"$log.000\" and .files[1] == \"$log.001\""
    [ "$(ls "$log".* | wc -l)" = "$(jq '.files | length' "$heard")" ]
    for file in "$log".*; do
        [ "$(stat -c %s "$file")" -le 52428 ]
        "$FMB_BUILD/events" "$file" > /dev/null
    done
    [ "$(cat "$log".* | wc -c)" = "$(jq .bytes "$heard")" ]
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

@test "of several files the newest are kept" {
    start_record --split-mb 0.05 --max-files 2 "$log"
    "$FMB_BUILD/poke" numbers 5 $(seq 1000)
    finish_record
    is '.events == 1000 and (.files | length) == 2'
    [ "$(echo "$log".*)" = "$(jq -r '.files | join(" ")' "$heard")" ]
    # The last ones: the newest event is that of the last number.
    newest=$(events "$(jq -r '.files[1]' "$heard")" | tail -n 1)
    start_record "$log"
    "$FMB_BUILD/poke" numbers 5 1000
    finish_record
    [ "$(events "$log")" = "$newest" ]
}

# ---- Disks -----------------------------------------------------------------------------------

# failed MESSAGE: it ended by itself, said so, and what it wrote is good up to there.
failed() {
    code=0
    wait "$record" || code=$?
    [ $code = 1 ]
    grep -qx "fmb: $log: $1" "$said"
    is '.unwritten > 0 and .lost == .unwritten and .events + .unwritten == (.heard | add)'
    "$FMB_BUILD/events" "$log" > "$BATS_TEST_TMPDIR/left" || true
    is ".events == $(wc -l < "$BATS_TEST_TMPDIR/left") and .bytes == $(stat -c %s "$log")"
}

poke_until_it_ends() {
    local first=1
    while kill -0 "$record" 2> /dev/null && [ $first -lt 100000 ]; do
        "$FMB_BUILD/poke" numbers 5 $(seq $first $((first + 499)))
        first=$((first + 500))
        sleep 0.05
    done
}

@test "a file that may not grow ends the recording" {
    (
        ulimit -f 100
        exec "$FMB" record --json "$log" > "$heard" 2> "$said" 3>&-
    ) &
    record=$!
    started=$record
    wait_until grep -qs 'recording to' "$said"
    poke_until_it_ends
    failed 'File too large; no larger file is allowed there: write several'
    [ "$(stat -c %s "$log")" = 102400 ]
    is '.events > 100'
}

@test "a full disk ends the recording" {
    mkdir "$BATS_TEST_TMPDIR/disk"
    log=$BATS_TEST_TMPDIR/disk/log
    # In a namespace of its own, whose end is the disk's too: what is left is copied out of it.
    cat > "$BATS_TEST_TMPDIR/on_a_small_disk" << END
mount -t tmpfs -o size=256k none "$BATS_TEST_TMPDIR/disk" || exit 77
"$FMB" record --json "$log" > "$heard" 2> "$said"
code=\$?
cp "$log" "$BATS_TEST_TMPDIR/left_over"
exit \$code
END
    unshare -m sh "$BATS_TEST_TMPDIR/on_a_small_disk" 3>&- 2> "$BATS_TEST_TMPDIR/err" &
    record=$!
    started=$record
    for _ in $(seq 200); do
        if grep -qs 'recording to' "$said" || ! kill -0 "$record" 2> /dev/null; then break; fi
        sleep 0.05
    done
    if [ ! -e "$said" ]; then skip "no disk can be mounted: $(cat "$BATS_TEST_TMPDIR/err")"; fi
    poke_until_it_ends
    cp "$BATS_TEST_TMPDIR/left_over" "$log"
    failed 'No space left on device; make room there, or write elsewhere'
    is '.events > 100'
}

@test "what is said of a log is said, whatever becomes of standard output" {
    run --separate-stderr bash -c '"$0" record --duration 0.1 "$1" > /dev/full' "$FMB" "$log"
    [ "$status" = 1 ]
    [[ $stderr == *"fmb: standard output: No space left on device" ]]
}

@test "a recording that is killed leaves what it had written soon" {
    start_record "$log"
    "$FMB_BUILD/poke" numbers 5 $(seq 300)
    wait_until has_events FMB_PAIR_QUERY "$log" 300
    kill -KILL "$record"
    wait "$record" || true
    [ "$(count_events FMB_PAIR_QUERY "$log")" = 300 ]
}

# ---- What does not come ----------------------------------------------------------------------

@test "numbers that a client skips are missing, not those that are asked again or overtaken" {
    start_record "$log"
    "$FMB_BUILD/poke" numbers 5 10 11 15 15 14 11 20
    "$FMB_BUILD/poke" numbers 6 7 9
    finish_record
    is '.queries_missing == 7 and .results_missing == 0 and .lost == 7 and .events == 9'
    grep -qx 'fmb: 7 queries did not come, by their sequence numbers' "$said"
}

# The receive buffer of this one has no room for what comes while it is stopped.
@test "what did not come is counted to the last one, and what to do about it is said" {
    url=${LCM_DEFAULT_URL:-udpm://239.255.76.67:7667?ttl=0}
    start_fmbd
    start_record --lcm-url "$url&recv_buf_size=20000" "$log"
    wait_until has_events FMB_STATUS "$log" 1
    received=$(status_of received) answered=$(status_of answered)
    [ "$received" = 0 ] && [ "$answered" = 0 ]
    ask
    ask --certificate
    "$FMB_BUILD/poke" numbers 5 0
    kill -STOP "$record"
    "$FMB_BUILD/poke" flood pair_query 5 1 > /dev/null
    "$FMB" query --timeout 5 --certificate "$BATS_TEST_TMPDIR/scene.json" > /dev/null
    kill -CONT "$record"
    seen=$(count_events FMB_STATUS "$log")
    wait_until has_events FMB_STATUS "$log" $((seen + 2))
    "$FMB_BUILD/poke" numbers 5 1000000
    seen=$(count_events FMB_STATUS "$log")
    wait_until has_events FMB_STATUS "$log" $((seen + 2))
    "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
    finish_record
    is '.results_missing > 100 and .queries_missing > 100 and .unwritten == 0'
    is '.lost == .results_missing + .queries_missing'
    is '.receive_buffer == 40000'
    [ "$(jq .answered "$BATS_TEST_TMPDIR/status")" = \
        "$(jq '.heard.pair_results + .heard.scene_results + .results_missing' "$heard")" ]
    grep -q '^fmb: .* results did not come, by the service.s count$' "$said"
    grep -qx 'fmb: the receive buffer has 40,000 bytes only; to grant more, run:' "$said"
    grep -qx 'fmb:   sudo sysctl net.core.rmem_max=4194304' "$said"
    stop_fmbd
}

@test "what cannot be read is recorded and counted" {
    start_record "$log"
    sent=0
    for type in pair_query pair_result scene_query scene_result status; do
        sent=$((sent + $("$FMB_BUILD/poke" FMB_PAIR_QUERY $type)))
        sent=$((sent + $("$FMB_BUILD/poke" FMB_SCENE_RESULT $type)))
        sent=$((sent + $("$FMB_BUILD/poke" FMB_STATUS $type)))
    done
    finish_record
    is ".malformed == $sent and .events == $sent"
    [ "$(events "$log" | wc -l)" = $sent ]
}

# ---- Channels --------------------------------------------------------------------------------

@test "the channels of another prefix are another service's" {
    start_fmbd --prefix P
    start_record "$log"
    ask --prefix P
    finish_record
    is '.events == 0'
    start_record --prefix P "$log.P"
    ask --prefix P
    finish_record
    is '.heard.scene_queries > 0 and .lost == 0'
    [ "$(count_events PFMB_SCENE_QUERY "$log.P")" = "$(jq .heard.scene_queries "$heard")" ]
    stop_fmbd
}

@test "other channels are recorded where they are asked for, and the service's own once" {
    others=0
    for options in '--channel ONE|T.*O' '--all' ''; do
        start_record --force $options "$log"
        one=$("$FMB_BUILD/poke" ONE status) two=$("$FMB_BUILD/poke" TWO status)
        three=$("$FMB_BUILD/poke" THREE status)
        "$FMB_BUILD/poke" numbers 5 1 2 4
        finish_record
        case $options in
        --all) others=$((one + two + three)) ;;
        --channel*) others=$((one + two)) ;;
        '') others=0 ;;
        esac
        is ".heard.others == $others and .heard.pair_queries == 3 and .malformed == 0"
        is ".events == $((others + 3)) and .queries_missing == 1"
        if [ "$options" ]; then is '.dropped == 0'; else is '.dropped == null'; fi
        [ "$(events "$log" | grep -c '^ONE ')" = "$([ "$options" ] && echo "$one" || echo 0)" ]
        [ "$(events "$log" | grep -c '^FMB_')" = 3 ]
    done
}

@test "what the system throws away of other channels is told" {
    url=${LCM_DEFAULT_URL:-udpm://239.255.76.67:7667?ttl=0}
    start_record --all --lcm-url "$url&recv_buf_size=20000" "$log"
    kill -STOP "$record"
    sent=$("$FMB_BUILD/poke" OTHER pair_query)
    kill -CONT "$record"
    finish_record
    is ".dropped > 10 and .lost == .dropped and .heard.others + .dropped == $sent"
    grep -q 'datagrams found no room in the receive buffer$' "$said"
}

@test "packets that crash LCM do not reach it" {
    start_record "$log"
    for poison in wrap short; do
        "$FMB_BUILD/poison" $poison FMB_PAIR_QUERY
        "$FMB_BUILD/poison" $poison OTHER
    done
    "$FMB_BUILD/poke" numbers 5 1
    finish_record
    is '.events == 1'
}

# ---- The terminal ----------------------------------------------------------------------------

@test "on a terminal it shows how it goes, elsewhere it does not" {
    mkfifo "$BATS_TEST_TMPDIR/keys"
    script -qfc "$FMB record --json $log > $heard" "$BATS_TEST_TMPDIR/screen" \
        < "$BATS_TEST_TMPDIR/keys" > /dev/null 3>&- &
    script=$!
    started=$script
    exec 9> "$BATS_TEST_TMPDIR/keys"
    wait_until grep -q 'recording to' "$BATS_TEST_TMPDIR/screen"
    "$FMB_BUILD/poke" numbers 5 $(seq 1000) 1003
    wait_until grep -q "fmb: 1,001 messages, .*/s, .* MB/s, 2 lost, 0 MB: $BATS_TEST_TMPDIR" "$BATS_TEST_TMPDIR/screen"
    printf '\003' >&9
    wait "$script"
    exec 9>&-
    is '.events == 1001'
    # Elsewhere: the test before this one could have been it.
    start_record "$log.2"
    "$FMB_BUILD/poke" numbers 5 $(seq 1000)
    wait_until has_events FMB_PAIR_QUERY "$log.2" 1000
    sleep 0.5
    finish_record
    [ "$(wc -l < "$said")" = 1 ]
    ! grep -q 'messages' "$said"
}

# ---- Buses -----------------------------------------------------------------------------------

@test "a bus that does not open or that ends" {
    run --separate-stderr "$FMB" record -l tcpq://127.0.0.1:1 "$log"
    [ "$status" = 1 ]
    [ "$output" = '' ]
    [ ! -e "$log" ]
    # A log that is played to its end as a bus.
    start_record "$log"
    "$FMB_BUILD/poke" numbers 5 1 2 3
    finish_record
    run --separate-stderr timeout 20 "$FMB" record --json -l "file://$log?speed=0" "$log.2"
    [ "$status" = 1 ]
    [[ $stderr == *'fmb: the bus has failed'* ]]
    [ "$(jq .events <<< "$output")" = 3 ]
    events "$log" > "$BATS_TEST_TMPDIR/played"
    events "$log.2" | cmp - "$BATS_TEST_TMPDIR/played"
}
