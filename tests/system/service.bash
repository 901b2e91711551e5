# For the tests of the daemon: start and stop it, and wait with bounds. Each file of tests runs
# in a network namespace of its own (tests/run.sh).

: "${FMB_BUILD:=build}"
FMBD=$FMB_BUILD/fmbd
FMB=$FMB_BUILD/fmb

# Waits up to 10 s until a command succeeds.
wait_until() {
    for _ in $(seq 200); do
        if "$@"; then return 0; fi
        sleep 0.05
    done
    echo "waited in vain for: $*" >&2
    return 1
}

# start_fmbd [OPTIONS]: the pid is in $fmbd, what it says in $fmbd_log.
start_fmbd() {
    fmbd_log=$BATS_TEST_TMPDIR/fmbd.$((++fmbd_count)).log
    "$FMBD" "$@" 2> "$fmbd_log" 3>&- &
    fmbd=$!
    started="${started-} $fmbd"
    wait_until grep -q ready "$fmbd_log"
}

# stop_fmbd [SIGNAL]: the daemon must end well.
stop_fmbd() {
    kill -"${1:-TERM}" "$fmbd"
    wait "$fmbd"
}

teardown() {
    for pid in ${started-}; do kill -KILL "$pid" 2> /dev/null || true; done
}

# start_record [OPTIONS] FILE: records until finish_record. The pid is in $record, what it says in
# $messages.
start_record() {
    : > "$messages" # those of an earlier one
    "$FMB" record --json "$@" > "$report" 2> "$messages" 3>&- 9>&- &
    record=$!
    started="${started-} $record"
    wait_until grep -qs 'recording to' "$messages"
}

# finish_record [SIGNAL]: its summary is in $report.
finish_record() {
    kill -"${1:-INT}" "$record"
    wait "$record"
}

# status_of FIELD[,.FIELD]...: numbers of the next heartbeat, one a line.
status_of() {
    "$FMB" status --json | jq -r ".$1"
}

# random_scene DIM BODIES: a moving scene of all shapes, with all pairs.
random_scene() {
    awk -v dim="$1" -v bodies="$2" -v seed="${3:-1}" '
        function vector(n, size,   i, text) {
            text = "["
            for (i = 0; i < n; i++) text = text (i ? "," : "") (rand() - 0.5) * size
            return text "]"
        }
        BEGIN {
            srand(seed)
            printf "{\"dim\":%d,\"duration\":0.7,\"bodies\":[", dim
            for (b = 1; b <= bodies; b++) {
                shape = int(rand() * dim)
                count = shape == 2 ? 2 : dim
                name = shape == 0 ? "cuboid" : shape == 1 ? "tetrahedron" : "face"
                printf "%s{\"id\":%d,\"shape\":\"%s\",\"origin\":%s,", (b == 1 ? "" : ","), b,
                    name, vector(dim, 4)
                printf "\"components\":["
                for (c = 0; c < count; c++) printf "%s%s", (c ? "," : ""), vector(dim, 4)
                velocity = rand() < 0.5 ? ",\"velocity\":" vector(dim, 4) : ""
                printf "]%s}", velocity
            }
            print "]}"
        }'
}
