# For the tests of the daemon: start and stop it. Each file of tests runs
# in a network namespace of its own (tests/run.sh).

load ../ran

: "${FMB_BUILD:=build}"
FMBD=$FMB_BUILD/fmbd
FMB=$FMB_BUILD/fmb

# start_fmbd [OPTIONS]: the pid is in $fmbd, what it says in $fmbd_log.
start_fmbd() {
    fmbd_log=$BATS_TEST_TMPDIR/fmbd.$((++fmbd_count)).log
    "$FMBD" "$@" 2> "$fmbd_log" 3>&- &
    fmbd=$!
    started="${started-} $fmbd"
    wait_until has "$fmbd_log" ready
}

# stop_fmbd [SIGNAL]: the daemon must end well.
stop_fmbd() {
    kill -"${1:-TERM}" "$fmbd"
    wait "$fmbd"
}

teardown() {
    # A function in the background has processes of its own.
    for pid in ${started-}; do
        # shellcheck disable=SC2046
        kill -KILL $(cat "/proc/$pid/task/$pid/children" 2> /dev/null) "$pid" 2> /dev/null || true
    done
}

# start_record [OPTIONS] FILE: records until finish_record. The pid is in $record, what it says in
# $messages.
start_record() {
    : > "$messages" # those of an earlier one
    "$FMB" record --json "$@" > "$report" 2> "$messages" 3>&- 9>&- &
    record=$!
    started="${started-} $record"
    wait_until has "$messages" 'recording to'
}

# finish_record [SIGNAL]: its summary is in $report.
finish_record() {
    kill -"${1:-INT}" "$record"
    wait "$record"
}

# start_watch [OPTIONS]: what it prints is in $watched, from the first result that is sent now.
start_watch() {
    watched=$BATS_TEST_TMPDIR/watched.$((++watches))
    "$FMB" watch "$@" > "$watched" 2> "$watched.said" 3>&- &
    watch=$!
    started="${started-} $watch"
    wait_until has "$watched.said" 'watching FMB_PAIR_RESULT and FMB_SCENE_RESULT of '
}

# wait_until_watched FILTER...: until it is true of the array of the lines of JSON.
wait_until_watched() {
    wait_until jq -es "$@" "$watched" > "$watched.is" 2> "$watched.why" || {
        tail -n 1 "$watched.why"
        return 1
    }
}

# query_in_step: queries the scenes of standard input, one a line, by one client: bodies go by handle
# where they were in an earlier scene. Twenty at a time are answered, and read by all receivers.
query_in_step() {
    local scene count=0 scenes=$BATS_TEST_TMPDIR/in_step answers=$BATS_TEST_TMPDIR/in_step.answers
    mkfifo "$scenes"
    "$FMB" query --json - < "$scenes" > "$answers" 3>&- &
    exec 9> "$scenes"
    while read -r scene; do
        echo "$scene" >&9
        if ((++count % 20)); then continue; fi
        wait_until has_lines "$answers" $count
        "$TOOLS/fake-peer" wait
    done
    exec 9>&-
    wait $!
    rm "$scenes"
}

# status_of FIELD: a number of the next heartbeat.
status_of() {
    [[ $("$FMB" status --json) =~ \"$1\":\ *([0-9]+) ]]
    echo "${BASH_REMATCH[1]}"
}

# random_scene DIM BODIES [SEED [COUNT]]: a moving scene of all shapes, with all pairs; or so many, one a
# line.
random_scene() {
    awk -v dim="$1" -v bodies="$2" -v seed="${3:-1}" -v count="${4:-1}" '
        function vector(n, size,   i, text) {
            text = "["
            for (i = 0; i < n; i++) text = text (i ? "," : "") (rand() - 0.5) * size
            return text "]"
        }
        BEGIN {
            srand(seed)
            while (count--) scene()
        }
        function scene(   b, c, shape, name, components, velocity) {
            printf "{\"dim\":%d,\"duration\":0.7,\"bodies\":[", dim
            for (b = 1; b <= bodies; b++) {
                shape = int(rand() * dim)
                components = shape == 2 ? 2 : dim
                name = shape == 0 ? "cuboid" : shape == 1 ? "tetrahedron" : "face"
                printf "%s{\"id\":%d,\"shape\":\"%s\",\"origin\":%s,", (b == 1 ? "" : ","), b,
                    name, vector(dim, 4)
                printf "\"components\":["
                for (c = 0; c < components; c++) printf "%s%s", (c ? "," : ""), vector(dim, 4)
                velocity = rand() < 0.5 ? ",\"velocity\":" vector(dim, 4) : ""
                printf "]%s}", velocity
            }
            print "]}"
        }'
}
