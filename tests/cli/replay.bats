# fmb replay: what is typed, what is printed, exit codes; on logs that are made here, and spoiled by
# edit-log in one way each.

load ../ran

setup_file() {
    cd "$BATS_FILE_TMPDIR" || return
    local build
    build=$(cd "$BATS_TEST_DIRNAME/../.." && cd "${FMB_BUILD:-build}" && pwd)
    for kind in arm clients foreign refused stack; do generate $kind $kind.log; done
    generate --blast pairs 400 --box --certificate blast.log
    generate --blast pairs 40 --moving --box --whole moving.log
    generate --blast pairs 20 --dim 3 --static --gap apart.log
}

setup() {
    local build
    build=$(cd "$BATS_TEST_DIRNAME/../.." && cd "${FMB_BUILD:-build}" && pwd)
    FMB=$build/fmb
    EDIT=$TOOLS/edit-log
    cd "$BATS_TEST_TMPDIR" || return
    ln -s "$BATS_FILE_TMPDIR"/*.log .
}

# edit EDIT... LOG: the copy is spoiled.log.
edit() {
    "$EDIT" "$@" spoiled.log
}

# replay ARGUMENT...: as JSON, kept apart from what is said.
replay() {
    run --separate-stderr "$FMB" replay --json "$@"
    [ "${#lines[@]}" = 1 ]
}

# counts EXPRESSION...: true of the report.
counts() {
    holds "$BATS_TEST_TMPDIR.out" "$@"
}

# What a report says but for the times taken.
report_of() {
    { "$FMB" replay --json "$@" 2> /dev/null || true; } | jq -cS 'del(.compute.now)'
}

# junit ARGUMENT...: the report is well-formed.
junit() {
    run "$FMB" replay --junit report.xml "$@"
    xmllint --noout report.xml
}

# xpath EXPRESSION: what the report says there.
xpath() {
    xmllint --xpath "string($1)" report.xml
}

# ---- All the same -----------------------------------------------------------------------------

# bats test_tags=release
@test "a log with right answers has no differences" {
    run --separate-stderr "$FMB" replay arm.log
    ended 0
    [ -z "$stderr" ]
    [[ $output == *"FMB_PAIR_QUERY             48           48           48            0 "* ]]
    [[ $output == *"146 events, 0.1 MB; 0 on other channels; 0 results of queries that are not here"* ]]
    replay arm.log
    ended 0
    counts '.queries == 72 and .same == 72 and .differences == [] and .exit == 0' \
        ".events == 146 and .bytes == $(stat -Lc %s arm.log) and .statuses == 2 and .results == 72" \
        '.channels.FMB_PAIR_QUERY.queries == 48 and .channels.FMB_SCENE_QUERY.pairs == 408' \
        '.compute | .then.count == 72 and .now.count == 72 and .unit == "ns"'
}

# ---- Differences ------------------------------------------------------------------------------

# bats test_tags=release
@test "an altered verdict is a difference" {
    edit --flip 3 --flip 4 arm.log
    run --separate-stderr "$FMB" replay spoiled.log
    ended 1
    [ -z "$stderr" ]
    [ "${lines[0]}" = 'event 7  0.010000 s  bodies 3 1  verdict: overlapping, now touching' ]
    [[ ${lines[1]} =~ ^event\ [0-9]+\ .*\ verdict:\ (touching|overlapping),\ now\  ]]
    [[ $output == *'different in: 2 verdict'* ]]
    replay spoiled.log
    ended 1
    counts '.different == 2 and .different_in.verdict == 2 and .exit == 1 and .same == 70' \
        ".differences[0].offset == $("$EDIT" --offset 7 spoiled.log)" \
        '.differences[0] | .event == 7 and .time == 0.01 and .a == 3 and .b == 1' \
        '.differences[0] | .kind == "verdict" and .then.verdict == "overlapping"' \
        '.differences[0].now.verdict == "touching" and .differences[0].log == "spoiled.log"'
}

# bats test_tags=release
@test "an altered number is a difference beyond --tolerance" {
    edit --nudge 0 1e-9 moving.log
    replay spoiled.log
    ended 1
    counts '.different_in.box == 1 and .different == 1' \
        '.differences[0] | (.then.box.max[0] != .now.box.max[0]) and (.then.contact == .now.contact)'
    run "$FMB" replay spoiled.log
    ended 1
    [[ ${lines[0]} =~ \ \ box\ max\ x:\ [-0-9.e]+,\ now\ [-0-9.e]+\ \(-1e-09\)$ ]]
    replay --tolerance 1e-15 spoiled.log
    ended 1
    replay --tolerance 1e-6 spoiled.log
    ended 0
    counts '.same == 40'
    edit --flip 0 moving.log
    replay --tolerance 1 spoiled.log
    ended 1
}

@test "a box with an infinite end is compared" {
    edit --nudge 0 inf moving.log
    for tolerance in 0 1; do
        replay --tolerance $tolerance spoiled.log
        ended 1
        counts '.different_in.box == 1 and .differences[0].then.box.max[0] == null'
    done
    run "$FMB" replay spoiled.log
    ended 1
    [[ ${lines[0]} =~ \ box\ max\ x:\ inf,\ now\ [-0-9.e]+$ ]]
}

# bats test_tags=release
@test "an altered gap of a pair and of a scene is a difference" {
    for n in $(seq 0 19); do
        edit --nudge "$n" 1e-9 apart.log
        replay spoiled.log
        ended 1
        [ "$(jq .different_in.gap <<< "$output")" = 0 ] || break
    done
    counts '.different == 1 and .different_in.gap == 1' \
        '.differences[0] | .kind == "gap" and .then.gap[0] == .now.gap[0] and .then.gap[1] > .now.gap[1]' \
        '.differences[0] | .then.direction == .now.direction and .then.witness == .now.witness'
    run "$FMB" replay spoiled.log
    ended 1
    [[ ${lines[0]} =~ \ gap\ upper\ bound:\ [-0-9.e]+,\ now\ [-0-9.e]+\ \(-1e-09\)$ ]]
    replay --tolerance 1e-6 spoiled.log
    ended 0
    edit --nudge 0 1e-9 stack.log
    replay spoiled.log
    ended 1
    counts '.different == 1 and .different_in.gap == 1 and .differences[0].channel == "FMB_SCENE_QUERY"'
}

@test "an altered certificate is a difference" {
    edit --certify 2 '5 more <&"'"'> of it" blast.log
    replay spoiled.log
    ended 1
    counts '.different_in.certificate == 1 and .differences[0].then.certificate == "5 more <&\"'"'"'> of it"'
    replay --tolerance 1e-12 spoiled.log
    ended 0
}

@test "an altered status is a difference" {
    edit --refuse 2 9 --refuse 3 12345 moving.log
    replay spoiled.log
    ended 1
    counts '.different_in.status == 2 and .differences[1].then.error == "unknown status"' \
        '.differences[0] | .then == {"error": "the duration is negative, not finite, or 0 although a body moves"} and .now.verdict'
    run "$FMB" replay spoiled.log
    [[ $output == *' status: unknown status, now '* ]]
}

# bats test_tags=release
@test "differences are listed in the order of their queries, however late their results" {
    local flips=()
    for n in 3 9 12 18 21 30 36 60; do flips+=(--flip $n); done
    "$EDIT" "${flips[@]}" arm.log flipped.log
    "$EDIT" --delay 40 flipped.log delayed.log
    "$EDIT" --last flipped.log last.log
    "$EDIT" --first flipped.log first.log
    for log in flipped delayed last first; do
        replay $log.log
        ended 1
        counts '.different == 8 and ([.differences[].offset] | . == sort) and (.differences | length) == 8'
    done
    # Which are listed does not depend on it either.
    for log in flipped delayed last; do
        replay --limit 3 $log.log
        ended 1
        counts '.not_listed == 5 and [.differences[].sequence_number] == [3,9,12]'
        replay --limit 0 $log.log
        counts '.not_listed == 8 and .differences == [] and .different == 8'
    done
    run "$FMB" replay --limit 6 delayed.log
    ended 1
    [[ $output == *'and 2 more differences (--limit)'* ]]
    [ "$(grep -c '^event' <<< "$output")" = 6 ]
}

# ---- What stands where -------------------------------------------------------------------------

# bats test_tags=release
@test "repeated, missing and unmatched results are counted" {
    edit --repeat 4 --repeat 50 arm.log
    replay spoiled.log
    ended 0
    counts '.queries == 72 and .same == 72 and .results == 74 and .unmatched_results == 0' \
        '.second_results == 2 and .contradictions == 0'
    edit --drop 4 --drop 30 moving.log
    replay spoiled.log
    ended 0
    counts '.same == 38 and .no_result == 2 and .results == 38'
    edit --drop-query 7 --drop-query 40 arm.log
    replay spoiled.log
    ended 0
    counts '.queries == 70 and .unmatched_results == 2 and .results == 72'
}

@test "a second result that contradicts the first is a difference" {
    edit --repeat 4 --flip 5 arm.log
    replay spoiled.log
    ended 1
    counts '.same == 72 and .different == 0 and .contradictions == 1 and .second_results == 0'
    [[ $stderr == *'spoiled.log: event '*': contradicts an earlier result of the same query' ]]
    run "$FMB" replay spoiled.log
    [[ $output == *'; 1 result that contradicts an earlier one'* ]]
    junit spoiled.log
    [ "$(xpath '//testsuite/@errors')" = 1 ]
}

# bats test_tags=release
@test "several logs are read as one" {
    for at in 1 30 31 77 145; do
        "$EDIT" --events 0 $at clients.log a.log
        "$EDIT" --events $at 1000 clients.log b.log
        report_of clients.log | jq -c 'del(.differences)' > whole
        report_of a.log b.log | jq -c 'del(.differences)' > two
        cmp whole two
    done
    "$EDIT" --flip 3 --flip 60 arm.log flipped.log
    "$EDIT" --events 0 50 flipped.log a.log
    "$EDIT" --events 50 1000 flipped.log b.log
    run "$FMB" replay a.log b.log
    ended 1
    [[ ${lines[0]} == 'a.log: event 7  0.010000 s '* ]]
    [[ ${lines[1]} == 'b.log: event '*' 0.200000 s '* ]]
    replay a.log b.log
    counts '[.differences[].log] == ["a.log", "b.log"]'
}

@test "damage of one of several logs is reported with its name" {
    local middle=$(($("$EDIT" --offset 77 arm.log) + 11))
    head -c $middle arm.log > a.log
    tail -c +$((middle + 1)) arm.log > b.log
    replay a.log b.log
    ended 2
    counts ".damages == 2 and .bytes == $(stat -Lc %s arm.log) and .events == 145"
    [ "$stderr" = "fmb: a.log: offset $((middle - 11)): 11 bytes: the last event is cut off
fmb: b.log: offset 0: $(($("$EDIT" --offset 78 arm.log) - middle)) bytes: no event" ]
    junit a.log b.log arm.log
    [ "$(xpath 'count(//testsuite[1]//error)')$(xpath 'count(//testsuite[2]//error)')" = 11 ]
    [ "$(xpath 'count(//testsuite[3]//error)')" = 0 ]
}

# bats test_tags=release
@test "many logs are read as one" {
    for i in $(seq 0 3 145); do
        "$EDIT" --events "$i" $((i + 3)) arm.log "part.$i.log"
        parts+=("part.$i.log")
    done
    [ "$(report_of "${parts[@]}" | jq -c .same)" = 72 ]
    ulimit -S -n 30
    replay "${parts[@]}"
    ended 0
    counts '.same == 72'
}

# bats test_tags=release
@test "--prefix selects the channels of a prefix" {
    edit --prefix LAB_ arm.log
    replay spoiled.log
    ended 2
    counts '.queries == 0 and .other_events == 146'
    [[ $stderr == *'there are no queries of this service'* ]]
    replay --prefix LAB_ spoiled.log
    ended 0
    counts '.same == 72 and .other_events == 0'
    replay -p LAB_ spoiled.log arm.log
    ended 0
    counts '.same == 72 and .other_events == 146'
    # That of the logs may be another than that of a service on the bus.
    replay -p OTHER_ --log-prefix LAB_ spoiled.log
    ended 0
    counts '.same == 72'
    run "$FMB" replay --log-prefix a/b spoiled.log
    ended 2
    [[ $output == *'--log-prefix: expected at most '* ]]
}

# ---- The golden --------------------------------------------------------------------------------

@test "golden results that were written compare equal" {
    for log in arm clients refused blast; do
        run "$FMB" replay --write-golden $log.golden $log.log
        ended 0
        replay --golden $log.golden $log.log
        ended 0
        counts '.different == 0 and .no_result == 0 and .queries == .same + .unknown_body + .not_defined'
    done
    # It is a log: the results are its own.
    replay arm.golden
    ended 2
    counts '.results == 72 and .unmatched_results == 72'
    run "$FMB" replay --write-golden arm.golden arm.log
    ended 2
    [[ $output == *'arm.golden: File exists; --force overwrites it'* ]]
    run "$FMB" replay --write-golden arm.golden --force arm.log
    ended 0
}

# bats test_tags=release
@test "golden results with other verdicts are differences" {
    "$FMB" replay --write-golden arm.golden arm.log
    "$EDIT" --flip 3 --flip 60 arm.golden flipped.golden
    replay --golden flipped.golden arm.log
    ended 1
    counts '.different == 2 and [.differences[].sequence_number] == [3,60]'
    # What the log itself says is not looked at.
    edit --flip 7 arm.log
    replay --golden arm.golden spoiled.log
    ended 0
}

# bats test_tags=release
@test "golden results match in any order, and extra and missing ones are counted" {
    "$FMB" replay --write-golden arm.golden arm.log
    "$EDIT" --events 20 72 arm.golden a.log
    "$EDIT" --events 0 20 arm.golden b.log
    cat a.log b.log > turned.golden
    replay --golden turned.golden arm.log
    ended 0
    counts '.same == 72'
    replay --golden a.log arm.log
    ended 0
    counts '.same == 52 and .no_result == 20'
    edit --events 0 60 arm.log
    replay --golden arm.golden spoiled.log
    ended 0
    counts '.results == 72 and .unmatched_results > 20 and .no_result == 0'
}

@test "a recording by another client is compared in order" {
    local all=('--client 5' '--sequence 100000' '--client 5 --delay 3' '--client 5 --utime 0'
        '--client 5 --repeat 3 --repeat-query 4')
    for log in arm moving clients blast; do
        replay --golden $log.log $log.log
        own=$(jq -c '[.queries, .same, .busy, .unknown_body, .not_defined, .no_result]' <<< "$output")
        for other in "${all[@]}" '--client 5 --sequence 100000'; do
            edit $other $log.log
            replay --golden spoiled.log $log.log
            ended 0
            counts ".left_over == 0 and $own == [.queries, .same, .busy, .unknown_body, .not_defined, .no_result]"
            replay --golden $log.log spoiled.log
            ended 0
            counts ".left_over == 0"
        done
        all=() # each edit once; their sum in every log
        [ -z "${FMB_FAST-}" ] || [ $log = arm ] || break
    done
    edit --client 5 --sequence 7 --flip 3 --flip 60 arm.log
    replay --golden spoiled.log arm.log
    ended 1
    counts '.different == 2 and .same == 70 and [.differences[].sequence_number] == [3,60]'
    edit --client 5 --repeat 4 --flip 5 arm.log
    replay --golden spoiled.log arm.log
    ended 1
    counts '.same == 72 and .contradictions == 1 and .left_over == 0'
    # Results without their queries are compared in the order of their type.
    "$FMB" replay --write-golden arm.golden spoiled.log || true
    replay --golden arm.golden arm.log
    ended 0
    counts '.same == 72 and .left_over == 0'
}

@test "queries that only one of two recordings has are listed" {
    "$EDIT" --client 5 --sequence 7 --drop 71 --drop-query 71 arm.log less.log
    replay --golden less.log arm.log
    ended 1
    counts '.same == 71 and .no_result == 1 and .left_over == 1 and .different == 0'
    [[ $stderr == *'arm.log: event '*': FMB_'*'_QUERY: has no counterpart in the other recording' ]]
    replay --golden arm.log less.log
    ended 1
    counts '.same == 71 and .no_result == 0 and .left_over == 1 and .unmatched_results == 1'
    [[ $stderr == *'arm.log: event '*': FMB_'*'_QUERY: has no counterpart in the other recording' ]]
    run "$FMB" replay --golden arm.log less.log
    ended 1
    [[ $output == *'; 1 query in one recording only'* ]]
    junit --golden arm.log less.log
    [ "$(xpath '//testsuite/@errors')" = 1 ]
    # A query without a result has a counterpart all the same: the next ones do not move up.
    "$EDIT" --client 5 --drop 3 arm.log mute.log
    replay --golden mute.log arm.log
    ended 0
    counts '.same == 71 and .no_result == 1 and .left_over == 0'
}

# bats test_tags=release
@test "queries of another client are counted within type, label and first pair" {
    # Two pair queries of different bodies, in the other order.
    "$EDIT" --client 5 arm.log other.log
    for part in '0 9' '11 13' '9 11' '13 146'; do
        "$EDIT" --events $part other.log part.log
        cat part.log >> turned.log
    done
    replay --golden turned.log arm.log
    ended 0
    counts '.same == 72 and .left_over == 0'
    # The last query of its group is missing: the later ones of other pairs do not move up.
    "$EDIT" --client 5 --drop-query 64 --drop 64 arm.log less.log
    replay --golden less.log arm.log
    ended 1
    counts '.different == 0 and .same == 71 and .left_over == 1'
}

# bats test_tags=release
@test "exact matches keep priority over the order" {
    "$EDIT" --events 0 60 moving.log begin.log
    "$EDIT" --events 40 1000 moving.log end.log
    replay --golden begin.log end.log
    ended 0
    counts '.same == 10 and .no_result == 10 and .unmatched_results == 20 and .left_over == 0'
}

@test "golden results that cannot be read are named" {
    "$FMB" replay --write-golden arm.golden arm.log
    "$EDIT" --shorten 5 arm.golden short.golden
    replay --golden short.golden arm.log
    ended 2
    [ "$stderr" = "fmb: short.golden: offset $("$EDIT" --offset 5 arm.golden): shorter than its fields" ]
    counts '.no_result == 1 and .same == 71'
    "$EDIT" --garbage 30 arm.golden spoiled.golden
    replay --golden spoiled.golden arm.log
    ended 2
    [ "$stderr" = "fmb: spoiled.golden: offset $("$EDIT" --offset 30 arm.golden): no event" ]
    counts '.same == 72'
    for golden in missing.golden .; do
        replay --golden $golden arm.log
        ended 2
        [[ $stderr == "fmb: $golden: "* ]]
    done
}

@test "a golden file without results, or of text, is one failure" {
    echo 'q1,q2' > path.csv
    : > empty.golden
    "$EDIT" --events 0 1 arm.log query.golden
    for golden in path.csv empty.golden query.golden; do
        run --separate-stderr "$FMB" replay --golden $golden arm.log
        ended 2
        [ -z "$output" ] # nothing was compared: there are no counts
        [ "${stderr##*$'\n'}" = "fmb: $golden holds no results: is it an event log, with the prefix of the others?" ]
        [ "$(wc -l <<< "$stderr")" -le 2 ]
    done
}

@test "a scene of other bodies is one difference, in every form" {
    # The scenes of both logs have no label, and ids from 1 on: 10 bodies, and 16.
    "$EDIT" --client 5 stack.log other.log
    local says='the recording has 16 bodies, the query 10: 11, 12, 13 and 3 more are missing'
    replay --golden other.log arm.log
    ended 1
    counts '.same == 0 and .different_in.scene == .different' \
        '.differences[0].kind == "scene" and (.differences[0] | has("a") | not)' \
        ".differences[0].detail == \"$says\""
    junit --golden other.log --html page.html arm.log
    ended 1
    [[ $'\n'$output == *$'\n'"event 1  0.000000 s  the scene: $says"$'\n'* ]]
    [[ $output == *$'\n''different in: 24 scene'$'\n'* ]]
    [[ $(xpath '//failure[1]') == *"the scene: $says"* ]]
}

# ---- What is broken ----------------------------------------------------------------------------

@test "foreign bytes in a log are damage" {
    edit --garbage 50 --garbage 3 --garbage 0 arm.log
    replay spoiled.log
    ended 2
    counts '.damages == 3 and .damaged_bytes == 75 and .same == 72'
    [ "$(grep -c 'spoiled.log: offset .*: 25 bytes: no event' <<< "$stderr")" = 3 ]
    [[ $stderr == *"offset $(($("$EDIT" --offset 3 arm.log) + 25)): "* ]]
}

# bats test_tags=release
@test "differences determine the exit code before damage" {
    edit --garbage 50 --flip 3 arm.log
    replay spoiled.log
    ended 1
    counts '.damages == 1 and .different == 1'
}

@test "many damages are counted, and the first are listed" {
    local garbage=()
    for n in $(seq 1 60); do garbage+=(--garbage $n); done
    edit "${garbage[@]}" arm.log
    replay spoiled.log
    ended 2
    counts '.damages == 60'
    [ "$(grep -c 'no event' <<< "$stderr")" = 20 ]
    [[ $stderr == *'fmb: and 40 more of these' ]]
}

@test "files that are not logs are refused: text, one byte, zeros, noise, a folder, a pipe, a missing file" {
    echo 'this is no log' > text.log
    printf 'x' > byte.log
    head -c 100000 /dev/zero > zeros.log
    head -c 100000 "$FMB" > noise.log
    for log in text byte zeros noise; do
        replay $log.log
        ended 2
        counts '.damages == 1 and .queries == 0 and .damaged_bytes == .bytes'
        [[ $stderr == "fmb: $log.log: offset 0: "*"fmb: $log.log holds no events: is it an event log?" ]]
    done
    run "$FMB" replay text.log
    [ "${#lines[@]}" = 2 ] # and no counts
    mkdir folder.log
    mkfifo pipe.log
    for log in folder pipe missing; do
        run --separate-stderr "$FMB" replay arm.log $log.log
        ended 2
        [[ $stderr == "fmb: $log.log: "* ]]
    done
}

@test "logs without queries have nothing to compare" {
    : > empty.log
    replay empty.log
    ended 2
    counts '.events == 0 and .bytes == 0'
    replay empty.log arm.log empty.log
    ended 0
    counts '.same == 72'
    edit --rename FMB_PAIR_QUERY POSE --rename FMB_SCENE_QUERY POSE --rename FMB_PAIR_RESULT X \
        --rename FMB_SCENE_RESULT Y --rename FMB_STATUS Z arm.log
    replay spoiled.log
    ended 2
    counts '.other_events == 146'
}

@test "messages of another version are counted as unreadable" {
    edit --version 4 --version 7 arm.log # a query and a result
    replay spoiled.log
    ended 2
    counts '.unreadable_queries + .unreadable_results == 2 and .damages == 0'
    [ "$(grep -c ': another message type, or another version of it$' <<< "$stderr")" = 2 ]
    [[ $stderr == *"spoiled.log: event 4 (offset $("$EDIT" --offset 4 arm.log)): FMB_"* ]]
    for n in $(seq 0 20); do
        edit --shorten "$n" arm.log
        replay spoiled.log
    done
}

@test "reports are printed without control characters" {
    edit --certify 2 "$(printf '%%s%%n\e[31m')" blast.log || true # what the reader refuses
    replay spoiled.log
    [[ $stderr != *$'\e'* ]]
    edit --certify 2 '%s%n%1$s' blast.log
    run "$FMB" replay spoiled.log
    ended 1
    [[ $output == *'certificate: %s%n%1$s, now '* ]]
    edit --rename FMB_STATUS $'\e[2J%n' arm.log
    run "$FMB" replay spoiled.log
    ended 0
    [[ $output != *$'\e'* ]]
}

# ---- JUnit -------------------------------------------------------------------------------------

# Scenes are queries 0, 3, 6 and so on.
@test "a scene that differs is named by its label, which is a JUnit case" {
    edit --label 3 'home <&"> ]]>' --label 6 shelf --label 9 shelf --label 12 $'a\nb' \
        --flip 3 --flip 9 --flip 15 --drop 6 arm.log
    run "$FMB" replay spoiled.log
    ended 1
    [[ ${lines[0]} == 'event '[0-9]*' (home <&"> ]]>)  '[0-9.]*' s  bodies '*'  verdict: '* ]]
    [[ ${lines[1]} == 'event '[0-9]*' (shelf)  '[0-9.]*' s  bodies '* ]]
    [[ ${lines[2]} == 'event '[0-9]*'  '[0-9.]*' s  bodies '* && ${lines[2]} != *\(* ]]
    replay spoiled.log
    counts '[.differences[].label] == ["home <&\"> ]]>", "shelf", null]'
    junit spoiled.log stack.log
    ended 1
    [ "$(xpath '//testsuite[1]/@tests')/$(xpath '//testsuite[1]/@failures')" = 6/3 ]
    [ "$(xpath 'count(//testsuite[1]/testcase)')/$(xpath 'count(//testsuite[1]//failure)')" = 6/3 ]
    [[ $(xpath '//testcase[starts-with(@name, "home")]/failure') == $'event '*' (home <&"> ]]>)  '*' s  bodies '* ]]
    [ "$(xpath '//testcase[@name="shelf"]/failure/@message')" = '1 of 2 queries are answered differently: 1 difference' ]
    [[ $(xpath '//testcase[@name="shelf"]/system-out') == 'queries: 2, same: 0, different: 1, '*'no result: 1' ]]
    [ "$(xpath '//testcase[@name="shelf"]/failure' | grep -c '^event')" = 1 ]
    [ "$(xpath 'count(//testcase[starts-with(@name, "a")]/*)')" = 1 ]
    [[ $(xpath '//testsuite[1]/testcase[@name="FMB_SCENE_QUERY"]/system-out') == 'queries: 20, same: 19, different: 1, '* ]]
    [[ $(xpath '//testsuite[1]/testcase[@name="FMB_PAIR_QUERY"]/system-out') == 'queries: 48, same: 48, '* ]]
    # The scenes of the other log have no label.
    [ "$(xpath '//testsuite[2]/@tests')" = 3 ]
}

@test "JUnit: damage is an error" {
    edit --garbage 5 arm.log
    junit spoiled.log
    ended 2
    [ "$(xpath '//testsuite/@errors')" = 1 ]
    [[ $(xpath '//error/@message') == '1 damaged place, 0 messages that cannot be read, '* ]]
}

@test "JUnit: any text is kept within XML" {
    "$EDIT" --certify 2 ']]> <a b="c"> &amp; &#0;' blast.log $'a\xff\xc3(\xed\xa0\x80\xef\xbf\xbf\x01\t\n"\'<&>é€𝄞.log'
    junit $'a\xff\xc3(\xed\xa0\x80\xef\xbf\xbf\x01\t\n"\'<&>é€𝄞.log'
    ended 1
    [[ $(xpath '//failure') == *']]> <a b="c"> &amp; &#0;'* ]]
    [[ $(xpath '//testcase/@classname') == *'"'"'"'<&>é€𝄞.log' ]]
}

# bats test_tags=release
@test "JUnit: omitted differences are counted" {
    local flips=()
    for n in $(seq 0 300); do flips+=(--flip "$n"); done
    edit "${flips[@]}" blast.log
    junit spoiled.log
    ended 1
    [[ $(xpath '//failure/@message') == '301 of 400 queries'*': 301 differences' ]]
    [ "$(xpath '//failure' | grep -c ^event)" = 100 ]
}

@test "JUnit: a report that cannot be written is a failure" {
    run "$FMB" replay --junit /nowhere/report.xml arm.log
    ended 2
    [[ $output == *'fmb: /nowhere/report.xml: No such file or directory'* ]]
    run "$FMB" replay --junit /dev/full arm.log
    ended 2
    [[ $output == *'fmb: /dev/full: No space left on device'* ]]
}

# ---- The command -------------------------------------------------------------------------------

@test "output that cannot be written is a failure" {
    run bash -c '"$0" replay arm.log > /dev/full' "$FMB"
    ended 2
    [[ $output == *'fmb: standard output: No space left on device'* ]]
}

# Bodies of 1 to 8 frames: a pair of the largest fits into 16, wherever the cache holds other bodies.
@test "a query whose bodies fit into the cache is answered, and others are left out with exit code 2" {
    generate --blast pairs 400 --by-handle --compound --bodies 64 compound.log
    for frames in 16 17 20 29 64 100; do
        replay --frames $frames compound.log
        ended 0
        said ''
        counts '.same == 400'
    done
    # So many pairs have 16 frames together, and are not sent whole.
    replay --frames 15 --write-golden fitting.golden compound.log
    ended 2
    counts '.not_held > 0 and .not_defined == 0 and .same + .not_held == 400'
    left=$(jq .not_held <<< "$output")
    said "fmb: queries left out because their bodies do not fit into the cache (--frames): $left"
    # A golden log lacks what was not answered.
    replay --golden fitting.golden compound.log
    counts ".no_result == $left and .same == 400 - $left"
    junit --frames 15 compound.log
    ended 2
    [[ $(xpath '//error/@message') == *", $left queries left out, "* ]]
}

@test "a query whose handles the log does not define is left out with exit code 2" {
    generate --blast pairs 60 --by-handle --bodies 8 handles.log
    "$EDIT" --events 40 1000 handles.log late.log
    replay late.log
    ended 2
    counts '.not_defined > 0 and .not_held == 0 and .same + .not_defined == .queries'
    said "fmb: queries left out because the logs do not define their handles: $(jq .not_defined <<< "$output")"
}
