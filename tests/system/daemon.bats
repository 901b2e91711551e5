# How the daemon starts, reports what it does, and ends.

load service

@test "the daemon reports when it is ready, and exits with 0 on SIGTERM and SIGINT" {
    for signal in TERM INT; do
        start_fmbd
        grep -q 'ready: answers FMB_PAIR_QUERY on FMB_PAIR_RESULT, FMB_SCENE_QUERY on FMB_SCENE_RESULT, FMB_DEFINITION_QUERY on FMB_DEFINITION, heartbeat on FMB_STATUS' "$fmbd_log"
        stop_fmbd "$signal"
    done
}

# bats test_tags=release
@test "SIGTERM under load ends the daemon at once with 0" {
    start_fmbd
    random_scene 3 900 > "$BATS_TEST_TMPDIR/scene.json"
    for client in 1 2; do
        while :; do cat "$BATS_TEST_TMPDIR/scene.json"; done 2> /dev/null |
            "$FMB" query --box --json --timeout 0.2 --retries 0 > /dev/null 2>&1 3>&- &
        started="$started $!"
    done
    is_loaded() { [ "$(status_of pairs)" -gt 100 ]; }
    wait_until is_loaded
    # The pace of the machine: the time of a daemon that does nothing else.
    begin=${EPOCHREALTIME/./}
    "$FMBD" --version
    pace=$((${EPOCHREALTIME/./} - begin))
    kill -TERM "$fmbd"
    begin=${EPOCHREALTIME/./}
    wait "$fmbd"
    [ $((${EPOCHREALTIME/./} - begin)) -lt $((2000000 + 10 * pace)) ]
}

@test "no answer is lost when the service dies and restarts" {
    random_scene 3 100 > "$BATS_TEST_TMPDIR/scene.json"
    start_fmbd
    touch "$BATS_TEST_TMPDIR/more"
    while [ -e "$BATS_TEST_TMPDIR/more" ]; do cat "$BATS_TEST_TMPDIR/scene.json"; done |
        "$FMB" query --json --box --timeout 0.2 --retries 500 > "$BATS_TEST_TMPDIR/bus" 3>&- &
    client=$!
    started="$started $client"
    for _ in 1 2 3; do
        wait_until has_lines "$BATS_TEST_TMPDIR/bus" $(($(wc -l < "$BATS_TEST_TMPDIR/bus") + 2))
        kill -KILL "$fmbd"
        start_fmbd
    done
    wait_until has_lines "$BATS_TEST_TMPDIR/bus" $(($(wc -l < "$BATS_TEST_TMPDIR/bus") + 2))
    rm "$BATS_TEST_TMPDIR/more"
    wait $client
    "$FMB" query --json --box --local "$BATS_TEST_TMPDIR/scene.json" | cmp - <(sort -u "$BATS_TEST_TMPDIR/bus")
    stop_fmbd
}

# bats test_tags=release
@test "without a service a query fails with exit code 1 and a hint" {
    random_scene 2 3 > "$BATS_TEST_TMPDIR/scene.json"
    run "$FMB" query --timeout 0.1 --retries 1 "$BATS_TEST_TMPDIR/scene.json"
    [ "$status" = 1 ]
    [[ "$output" == *"start one with 'fmbd"* ]]
    # What to run is a service on this bus.
    bus='udpm://239.255.76.67:7668?ttl=0'
    for command in "query --timeout 0.01 --retries 1 $BATS_TEST_TMPDIR/scene.json" 'status --timeout 0.1'; do
        run "$FMB" $command --lcm-url "$bus" --prefix P
        [ "$status" = 1 ]
        [[ "$output" == *"start one with 'fmbd --lcm-url \"$bus\" --prefix P &'"* ]]
    done
}

# bats test_tags=release
@test "a query continues when the service starts late, and when it is restarted" {
    random_scene 2 3 1 40 > "$BATS_TEST_TMPDIR/scenes.json"
    "$FMB" query --json --local "$BATS_TEST_TMPDIR/scenes.json" > "$BATS_TEST_TMPDIR/local"
    "$FMBD" 2> "$BATS_TEST_TMPDIR/log" 3>&- &
    fmbd=$!
    started="${started-} $fmbd"
    "$FMB" query --json --retries 100 "$BATS_TEST_TMPDIR/scenes.json" | cmp - "$BATS_TEST_TMPDIR/local"
    mkfifo "$BATS_TEST_TMPDIR/fifo"
    "$FMB" query --json --timeout 0.2 --retries 0 < "$BATS_TEST_TMPDIR/fifo" > "$BATS_TEST_TMPDIR/bus" 2> /dev/null 3>&- &
    client=$!
    exec 5> "$BATS_TEST_TMPDIR/fifo"
    head -n 10 "$BATS_TEST_TMPDIR/scenes.json" >&5
    wait_until test -s "$BATS_TEST_TMPDIR/bus"
    stop_fmbd
    sed -n 11,14p "$BATS_TEST_TMPDIR/scenes.json" >&5
    wait_until has_lines "$BATS_TEST_TMPDIR/bus" 14
    [[ $(sed -n 14p "$BATS_TEST_TMPDIR/bus") == *'no fmbd answered'* ]]
    start_fmbd 5>&-
    # On a slow machine an answer may take longer than the timeout.
    for ((line = 15; line <= 40; line++)); do
        sed -n ${line}p "$BATS_TEST_TMPDIR/scenes.json" >&5
        wait_until has_lines "$BATS_TEST_TMPDIR/bus" $line
        if [ "$(sed -n ${line}p "$BATS_TEST_TMPDIR/bus")" = "$(sed -n ${line}p "$BATS_TEST_TMPDIR/local")" ]; then break; fi
    done
    [ $line -le 40 ]
    exec 5>&-
    wait $client || [ $? = 1 ]
    stop_fmbd
}

