# fmb log results: the rows of a log are the answers that are in it, whatever else is.

load ../ran

setup() {
    build=${FMB_BUILD:-build}
    FMB=$build/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    T=$BATS_TEST_TMPDIR
    log=$T/edited.log
}

# results ARGUMENTS
results() {
    run --separate-stderr "$FMB" log results "$@"
}

# edit KIND EDITS...: a log of the set, edited.
edit() {
    "$TOOLS/edit-log" "${@:2}" "tests/logs/$1.log" "$log"
}

# rows FILE: of the lines of JSON, as CSV has them.
rows() {
    jq -r '. as $line | (.pairs // [.])[] |
        [$line.utime, $line.scene, $line.label, .a, .b, .names[0]?, .names[1]?, .verdict,
         (.contact // [null, null])[], (.gap // [null, null])[],
         (.box // {min: [], max: []} | .min[0,1,2], .max[0,1,2]), .error,
         (.point // {position: []} | .time, .position[0,1,2])]
        | map(if type == "string" then "\"" + . + "\"" else . // "" | tostring end) | join(",")' "$1"
}

@test "the rows of a log are the answers to its queries" {
    "$FMB" log results --json --all tests/logs/arm.log > "$T/all"
    "$FMB" log results --json tests/logs/arm.log > "$T/contacts"
    found=0
    for scene in $(jq -r .scene "$T/all" | sort -un); do
        "$FMB" log scene --event "$scene" tests/logs/arm.log > "$T/scene" 2> "$T/said"
        # shellcheck disable=SC2046
        "$FMB" $(sed -n 's/.*to repeat it: fmb //p' "$T/said") "$T/scene" >> "$T/answers"
        found=$((found + 1))
    done
    [ "$found" = 72 ]
    jq -es --slurpfile answers "$T/answers" 'length == 72 and (sort_by(.scene) | map(.pairs)) == ($answers | map(.pairs))' "$T/all"
    jq -es --slurpfile answers "$T/answers" '(sort_by(.scene) | map([.pairs[] | [.a, .b, .verdict]])) ==
        ($answers | map([.pairs[] | select(.verdict != "separated") | [.a, .b, .verdict]]))' "$T/contacts"
}

@test "all pairs of a scene are there with --all, without those that are ignored" {
    for event in 0 2 4; do # across, listed, all
        "$FMB" log scene --event $event tests/logs/crowd.log 2> /dev/null |
            "$FMB" query --local --json | jq -c '.pairs[] | [.a, .b, .verdict]' > "$T/expected"
        "$FMB" log results --json --all tests/logs/crowd.log |
            jq -c "select(.scene == $event) | .pairs[] | [.a, .b, .verdict]" > "$T/found"
        [ -s "$T/found" ]
        cmp "$T/found" <(head -n "$(wc -l < "$T/found")" "$T/expected")
    done
}

@test "CSV has the numbers of JSON" {
    generate --blast pairs 200 --box --point "$T/points.log"
    for kind in tests/logs/{arm,stack,hard-3d-moving,clients} "$T/points"; do
        for all in '' --all; do
            # shellcheck disable=SC2086
            "$FMB" log results --json $all $kind.log > "$T/json"
            # shellcheck disable=SC2086
            "$FMB" log results --csv $all $kind.log | tail -n +2 > "$T/csv"
            rows "$T/json" > "$T/rows"
            [ "$(wc -l < "$T/csv")" = "$(wc -l < "$T/rows")" ]
            jq -Rn '[inputs | split(",") | map(. as $text | tonumber? // $text)]' "$T/csv" > "$T/a"
            jq -Rn '[inputs | split(",") | map(. as $text | tonumber? // $text)]' "$T/rows" > "$T/b"
            jq -en --slurpfile a "$T/a" --slurpfile b "$T/b" '
                [$a, $b] | map(.[0] | map(map(if type == "string" then gsub("\"|-?inf"; "") else . end)))
                | .[0] == .[1]' || { diff "$T/a" "$T/b" | head; false; }
        done
    done
}

# Bodies that overlap and do not move relative to each other have a deepest pair of points.
@test "witness points of bodies that overlap are printed and compared" {
    generate --blast pairs 100 --dim 3 --static --gap "$T/apart.log"
    n=$("$FMB" log results --json --all "$T/apart.log" | jq -s 'map(.pairs[0].verdict == "overlapping") | index(true)')
    "$TOOLS/edit-log" --witness "$n" "$T/apart.log" "$log"
    results --json --all "$log"
    ended 0
    jq -es --argjson n "$n" '.[$n].pairs[0] | .verdict == "overlapping" and .gap[1] < 0 and
        .witness == {time: 0, a: [1, 2, 3], b: [4, 5, 6]}' <<< "$output"
    "$FMB" log results --csv --all "$log" | cmp - <("$FMB" log results --csv --all "$T/apart.log")
    run "$FMB" replay --json "$log"
    ended 1
    jq -e '.different == 1 and .different_in.gap == 1 and (.differences[0].then | .witness.b == [4, 5, 6])' <<< "$output"
    "$FMB" replay --tolerance 1e-12 "$log"
}

@test "the table has a line for each result, and the pairs of scenes below it" {
    results tests/logs/arm.log
    ended 0
    [[ ${lines[0]} == '3141592653589793 #0 '*' us  up to pair 17: 0 overlapping, 5 touching, 12 separated' ]]
    [[ ${lines[1]} == '                                        3     1  touching     0 to 0.01 s  '* ]]
    [ "$(grep -c '#' <<< "$output")" = "$("$FMB" log results --json tests/logs/arm.log | jq -s 'map(select(has("end_pair") or .pairs != [])) | length')" ]
}

@test "results that come late, twice or by two services are printed once" {
    "$FMB" log results --json tests/logs/arm.log > "$T/expected"
    for edits in '--repeat 3 --repeat 40' '--delay 9' --last '--repeat-query 3'; do
        # shellcheck disable=SC2086
        edit arm $edits
        "$FMB" log results --json "$log" > "$T/found"
        jq -cs 'map(del(.scene)) | sort | .[]' "$T/expected" > "$T/a"
        jq -cs 'map(del(.scene)) | sort | .[]' "$T/found" > "$T/b"
        cmp "$T/a" "$T/b"
    done
}

@test "a result that depends on the moment is printed, and the one that follows" {
    edit arm --repeat 1 --refuse 1 2
    "$FMB" log results --csv --all tests/logs/arm.log | cut -d , -f 3- > "$T/expected"
    "$FMB" log results --csv --all "$log" | cut -d , -f 3- > "$T/found"
    run diff "$T/expected" "$T/found"
    [ "${#lines[@]}" = 2 ]
    [[ ${lines[1]} == '> ,'*',,,,,,,,,,,,,"'?*'",,,,' ]]
}

@test "results of scenes without their query are counted, and rows of pairs printed" {
    edit arm --first
    results --csv "$log"
    ended 2
    said "fmb: $log: offset 0: its query did not come before it, the first of 24: give the log before it, too"
    [ "${#lines[@]}" = 6 ]
    # With the log before it is whole.
    edit arm --events 0 73
    cp "$log" "$T/first.log"
    edit arm --events 73 146
    results --csv "$T/first.log" "$log"
    ended 0
    cut -d , -f 3- <<< "$output" | cmp - <("$FMB" log results --csv tests/logs/arm.log | cut -d , -f 3-)
}

@test "damage ends the rows, with its place and exit code 2" {
    edit arm --garbage 100
    at=$("$TOOLS/edit-log" --offset 100 tests/logs/arm.log)
    results --csv "$log"
    ended 2
    [[ $stderr == "fmb: $log: offset $at: "* ]]
    [ "${#stderr_lines[@]}" = 1 ]
    printf '%s\n' "${lines[@]}" > "$T/found"
    edit arm --events 0 100
    "$FMB" log results --csv "$log" | cmp - "$T/found"
}

@test "messages that cannot be read are reported, and the others printed" {
    edit arm --shorten 6 --version 10
    at=$("$TOOLS/edit-log" --offset 6 "$log")
    results --csv "$log"
    ended 2
    said "fmb: $log: offset $at: shorter than its fields, the first of 2"
    [ "${#lines[@]}" -gt 100 ]
}

@test "a log without results is reported" {
    edit arm --prefix a_
    results "$log"
    ended 2
    is ''
    said "fmb: $log: no results of this service (--prefix chooses it)"
    results --prefix a_ "$log"
    ended 0
    results "$T/none"
    ended 2
    said "fmb: $T/none: No such file or directory"
}

@test "a closed pipe ends the command, silently unless SIGPIPE is ignored" {
    run --separate-stderr bash -c "'$FMB' log results --csv --all tests/logs/crowd.log | head -n 1"
    ended 0
    said ''
    run --separate-stderr bash -c "trap '' PIPE; { '$FMB' log results --csv --all tests/logs/crowd.log; echo \$? >&2; } | head -n 1"
    [ "${stderr_lines[0]}" = 'fmb: standard output: Broken pipe' ]
    [ "${stderr_lines[1]}" = 1 ]
}

@test "memory does not grow with the log" {
    case $build in *asan*) skip "address sanitizer takes memory of its own" ;; esac
    generate --blast pairs 30000 --gap "$T/part.log"
    for _ in 1 2 3 4; do cat "$T/part.log"; done > "$log"
    [ "$(stat -c %s "$log")" -gt 65536000 ]
    (
        ulimit -v 65536
        "$FMB" log results --csv "$log" > /dev/null
    )
}

@test "a result whose query came too long before it is counted" {
    generate --blast scenes 300 "$T/whole.log"
    "$TOOLS/edit-log" --last "$T/whole.log" "$log"
    "$FMB" log results --json "$T/whole.log" > "$T/expected"
    status=0
    "$FMB" log results --json "$log" > "$T/rows" 2> "$T/said" || status=$?
    [ "$status" = 2 ]
    [[ $(< "$T/said") =~ 'the first of '([0-9]+)': give the log before it, too' ]]
    lost=${BASH_REMATCH[1]}
    [ "$lost" -gt 10 ]
    [ "$lost" -lt 100 ]
    # The first ones; the others are whole.
    cmp <(tail -n +$((lost + 1)) "$T/rows" | sed 's/"scene":[^,]*,//') <(tail -n +$((lost + 1)) "$T/expected" | sed 's/"scene":[^,]*,//')
    [ "$(grep -vc '"pairs":' "$T/rows")" = "$lost" ]
}
