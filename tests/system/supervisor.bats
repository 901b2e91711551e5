# Workers that die, one way or another, and the supervisor that replaces them.

load service

# A sanitizer ends what crashes with a report and exit code 1; so it is a signal there too.
export ASAN_OPTIONS=abort_on_error=1

# Of a zombie nothing is left but a number.
alive() {
    grep -qs '^State:[[:space:]]*[^ZX]' "/proc/$1/status"
}

gone() {
    if alive "$1"; then return 1; fi
}

ready_lines() {
    grep -c 'ready: answers' "$fmbd_log"
}

ready_times() {
    [ "$(ready_lines)" = "$1" ]
}

last_server() {
    grep 'ready: answers' "$fmbd_log" | tail -n 1 | sed 's/.*server //'
}

# kill_worker SIGNAL: and waits for the next that is ready.
kill_worker() {
    local before
    before=$(ready_lines)
    kill -"$1" "$(worker_of "$fmbd")"
    wait_until ready_times $((before + 1))
}

# A log of LCM's that a service can replay as its bus. log_event FILE SECOND LENGTH: appends an
# event of one byte, which says that it has LENGTH (8 hexadecimal digits).
log_event() {
    local hex i
    hex=eda1da01$(printf '%016x%016x' 0 $(($2 * 1000000)))00000001$3
    for ((i = 0; i < ${#hex}; i += 2)); do printf "\\x${hex:i:2}"; done >> "$1"
    printf 'Ax' >> "$1"
}

@test "whichever way a worker ends, another takes its place, and nothing of it is left" {
    start_fmbd
    random_scene 2 4 > "$BATS_TEST_TMPDIR/scene.json"
    restarts=0
    for signal in KILL SEGV ABRT TERM INT; do
        "$FMB" query "$BATS_TEST_TMPDIR/scene.json"
        [ "$(status_of bodies)" = 4 ]
        worker=$(worker_of "$fmbd") server=$(last_server)
        kill_worker $signal
        : $((++restarts))
        [ "$(last_server)" != "$server" ]
        [ "$(worker_of "$fmbd")" != "$worker" ]
        grep -q "^fmbd: worker $worker died after [0-9.]* s: .*; restart $restarts\$" "$fmbd_log"
        "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
        [ "$(jq -c '[.restarts, .bodies, .received]' "$BATS_TEST_TMPDIR/status")" = "[$restarts,0,0]" ]
        "$FMB" status | grep -q "server $(last_server), .* restarted $restarts times"
    done
    grep -q ': SIGKILL; restart 1$' "$fmbd_log"
    grep -q ': exit code 0; restart 4$' "$fmbd_log"
    "$FMB" query --json "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus"
    "$FMB" query --json --local "$BATS_TEST_TMPDIR/scene.json" | cmp - "$BATS_TEST_TMPDIR/bus"
    stop_fmbd
}

@test "packets that crash LCM do not reach it, whatever the prefix" {
    for prefix in '' P a_prefix_of_thirty-two_character; do
        start_fmbd --prefix "$prefix"
        random_scene 3 4 > "$BATS_TEST_TMPDIR/scene.json"
        for poison in wrap short; do
            "$FMB_BUILD/poison" $poison "${prefix}FMB_PAIR_QUERY"
            "$FMB_BUILD/poison" $poison "${prefix}FMB_STATUS"
        done
        "$FMB" query --prefix "$prefix" "$BATS_TEST_TMPDIR/scene.json"
        "$FMB" query --prefix "$prefix" --certificate "$BATS_TEST_TMPDIR/scene.json"
        [ "$("$FMB" status --prefix "$prefix" --json | jq .restarts)" = 0 ]
        stop_fmbd
    done
}

@test "packets that crash LCM reach neither who watches, nor who waits for an answer" {
    random_scene 3 4 > "$BATS_TEST_TMPDIR/scene.json"
    timeout 60 "$FMB" watch --prefix P --json --count 2 > "$BATS_TEST_TMPDIR/watch" 3>&- &
    watch=$!
    "$FMB" query --prefix P --timeout 0.3 --retries 100 "$BATS_TEST_TMPDIR/scene.json" \
        > "$BATS_TEST_TMPDIR/answers" 3>&- &
    query=$!
    started="$watch $query"
    sleep 1 # until both listen
    for poison in wrap short; do
        "$FMB_BUILD/poison" $poison PFMB_SCENE_RESULT
        "$FMB_BUILD/poison" $poison PFMB_STATUS
    done
    start_fmbd --prefix P
    wait $query
    "$FMB" query --prefix P "$BATS_TEST_TMPDIR/scene.json" | cmp - "$BATS_TEST_TMPDIR/answers"
    wait $watch
    stop_fmbd
}

@test "packets that crash LCM, where they reach it, cost a worker each, and no more" {
    start_fmbd --unfiltered
    random_scene 3 4 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --json --local "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/local"
    restarts=0
    for poison in wrap short wrap short; do
        "$FMB_BUILD/poison" $poison FMB_PAIR_QUERY
        wait_until ready_times $((++restarts + 1))
        "$FMB" query --json "$BATS_TEST_TMPDIR/scene.json" | cmp - "$BATS_TEST_TMPDIR/local"
        [ "$(status_of restarts)" = $restarts ]
    done
    grep -q ': SIG[A-Z]*; restart 1$' "$fmbd_log"
    stop_fmbd
}

@test "a client loses nothing while workers die" {
    random_scene 3 120 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --json --box --local "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/local"
    start_fmbd
    "$FMB" query --json --box --timeout 0.1 --retries 100 "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus" 3>&- &
    client=$!
    started="$started $client"
    for _ in 1 2 3; do
        sleep 0.1
        kill_worker KILL
    done
    wait $client
    cmp "$BATS_TEST_TMPDIR/bus" "$BATS_TEST_TMPDIR/local"
    [ "$(status_of restarts)" = 3 ]
    stop_fmbd
}

@test "thirty workers killed as soon as they are ready, and it is there" {
    start_fmbd
    for _ in $(seq 30); do kill_worker KILL; done
    [ "$(status_of restarts)" = 30 ]
    [ "$(grep -c 'died after' "$fmbd_log")" -ge 10 ]
    [ "$(grep -c 'while starting' "$fmbd_log")" = 0 ]
    stop_fmbd
}

@test "without its supervisor a worker does not live" {
    start_fmbd
    worker=$(worker_of "$fmbd")
    alive "$worker"
    alive "$worker"
    kill -KILL "$fmbd"
    wait_until gone "$worker"
}

@test "SIGTERM and SIGINT, also to both at once: no death is told of, and none is left" {
    for to in supervisor both; do
        for signal in TERM INT; do
            fmbd_log=$BATS_TEST_TMPDIR/$to.$signal
            setsid "$FMBD" 2> "$fmbd_log" 3>&- &
            fmbd=$!
            started="${started-} $fmbd"
            wait_until ready_times 1
            worker=$(worker_of "$fmbd")
            alive "$worker"
            if [ $to = both ]; then kill -$signal -- "-$fmbd"; else kill -$signal "$fmbd"; fi
            wait "$fmbd"
            gone "$worker"
            [ "$(wc -l < "$fmbd_log")" = 1 ]
        done
    done
}

@test "a worker that does not end is killed" {
    start_fmbd
    worker=$(worker_of "$fmbd")
    alive "$worker"
    kill -STOP "$worker"
    stop_fmbd
    gone "$worker"
    [ "$(wc -l < "$fmbd_log")" = 2 ]
    grep -q "^fmbd: worker $worker does not end, and is killed\$" "$fmbd_log"
}

@test "workers that crash at start: exit code 1, after five, and why" {
    log_event "$BATS_TEST_TMPDIR/crash.log" 0 7fffffff
    run timeout 60 "$FMBD" --lcm-url "file://$BATS_TEST_TMPDIR/crash.log"
    [ "$status" = 1 ]
    [ "$(grep -c '^fmbd: worker .* while starting: SIG[A-Z]*; restart' <<< "$output")" = 4 ]
    [[ "${lines[-1]}" == "fmbd: giving up: 5 workers in a row died while starting, the last by SIG"* ]]
}

@test "a bus that was there and comes back after a while is waited for" {
    log=$BATS_TEST_TMPDIR/bus.log
    log_event "$log" 0 00000001
    log_event "$log" 3600 00000001 # and then nothing for an hour
    start_fmbd --lcm-url "file://$log"
    mv "$log" "$log.away"
    kill -KILL "$(worker_of "$fmbd")"
    wait_until grep -q 'while starting: exit code 1; restart 8 in 1000 ms$' "$fmbd_log"
    mv "$log.away" "$log"
    wait_until ready_times 2
    # That is forgotten then: the next pause would be the shortest again.
    mv "$log" "$log.away"
    kill -KILL "$(worker_of "$fmbd")"
    paused_twice() { [ "$(grep -c ' in 50 ms$' "$fmbd_log")" = 2 ]; }
    wait_until paused_twice
    # And a pause is no time in which it cannot be ended.
    stop_fmbd
}

@test "a reader of stderr that went away, or does not read, does not stop workers from being replaced" {
    mkfifo "$BATS_TEST_TMPDIR/pipe"
    for reader in gone asleep; do
        if [ $reader = gone ]; then
            head -n 1 < "$BATS_TEST_TMPDIR/pipe" > /dev/null 3>&- &
        else
            sleep 1000 < "$BATS_TEST_TMPDIR/pipe" 3>&- & # longer than anything here waits
            started="${started-} $!"
        fi
        "$FMBD" 2> "$BATS_TEST_TMPDIR/pipe" 3>&- &
        fmbd=$!
        started="$started $fmbd"
        wait_until "$FMB" status --timeout 0.2
        # To the brim where nobody reads.
        [ $reader = gone ] || timeout 1 dd if=/dev/zero of="$BATS_TEST_TMPDIR/pipe" bs=4096 2> /dev/null || true
        for restarts in 1 2 3; do
            kill -KILL "$(worker_of "$fmbd")"
            replaced() { [ "$(status_of restarts)" = "$restarts" ]; }
            wait_until replaced
        done
        stop_fmbd
    done
}

@test "without standard error it starts, and ends, as with it" {
    "$FMBD" 2>&- 3>&- &
    fmbd=$!
    started="${started-} $fmbd"
    wait_until "$FMB" status --timeout 0.2
    # What is said goes nowhere, and not into what was opened next.
    for pid in "$fmbd" "$(worker_of "$fmbd")"; do
        [ "$(readlink "/proc/$pid/fd/2")" = /dev/null ]
    done
    stop_fmbd
}

@test "the supervisor sleeps while nothing happens" {
    start_fmbd
    wakes() { awk '/^voluntary/ { print $2 }' "/proc/$fmbd/status"; }
    before=$(wakes)
    [ "$before" -gt 0 ]
    sleep 1
    # It looks once whether a worker that it started has become ready.
    [ $(($(wakes) - before)) -le 1 ]
    stop_fmbd
}
