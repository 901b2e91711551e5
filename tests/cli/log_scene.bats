# fmb log scene: a query of a log, as a scene to decide again.

load ../ran
load split

setup() {
    : "${FMB_BUILD:=build}"
    FMB=$FMB_BUILD/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    T=$BATS_TEST_TMPDIR
    log=$T/whole.log
}

# scene CODE ARGUMENTS
scene() {
    local code=$1
    shift
    run --separate-stderr "$FMB" log scene "$@"
    [ "$status" = "$code" ] || {
        echo "expected exit code $code, found $status: $stderr"
        return 1
    }
}

said() {
    [[ "$stderr" == *"$1"* ]] || {
        echo "expected: $1"
        echo "found:    $stderr"
        return 1
    }
}

# answers OPTIONS: of the scene that was printed.
answers() {
    "$FMB" query --local --json "$@" <<< "$output"
}

@test "each query of a log is a scene that can be decided, with its command" {
    generate arm "$log"
    scenes=0
    certificates=0
    # log_results.bats decides the scene of each query.
    for ((event = 1; event < 146; event += 2)); do
        "$FMB" log scene "$log" --event "$event" > "$T/scene" 2> "$T/said" || continue
        scenes=$((scenes + 1))
        stderr=$(< "$T/said")
        said "to repeat it: fmb query --local --json"
        command=${stderr##*to repeat it: fmb }
        [[ "$command" != *--certificate* ]] || certificates=$((certificates + 1))
        # shellcheck disable=SC2086
        "$FMB" ${command} < "$T/scene" >> "$T/answers"
    done
    jq -es "length == $scenes and all(.[].pairs; length > 0 and all(has(\"verdict\")))" "$T/answers" > "$T/jq"
    [ "$scenes" -gt 60 ]
    [ "$certificates" -gt 0 ]
}

@test "the answers of a single query are those in the log" {
    generate --blast pairs 40 --by-handle --box --point --certificate "$log"
    "$FMB" replay "$log" --write-golden "$T/golden.log" > "$T/said"
    for event in 20 40 78; do
        scene 0 "$log" --event "$event"
        said "to repeat it: fmb query --local --json --box --point --certificate"
        said 'sequence number '
        answers --box --point --certificate > "$T/$event.json"
        jq -e '.pairs[0] | has("certificate") and .a != .b and has("contact") == has("point")' "$T/$event.json" > "$T/jq"
    done
}

@test "bodies by handle have their frames, also those that an earlier log defines" {
    generate --blast pairs 60 --by-handle "$log"
    split_at "$log" 60
    scene 0 "$log" --event 100
    query=$output
    jq -e '.bodies | all(.components | length == 3 or length == 2)' <<< "$query" > "$T/jq"
    scene 0 "$T/first.log" "$T/second.log" --event 100
    [ "$output" = "$query" ]
    # By itself the second log does not define all handles.
    unknown=0
    for ((event = 60; event < 120; event += 2)); do
        status=0
        "$FMB" log scene "$T/second.log" --event "$event" > "$T/scene" 2> "$T/said" || status=$?
        [ "$status" != 0 ] || continue
        [ "$status" = 1 ]
        [ ! -s "$T/scene" ]
        grep -q 'came by a handle that no log here defines' "$T/said"
        unknown=$((unknown + 1))
    done
    [ "$unknown" -gt 0 ]
    # A cut defines them.
    "$FMB" log cut "$log" --from 0.001 -o "$T/cut.log" > "$T/said"
    scene 0 "$log" --event 118
    query=$output
    number=$(sed 's/.*sequence number \([0-9]*\);.*/\1/' <<< "$stderr")
    client=$(sed 's/.*client \([0-9]*\),.*/\1/' <<< "$stderr")
    event=$("$FMB" log results --json "$T/cut.log" | jq "select(.client_id == $client and .sequence_number == $number).scene" | head -n 1)
    scene 0 "$T/cut.log" --event "$event"
    [ "$output" = "$query" ]
}

@test "the pairs of a scene are those of the query" {
    generate crowd "$log"
    forms=
    for event in 0 2 4 6 8 10; do
        run --separate-stderr "$FMB" log scene "$log" --event "$event"
        [ "$status" = 0 ] || continue
        forms+=$(jq -c 'has("pairs")' <<< "$output")
        answers | jq -e '.pairs | length > 0' > "$T/jq"
    done
    [[ "$forms" == *true* && "$forms" == *false* ]]
}

@test "a refused query has no scene, and the reason is reported; bodies without a distinct id get one" {
    generate --blast pairs 30 --whole "$log"
    scene 0 "$log" --event 0
    [[ "$stderr" == *'fmb: event 0 (offset 0), client '* ]]
    generate refused "$log"
    scene 1 "$log" --event 22
    [ -z "$output" ]
    [ "$stderr" = 'fmb: event 22: the service refuses it: a.num_numbers: expected 12 numbers, found 11' ]
    found=0
    for ((event = 0; event < 230; event += 3)); do
        status=0
        "$FMB" log scene "$log" --event "$event" > "$T/scene" 2> "$T/said" || status=$?
        # None of them makes it fail in another way.
        [ "$status" = 0 ] || { [ "$status" = 1 ] && [ ! -s "$T/scene" ]; }
        stderr=$(< "$T/said")
        [[ "$stderr" == *'which has no id, is body '* || "$stderr" == *', one more of body '* ]] || continue
        [ "$status" = 0 ]
        "$FMB" query --local --json "$T/scene" > "$T/answers" || [ "$?" = 1 ]
        found=$((found + 1))
    done
    [ "$found" -gt 0 ]
}

@test "events whose number repeats get new ones from 'fmb log cut'" {
    generate stack "$T/one.log"
    cat "$T/one.log" "$T/one.log" > "$log"
    scene 1 "$log" --event 2
    said "event 2 is there 2 times: 'fmb log cut' numbers events anew"
    "$FMB" log cut "$log" -o "$T/anew.log"
    scene 0 "$T/anew.log" --event 2
    # Of the last log only.
    scene 0 "$T/one.log" "$T/one.log" --event 2
}

@test "the margin of a query is in its scene" {
    generate stack "$log"
    margins=
    for event in 0 2 4 6 8; do
        scene 0 "$log" --event "$event"
        margins="$margins $(jq '1e9 * (.margin // 0)' <<< "$output")"
        # As 'fmb query' reads it: the gaps of pairs within the margin are in the answers.
        answers > "$T/answers"
        [ "$(jq '[.pairs[] | select(has("gap"))] | length > 0' "$T/answers")" = \
            "$(jq 'has("margin")' <<< "$output")" ]
    done
    echo "$margins"
    [ "$margins" = ' 31250000 0 0 0 1' ]
}

@test "a number that is not a query is reported" {
    generate foreign "$log"
    scene 1 "$log" --event 5000
    [ "$stderr" = "fmb: $log: event 5000: there is none" ]
    scene 1 "$log" --event 258
    said 'event 258: longer than its fields'
    event_of() { "$TOOLS/events" "$log" | awk -v channel="$1" '$3 == channel && !found++ { print NR - 1 }'; }
    scene 1 "$log" --event "$(event_of FMB_STATUS)"
    said 'not a query of this service (--prefix chooses it)'
    scene 1 "$log" --event "$(event_of FMB_PAIR_RESULT)"
    said 'a result: give the number of its query'
    scene 2 "$T/nothing.log" --event 0
    [ "$stderr" = "fmb: $T/nothing.log: No such file or directory" ]
}
