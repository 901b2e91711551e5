# fmb log cut: what is typed, what is printed, exit codes; and what fmb replay says of the cuts.

load ../ran
load split

setup() {
    : "${FMB_BUILD:=build}"
    FMB=$FMB_BUILD/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    T=$BATS_TEST_TMPDIR
    log=$T/whole.log
    cut=$T/cut.log
}

# cuts CODE ARGUMENTS: of --json, in $output.
cuts() {
    local code=$1
    shift
    run --separate-stderr "$FMB" log cut --json "$@"
    [ "$status" = "$code" ] || {
        echo "expected exit code $code, found $status: $output $stderr"
        return 1
    }
}

# has FILTER: of the JSON that was printed.
has() {
    jq -e "$1" <<< "$output" > "$T/jq" || {
        echo "not $1: $output"
        return 1
    }
}

# outcomes LOG [OPTIONS]: what a replay says, by channel.
outcomes() {
    { "$FMB" replay --json "$@" 2> "$T/replay.err" || true; } |
        jq -c '[.channels[] | [.queries, .same, .different, .busy, .unknown_body, .no_result]]'
}

# ---- What is copied --------------------------------------------------------------------------

@test "without a selection the whole log is copied byte for byte" {
    for kind in arm clients crowd; do
        generate "$kind" "$log"
        cuts 0 "$log" -o "$cut" --force
        cmp "$log" "$cut"
        has '.kept_events == .events and .kept_bytes == .bytes and .added_bodies == 0'
    done
    # Here queries name handles that are defined later in the log: they are defined before them too.
    generate foreign "$log"
    cuts 0 "$log" -o "$cut" --force
    has '.kept_events == .events and .added_bodies > 0 and .unknown_handles == 0'
    cuts 0 "$cut" -o "$T/again.log"
    cmp "$cut" "$T/again.log"
    # And here are handles that no service ever held.
    generate refused "$log"
    cuts 0 "$log" -o "$cut" --force
    cmp "$log" "$cut"
    has '.unknown_handles > 0'
}

@test "replays of cuts of adjacent time ranges add up to the replay of the log" {
    for kind in clients arm; do
        generate "$kind" "$log"
        for span in '--to 0.013' '--from 0.013 --to 0.06' '--from 0.06 --to 0.2' '--from 0.2'; do
            # shellcheck disable=SC2086
            cuts 0 "$log" -o "$cut" --force $span
            outcomes "$cut"
        done > "$T/parts"
        [ "$(jq -sc 'transpose | map(transpose | map(add))' "$T/parts")" = "$(outcomes "$log")" ]
    done
}

@test "bodies that come whole before the cut are defined in it" {
    generate --blast pairs 20000 --by-handle "$log"
    cuts 0 "$log" -o "$cut" --from 0.15
    has '.added_bodies > 1000 and .unknown_handles == 0'
    has '.pair_queries == .pair_results and .pair_queries < 20000'
    outcomes "$cut" | jq -e '.[0][1] == .[0][0] and .[0][0] > 1000'
    # A cut of all that is the same, to the byte.
    cuts 0 "$cut" -o "$T/again.log"
    cmp "$cut" "$T/again.log"
    has '.added_bodies == 0 and .definitions > 1'
    # What is cut from the beginning needs none.
    cuts 0 "$log" -o "$cut" --force --to 0.15
    has '.added_bodies == 0'
    cmp -n "$(stat -c %s "$cut")" "$log" "$cut"
}

@test "--channel selects by an expression" {
    generate foreign "$log"
    cuts 0 "$log" -o "$cut"
    results=$(jq .pair_results <<< "$output")
    cuts 0 "$log" -o "$cut" --force --channel FMB_PAIR_RESULT
    has ".kept_events == $results and .pair_results == $results and $results > 10"
    cuts 0 "$log" -o "$cut" --force --channel '.*PAIR_RES.*|FMB_STATUS'
    has '.pair_results > 0 and .others > 0 and .heartbeats > 0 and .pair_queries == 0'
    # The whole name has to match.
    for part in PAIR_RES '.*PAIR_RES' 'PAIR_RES.*'; do
        cuts 1 "$log" -o "$cut" --force --channel "$part"
    done
    # With a prefix the service is another one.
    cuts 0 "$log" -o "$cut" --force --prefix LAB_ --channel '.*FMB_PAIR.*'
    has '.pair_queries > 0 and .others > 0'
}

@test "events at the same offset of several logs are distinguished" {
    generate stack "$log"
    "$FMB_BUILD/edit-log" --events 0 1 --rename FMB_SCENE_QUERY OTHER "$log" "$T/first.log"
    "$FMB_BUILD/edit-log" --events 8 40 "$log" "$T/second.log"
    cuts 0 "$T/first.log" "$T/second.log" -o "$cut" --to 0.001
    has '.kept_events == 1'
}

