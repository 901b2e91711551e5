# What the daemon answers: on a bus, to the client.

load service

# same_answers OPTIONS FILE: the bus gives the bytes of --local and its exit code; both are in files.
same_answers() {
    local local_code=0 bus_code=0
    "$FMB" query --json --local "$@" > "$BATS_TEST_TMPDIR/local" || local_code=$?
    "$FMB" query --json "$@" > "$BATS_TEST_TMPDIR/bus" || bus_code=$?
    [ $local_code = $bus_code ]
    cmp "$BATS_TEST_TMPDIR/bus" "$BATS_TEST_TMPDIR/local"
}

@test "the bus gives the answers of --local" {
    start_fmbd
    for dim in 2 3; do random_scene $dim 40; done > "$BATS_TEST_TMPDIR/scenes.json"
    same_answers --box --point "$BATS_TEST_TMPDIR/scenes.json"
    holds -s "$BATS_TEST_TMPDIR/bus" 'map(.pairs | length) == [780, 780]' \
        'all(.[]; [.pairs[] | select(.box and .point)] | length > 10)' \
        'all(.[].pairs[]; has("box") == has("point"))'
    # Overlapping in [0.5,1] x [0,1] x [0,1]: a point of the pair, then of a scene of more bodies.
    overlap='{"id": 1, "shape": "box", "size": [1,1,1], "position": [0.5,0.5,0.5]},
        {"id": 2, "shape": "box", "size": [1,1,1], "position": [1,0.5,0.5]}'
    for more in '' ', {"id": 3, "shape": "box", "size": [1,1,1], "position": [9,0,0]}'; do
        "$FMB" query --json --point <<< "{\"dim\": 3, \"bodies\": [$overlap$more]}" > "$BATS_TEST_TMPDIR/bus"
        holds -s "$BATS_TEST_TMPDIR/bus" '.[0].pairs[0].point == {time: 0, position: [0.75, 0.5, 0.5]}'
    done
    stop_fmbd
}