@test "the heartbeat counts the work of the service" {
    start_fmbd --frames 500
    random_scene 2 5 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query "$BATS_TEST_TMPDIR/scene.json"
    # Under load, clients repeat queries.
    "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
    jq -e '.scenes >= 2 and .received == .scenes and .pairs == 10 * .scenes and .bodies == 5 and
        .frame_capacity == 500 and .misses == 5 and .hits == 5 * (.scenes - 1)' "$BATS_TEST_TMPDIR/status"
    "$FMB" query --certificate "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
    jq -e '(.pairs - 10 * .scenes) as $single | $single >= 10 and .received == .scenes + $single and
        .malformed == 0 and .received == .answered + .unsent and
        .answered == ([.results[]] | add)' "$BATS_TEST_TMPDIR/status"
    run "$FMB" status
    [ "$status" = 0 ]
    for row in received scenes definitions answered 'pairs decided' 'not sent' malformed waiting; do
        grep -qE "^ +$row +[0-9,]+" <<< "$output"
    done
    stop_fmbd
}

# bats test_tags=release
@test "started as root, the daemon runs as the user 'nobody', or as the user given" {
    [ "$(id -u)" = 0 ] && [ "$(wc -l < /proc/self/uid_map)" = 1 ] &&
        [ "$(awk '{ print $3 }' /proc/self/uid_map)" -gt 65534 ] || skip "needs root and its ids"
    for user in nobody daemon; do
        if [ $user = nobody ]; then start_fmbd; else start_fmbd --user $user; fi
        id=$(id -u $user)
        [ "$(awk '/^Uid:/ { print $2, $3, $4 }' "/proc/$fmbd/status")" = "$id $id $id" ]
        [ "$(awk '/^Groups:/ { print NF }' "/proc/$fmbd/status")" = 2 ]
        [ "$(awk '/^NoNewPrivs:/ { print $2 }' "/proc/$fmbd/status")" = 1 ]
        "$FMB" status > /dev/null
        stop_fmbd
    done
    run "$FMBD" --user no-such-user
    [ "$status" = 1 ]
    [[ "$output" == *"--user"* ]]
}

# bats test_tags=release
@test "where an id does not exist, the daemon warns once and continues" {
    [ "$FMB_NETNS" = own ] || skip "needs namespaces"
    unshare -r true || skip "needs user namespaces"
    unshare -r "$FMBD" 2> "$BATS_TEST_TMPDIR/err" 3>&- &
    fmbd=$!
    started="${started-} $fmbd"
    wait_until has "$BATS_TEST_TMPDIR/err" ready
    [ "$(grep -c warning "$BATS_TEST_TMPDIR/err")" = 1 ]
    stop_fmbd
}

@test "a filter of system calls is installed" {
    case $FMB_BUILD in *asan*) skip "sanitizers need other calls" ;; esac
    start_fmbd
    [ "$(awk '/^Seccomp:/ { print $2 }' "/proc/$fmbd/status")" = 2 ]
    stop_fmbd
}

# bats test_tags=release
@test "a service manager is notified when the daemon is ready, alive and stopping" {
    "$TOOLS/fake-peer" listen "$BATS_TEST_TMPDIR/notify" > "$BATS_TEST_TMPDIR/received" 3>&- &
    started="${started-} $!"
    wait_until test -S "$BATS_TEST_TMPDIR/notify"
    NOTIFY_SOCKET=$BATS_TEST_TMPDIR/notify WATCHDOG_USEC=400000 start_fmbd
    alive() { [ "$(grep -c '^WATCHDOG=1$' "$BATS_TEST_TMPDIR/received")" -ge 3 ]; }
    wait_until alive
    stop_fmbd
    [ "$(head -n 1 "$BATS_TEST_TMPDIR/received")" = READY=1 ]
    stopping() { [ "$(tail -n 1 "$BATS_TEST_TMPDIR/received")" = STOPPING=1 ]; }
    wait_until stopping
}