@test "queries without their results keep their definitions" {
    generate --blast pairs 20000 --by-handle "$log"
    cuts 0 "$log" -o "$cut" --from 0.15 --channel FMB_PAIR_QUERY
    has '.kept_events == .pair_queries and .added_bodies > 1000'
    outcomes "$cut" | jq -e '.[0][5] == .[0][0]'
    outcomes "$cut" --golden "$log" | jq -e '.[0][1] == .[0][0] and .[0][0] > 1000'
}

# ---- Damage ----------------------------------------------------------------------------------

@test "damage is reported with its offset, and is not copied" {
    generate stack "$log"
    cp "$log" "$T/good.log"
    at=$(offset_of "$log" 30)
    next=$(offset_of "$log" 31)
    printf 'XXXX' | dd of="$log" bs=1 seek="$at" conv=notrunc status=none
    truncate -s -10 "$log"
    run "$FMB" replay "$log"
    [ "$status" = 2 ]
    cuts 1 "$log" -o "$cut"
    has ".damages == 2 and .damaged_bytes > $((next - at)) and .kept_events == .events"
    [[ "$stderr" == *"offset $at: $((next - at)) bytes: no event; left out"* ]]
    [[ "$stderr" == *'the last event is cut off; left out'* ]]
    # The first 30 are as they were; those after them are numbered anew.
    cmp -n "$at" "$T/good.log" "$cut"
    cuts 0 "$cut" -o "$T/again.log"
    has '.damages == 0'
    run "$FMB" replay "$cut"
    [ "$status" = 0 ]
}

@test "damage at the beginning of a second log is reported" {
    generate stack "$log"
    (printf 'no log'; cat "$log") > "$T/second.log"
    cuts 1 "$log" "$T/second.log" -o "$cut"
    has '.damages == 1 and .damaged_bytes == 6'
    [[ "$stderr" == *"second.log: offset 0: 6 bytes"* ]]
    # As fmb replay reports it.
    run --separate-stderr "$FMB" replay "$log" "$T/second.log"
    [[ "$stderr" == *"second.log: offset 0: 6 bytes"* ]]
}

@test "messages that cannot be decoded are not damage" {
    generate foreign "$log"
    cuts 0 "$log" -o "$cut" --channel FMB_PAIR_QUERY
    has '.damages == 0 and .pair_queries > 44'
}

# ---- Files and usage -------------------------------------------------------------------------

@test "a file is overwritten only with --force, and a log never by its own cut" {
    generate stack "$log"
    cp "$log" "$T/good.log"
    echo precious > "$cut"
    cuts 2 "$log" -o "$cut"
    [ "$(cat "$cut")" = precious ]
    [[ "$stderr" == *"cut.log: File exists; --force overwrites it" ]]
    cuts 2 "$log" -o "$T"
    [ "$stderr" = "fmb: $T: Is a directory" ]
    cuts 0 "$log" -o "$cut" --force
    cmp "$log" "$cut"
    ln -s whole.log "$T/link.log"
    cuts 2 "$T/good.log" "$log" -o "$T/link.log" --force
    cmp "$log" "$T/good.log"
    [[ "$stderr" == *"link.log: this command reads it: write to another file" ]]
}

@test "files that cannot be read or written are reported" {
    generate --blast pairs 2000 "$log"
    cuts 2 "$T/nothing.log" -o "$cut"
    [ "$stderr" = "fmb: $T/nothing.log: No such file or directory" ]
    [ ! -e "$cut" ]
    cuts 2 "$log" -o "$T/nowhere/cut.log"
    [[ "$stderr" == *"nowhere/cut.log: No such file or directory" ]]
    cuts 2 "$log" -o /dev/full --force
    [[ "$stderr" == "fmb: /dev/full: No space left on device; free space there, or write elsewhere" ]]
    [ -z "$output" ]
}

@test "where nothing is chosen no file is written, and an old one stays" {
    generate stack "$log"
    cuts 1 "$log" -o "$cut" --from 1000
    has '.kept_events == 0 and .kept_bytes == 0'
    [ "$stderr" = "fmb: nothing was chosen: $cut is not written" ]
    [ ! -e "$cut" ]
    : > "$T/empty.log"
    cuts 1 "$T/empty.log" -o "$cut"
    [ ! -e "$cut" ]
    cp "$log" "$cut"
    cuts 1 "$log" -o "$cut" --force --from 1000
    [ "$stderr" = "fmb: nothing was chosen: $cut is not written" ]
    cmp "$log" "$cut"
}

@test "a cut is summarised as text" {
    generate --blast pairs 400 --by-handle "$log"
    run "$FMB" log cut "$log" -o "$cut" --from 0.001
    [ "$status" = 0 ]
    [[ "${lines[0]}" == 'kept '*' of 800 events; 0.'*' MB, of 0.'* ]]
    [[ "$output" =~ 'bodies defined '\ +[1-9] && "$output" =~ 'pair queries '\ +[1-9] ]]
}