# bats test_tags=release
@test "the cases give the answers of --local, by every method" {
    start_fmbd
    jq -c .scene tests/cases/*.json > "$BATS_TEST_TMPDIR/scenes.json"
    for method in certified exact; do same_answers --box --point --method $method "$BATS_TEST_TMPDIR/scenes.json"; done
    for method in fmb sat; do
        local_code=0 bus_code=0
        "$FMB" query --box --point --json --local --method $method "$BATS_TEST_TMPDIR/scenes.json" > "$BATS_TEST_TMPDIR/local" || local_code=$?
        "$FMB" query --box --point --json --method $method "$BATS_TEST_TMPDIR/scenes.json" > "$BATS_TEST_TMPDIR/bus" || bus_code=$?
        [ $local_code = $bus_code ]
        # Why a pair cannot be decided may be said in other words.
        [ "$(jq -s 'map((.pairs[]? | select(.error)).error = "error") | length > 10 and .[:length / 2] == .[length / 2:]' \
            "$BATS_TEST_TMPDIR/local" "$BATS_TEST_TMPDIR/bus")" = true ]
    done
    stop_fmbd
}

# Neighbours share the vertices that they were given, though no difference of these is a double; and
# a face whose edge is that of two tetrahedra touches both.
shared='{"label": "mesh \u20ac", "dim": 3, "bodies": [
    {"id": 1, "name": "left", "shape": "tetrahedron", "vertices": [[0.1,0.2,0.3],[1e9,0.7,0.1],[0.3,1e9,0.1],[0.1,0.1,1e9]]},
    {"id": 2, "shape": "tetrahedron", "vertices": [[-1e9,0.2,0.3],[1e9,0.7,0.1],[0.3,1e9,0.1],[0.1,0.2,0.3]], "group": 7},
    {"id": 3, "frames": [{"shape": "box", "size": [1,1,1], "position": [-5e9,0,0]},
                         {"shape": "face", "vertices": [[0.1,0.2,0.3],[1e9,0.7,0.1],[0.3,-1e9,-7]]}]},
    {"id": 4, "group": 7, "shape": "box", "size": [1,1,1], "position": [1e10,0,0]},
    {"id": 5, "group": -1, "shape": "face", "position": [-3,0,0], "vertices": [[0,0,0],[1,0,0],[0,1,0]]},
    {"id": 6, "group": 7, "shape": "box", "size": [3,3,3], "position": [1e10,1,0]}]}'

# grid_scene DIM MOVING: unit cuboids and the corners cut off such ones, on halves, so that all
# verdicts occur.
grid_scene() {
    awk -v dim="$1" -v moving="$2" '
        function vector(x, y, z) {
            return "[" x "," y (dim == 3 ? "," z : "") "]"
        }
        BEGIN {
            edges = "[" vector(1, 0, 0) "," vector(0, 1, 0) (dim == 3 ? "," vector(0, 0, 1) : "") "]"
            printf "{\"dim\":%d,\"bodies\":[", dim
            for (b = 0; b < 12; b++) {
                printf "%s{\"id\":%d,\"shape\":\"%s\",\"components\":%s,\"origin\":%s", (b ? "," : ""),
                    b + 1, (b % 3 ? "cuboid" : "tetrahedron"), edges, vector(b % 5 / 2, b % 4, b % 7 / 4)
                if (moving && b % 2) printf ",\"velocity\":%s", vector(b % 3 - 1, 0.25, 0)
                printf "}"
            }
            print "]}"
        }'
}

# Of each dimension, at rest and moving, a line each.
grid_scenes() {
    for scene in '2 0' '3 0' '2 1' '3 1'; do
        # shellcheck disable=SC2086
        grid_scene $scene
    done
}

@test "the bus gives the certificates of --local, for all verdicts, at rest and moving" {
    start_fmbd
    grid_scenes > "$BATS_TEST_TMPDIR/scenes.json"
    same_answers --certificate "$BATS_TEST_TMPDIR/scenes.json"
    holds -s "$BATS_TEST_TMPDIR/bus" 'length == 4' \
        'all(.[]; [.pairs[].verdict] | unique == ["overlapping","separated","touching"])' \
        'all(.[].pairs[]; .verdict as $verdict | .certificate | startswith($verdict))'
    for dim in 2 3; do random_scene $dim 30; done > "$BATS_TEST_TMPDIR/scenes.json"
    same_answers --certificate --box "$BATS_TEST_TMPDIR/scenes.json"
    stop_fmbd
}

@test "a false answer is detected where a certificate is requested" {
    cube='"shape": "cuboid", "components": [[1,0],[0,1]]'
    echo "{\"dim\": 2, \"bodies\": [{\"id\": 1, $cube, \"origin\": [0,0]}, {\"id\": 2, $cube, \"origin\": [2,0]}]}" > "$BATS_TEST_TMPDIR/scene.json"
    for certificate in 'overlapping at 0 a 0 3 b 0:1/2 3:1/2' 'separated normal (-1 0)' 'nonsense'; do
        "$TOOLS/fake-peer" lie "$certificate" 3>&- &
        started="${started-} $!"
        run "$FMB" query --json --timeout 0.2 --retries 50 "$BATS_TEST_TMPDIR/scene.json"
        [ "$status" = 0 ]
        [ "$output" = '{"pairs": [{"a": 1, "b": 2, "verdict": "overlapping", "contact": [0, 1]}]}' ]
        run "$FMB" query --json --timeout 0.2 --retries 50 --certificate "$BATS_TEST_TMPDIR/scene.json"
        [ "$status" = 1 ]
        [[ $(jq -r '.pairs[0].error' <<< "$output") == "the service's certificate does not hold: "?* ]]
        [ "$(jq -c '.pairs[0] | keys' <<< "$output")" = '["a","b","error"]' ]
        kill $!
        wait $! || true
    done
}

@test "a missing certificate is an error" {
    random_scene 2 2 > "$BATS_TEST_TMPDIR/scene.json"
    "$TOOLS/fake-peer" lie '' 3>&- &
    started="${started-} $!"
    run "$FMB" query --timeout 0.2 --retries 50 --certificate "$BATS_TEST_TMPDIR/scene.json"
    [ "$status" = 1 ]
    [[ ${lines[2]} == *"  1  2  not decided: no certificate: there is none for bodies that turn and touch, or for numbers that span more than 512 bits" ]]
}

# A scene may be answered in parts, and a part twice where the query was repeated.
parts='def parts: unique_by(.end_pair) | map(.pairs) | add; '

@test "watch shows the scenes that pass, in JSON" {
    start_fmbd
    start_watch --json
    grid_scene 3 1 | sed 's/{/{"margin":0.75,/' > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --json "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus"
    wait_until_watched 'last.end_pair == 66'
    jq -es --slurpfile bus "$BATS_TEST_TMPDIR/bus" "$parts"'
        ($bus[0].pairs | length) == 66 and (parts | any(.verdict == "separated")) and
        parts == [$bus[0].pairs[] | select(.verdict != "separated" or .gap)]' "$watched"
    # It ends after --count results.
    start_watch --json --count 1
    "$FMB" query --json "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus"
    wait "$watch"
    [ "$(wc -l < "$watched")" = 1 ]
    stop_fmbd
}

# bats test_tags=release
@test "watch shows the pairs of scenes with times, boxes, points and gaps, in JSON" {
    grid_scene 3 1 | sed 's/{/{"margin":0.75,"duration":2,/' | jq -c '.bodies[0].velocity = [0.1, 0, 0.25]' > "$BATS_TEST_TMPDIR/all"
    jq -c '.pairs = [[2, 1], [1, 2], [1, 6], [3, 7]] | del(.margin)' "$BATS_TEST_TMPDIR/all" > "$BATS_TEST_TMPDIR/listed"
    start_fmbd
    for scene in all listed; do
        start_watch --json
        "$FMB" query --box --point --json "$BATS_TEST_TMPDIR/$scene" > "$BATS_TEST_TMPDIR/bus"
        wait_until_watched "last.end_pair == $(jq '.pairs | length' "$BATS_TEST_TMPDIR/bus")"
        jq -es --slurpfile bus "$BATS_TEST_TMPDIR/bus" --arg scene $scene "$parts"'
            [$bus[0].pairs[] | select(.verdict != "separated" or .gap or $scene == "listed")] as $wanted
            | parts == $wanted and ($wanted | length) > 3 and any($wanted[]; .contact and .box and .point)' "$watched"
        kill -INT "$watch"
        wait "$watch"
    done
    stop_fmbd
}

@test "watch shows the status of errors, in JSON" {
    start_fmbd
    start_watch --json
    # This method does not decide flat frames.
    run "$FMB" query --method sat --certificate --json <<< '{"dim": 2, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[2,0]]},
        {"id": 2, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[0,1]]}]}'
    ended 1
    wait_until_watched --arg error "$(jq -r '.pairs[0].error' <<< "$output")" 'any(.[]; .pairs[0].error == $error and .status > 0)'
    # The log has scenes that are refused.
    "$FMB" replay --bus tests/logs/refused.log
    wait_until_watched 'any(.[]; (has("pairs") | not) and .status > 0 and (.error | length > 0))'
    stop_fmbd
}

@test "watch shows the certificates and gaps that pass, in JSON" {
    start_fmbd
    start_watch --json
    random_scene 2 2 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --certificate --gap --json "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus"
    wait_until_watched --slurpfile bus "$BATS_TEST_TMPDIR/bus" '
        any(.[].pairs[0]; .certificate and .gap and .direction and
            [.certificate, .gap, .direction] == ($bus[0].pairs[0] | [.certificate, .gap, .direction]))'
    stop_fmbd
}

@test "damaged messages on every channel are counted, and harm neither service nor clients" {
    start_fmbd
    start_watch
    random_scene 2 3 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query "$BATS_TEST_TMPDIR/scene.json" > /dev/null
    wait_until has "$watched" 'up to pair 3: '
    sent=0 to_watch=0 results=0 begin=$SECONDS
    for type in pair_query pair_result scene_query scene_result definition_query definition status; do
        to_watch=$((to_watch + $("$TOOLS/fake-peer" FMB_PAIR_QUERY $type)))
        to_watch=$((to_watch + $("$TOOLS/fake-peer" FMB_SCENE_QUERY $type)))
        sent=$((sent + $("$TOOLS/fake-peer" FMB_DEFINITION_QUERY $type)))
        results=$((results + $("$TOOLS/fake-peer" FMB_PAIR_RESULT $type)))
        results=$((results + $("$TOOLS/fake-peer" FMB_SCENE_RESULT $type)))
        "$TOOLS/fake-peer" FMB_STATUS $type
    done
    sent=$((sent + to_watch)) to_watch=$((to_watch + results))
    [ "$sent" -gt 4000 ]
    [ "$(status_of malformed)" = "$sent" ]
    # At most one a second is reported.
    [ "$(grep -c malformed "$fmbd_log")" -le $((SECONDS - begin + 2)) ]
    lines=$(wc -l < "$watched")
    "$FMB" query "$BATS_TEST_TMPDIR/scene.json"
    still_heard() { tail -n +$((lines + 1)) "$watched" |
        grep -q 'up to pair 3: [0-9]* overlapping, [0-9]* touching'; }
    wait_until still_heard
    kill -INT "$watch"
    wait "$watch"
    grep -qx "fmb: $to_watch messages could not be read" "$watched.said"
    stop_fmbd
}

@test "a query in fragments is counted, reported once a second, and not answered" {
    start_fmbd
    begin=$SECONDS
    for _ in 1 2 3 4 5; do bytes=$("$TOOLS/plain" fragments); done
    "$TOOLS/crash-liblcm" wrap FMB_PAIR_QUERY
    "$TOOLS/crash-liblcm" wrap FMB_PAIR_RESULT
    "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
    jq -e '.fragmented == 6 and .received == 0 and .malformed == 0' "$BATS_TEST_TMPDIR/status"
    "$TOOLS/plain" fragments
    [ "$(status_of fragmented)" = 7 ]
    grep -q "^fmbd: a query on FMB_SCENE_QUERY came in fragments ($bytes bytes) .* 63900 bytes, divide the scene; 7 " "$fmbd_log"
    [ "$(grep -c 'came in fragments' "$fmbd_log")" -le $((SECONDS - begin + 2)) ]
    random_scene 2 3 | "$FMB" query > /dev/null
    stop_fmbd
}

# bats test_tags=release
@test "prefixes keep two services apart" {
    start_fmbd --prefix ONE_
    one=$fmbd
    start_fmbd --prefix TWO_
    random_scene 2 4 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --prefix TWO_ "$BATS_TEST_TMPDIR/scene.json"
    [ "$("$FMB" status --prefix ONE_ --json | jq .received)" = 0 ]
    [ "$("$FMB" status --prefix TWO_ --json | jq .pairs)" -ge 6 ]
    run "$FMB" query --timeout 0.1 --retries 0 "$BATS_TEST_TMPDIR/scene.json"
    [ "$status" = 1 ]
    stop_fmbd
    fmbd=$one
    stop_fmbd
}

# send_crash_packets: packets that crash liblcm's receiver (1.3.1), on every channel of the service.
send_crash_packets() {
    for channel in FMB_PAIR_QUERY FMB_SCENE_QUERY FMB_DEFINITION_QUERY FMB_STATUS FMB_PAIR_RESULT \
        FMB_SCENE_RESULT; do
        "$TOOLS/crash-liblcm" wrap $channel
        "$TOOLS/crash-liblcm" short $channel
        "$TOOLS/crash-liblcm" empty $channel
        "$TOOLS/crash-liblcm" huge $channel
    done
}

@test "packets that crash liblcm harm neither service nor clients" {
    start_fmbd
    start_watch
    random_scene 3 60 > "$BATS_TEST_TMPDIR/scene.json"
    "$FMB" query --json --local "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/local"
    for _ in 1 2 3 4 5; do
        send_crash_packets
        "$FMB" query --json "$BATS_TEST_TMPDIR/scene.json" | cmp - "$BATS_TEST_TMPDIR/local"
    done
    [ "$(status_of foreign)" -ge 100 ]
    kill -0 $watch
    stop_fmbd
}

@test "the pairs of the campaigns get the answers of libfmb, and their recording replays the same" {
    log=$BATS_TEST_TMPDIR/families.log
    report=$BATS_TEST_TMPDIR/report
    messages=$BATS_TEST_TMPDIR/messages
    start_fmbd
    start_record "$log"
    "$TOOLS/soak-families" > "$BATS_TEST_TMPDIR/families"
    if [ -n "${FMB_FAST-}" ]; then least=700; else least=5000; fi
    jq -e ".pairs > $least" "$BATS_TEST_TMPDIR/families"
    finish_record
    # More where queries were repeated.
    "$FMB" replay --json "$log" | jq -e --slurpfile sent "$BATS_TEST_TMPDIR/families" '.same >= $sent[0].pairs and .different == 0'
}