# bats test_tags=release
@test "heartbeats and watchdog notifications are sent under constant load" {
    "$TOOLS/fake-peer" listen "$BATS_TEST_TMPDIR/notify" > "$BATS_TEST_TMPDIR/received" 3>&- &
    started="${started-} $!" clients=
    wait_until test -S "$BATS_TEST_TMPDIR/notify"
    NOTIFY_SOCKET=$BATS_TEST_TMPDIR/notify WATCHDOG_USEC=400000 start_fmbd
    random_scene 3 150 > "$BATS_TEST_TMPDIR/scene.json"
    touch "$BATS_TEST_TMPDIR/busy"
    for _ in 1 2 3; do # of each a scene of tenths of a second, again and again
        (while [ -e "$BATS_TEST_TMPDIR/busy" ]; do
            "$FMB" query --json --method exact "$BATS_TEST_TMPDIR/scene.json" > /dev/null
        done) 3>&- &
        started="$started $!" clients="$clients $!"
    done
    is_loaded() { [ "$(status_of pairs)" -gt 0 ]; }
    wait_until is_loaded
    signs() { grep -c '^WATCHDOG=1$' "$BATS_TEST_TMPDIR/received"; }
    before=$(signs)
    "$FMB" status > /dev/null
    "$FMB" status > /dev/null
    [ $(($(signs) - before)) -ge 3 ]
    rm "$BATS_TEST_TMPDIR/busy"
    wait $clients
    stop_fmbd
}

# bats test_tags=release
@test "without a route for multicast the daemon prints the command that adds one" {
    unshare -rn true || skip "needs a network without routes"
    run unshare -rn "$FMBD" --lcm-url udpm://239.8.7.6:7667
    [ "$status" = 1 ]
    [[ $output == "fmbd: no route to the multicast group 239.8.7.6"*"ip route add 224.0.0.0/4 dev lo" ]]
    [ "${#lines[@]}" = 1 ]
}

# bats test_tags=release
@test "an invalid bus is refused with exit code 1 and one line" {
    for url in nonsense foo://bar tcpq://127.0.0.1:1; do
        run timeout 10 "$FMBD" --lcm-url $url
        [ "$status" = 1 ]
        [[ "$output" == *"fmbd: "*"$url"* ]]
    done
}

# bats test_tags=release
@test "a closed or stalled reader of stderr does not stop the daemon" {
    mkfifo "$BATS_TEST_TMPDIR/pipe"
    for reader in gone asleep; do
        # The reader opens the pipe, so that the daemon can; then it leaves, or sleeps.
        if [ $reader = gone ]; then
            head -n 1 < "$BATS_TEST_TMPDIR/pipe" > /dev/null 3>&- &
        else
            sleep 600 < "$BATS_TEST_TMPDIR/pipe" 3>&- &
            started="${started-} $!"
        fi
        "$FMBD" 2> "$BATS_TEST_TMPDIR/pipe" 3>&- &
        fmbd=$!
        started="$started $fmbd"
        wait_until "$FMB" status --timeout 0.2
        # Fill the pipe to the brim without a reader.
        [ $reader = gone ] || dd if=/dev/zero of="$BATS_TEST_TMPDIR/pipe" bs=4096 oflag=nonblock 2> /dev/null || true
        "$TOOLS/fake-peer" FMB_PAIR_QUERY status
        [ "$(status_of malformed)" -gt 100 ]
        stop_fmbd
    done
}

# bats test_tags=release
@test "a second service on the same channels is reported" {
    start_fmbd
    one=$fmbd one_log=$fmbd_log
    start_fmbd
    wait_until has "$one_log" 'another service'
    wait_until has "$fmbd_log" 'another service'
    stop_fmbd
    fmbd=$one
    stop_fmbd
}

@test "wrong options are refused with exit code 2 and a hint; help and version exit with 0" {
    for options in --nonsense --frames=0 --frames=-1 --frames=1x --frames=99999999999999999999 --bodies=5 --unfiltered \
        '--prefix=a.*' extra; do
        run "$FMBD" "$options"
        [ "$status" = 2 ]
        [[ "$output" == *"fmbd --help"* ]]
    done
    for wrong in "-x:unknown option '-x'" "--no:unknown option '--no'" "-f:option '-f' needs a value" \
        "-f0:--frames '0': expected a number from 1 to 10000000"; do
        run "$FMBD" "${wrong%%:*}"
        [ "$status:$output" = "2:fmbd: ${wrong#*:}; see fmbd --help" ]
    done
    run "$FMBD" --help
    [ "$status" = 0 ]
    [[ "${lines[0]}" == "usage: fmbd"* ]]
    run "$FMBD" --version
    [ "$status" = 0 ]
    [[ "$output" == "fmbd "[0-9]* ]]
}
