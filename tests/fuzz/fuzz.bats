# Each fuzz target finds what planted/ has for it, from its corpus, and finds nothing in as many runs
# of what is not planted, if these are few.

setup() {
    BUILD=${FMB_BUILD:-build/asan-clang}
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# fuzz PROGRAM TARGET RUNS
fuzz() {
    local options=(-use_value_profile=1) length=1024 corpus=tests/fuzz/corpus/$2 dict=tests/fuzz/$2.dict
    [ "$2" != answer ] || length=1280 # as in fuzz.sh
    case $2 in
    answer | scene_json | replay_log) options=(-entropic=0 -use_counters=0) ;;
    robot_files) # the planted fault needs a number near the largest double: this file has forty
        options=(-entropic=0 -use_counters=0)
        corpus=$BATS_TEST_TMPDIR/robot
        mkdir -p "$corpus"
        cp tests/fuzz/corpus/robot_files/large "$corpus"
        ;;
    mesh) # as value profiles, counters make too many inputs new; what is planted is in the reader of PLY
        options=(-use_counters=0)
        corpus=$BATS_TEST_TMPDIR/ply dict=$BATS_TEST_TMPDIR/ply.dict
        mkdir -p "$corpus"
        cp tests/fuzz/corpus/mesh/ply-* "$corpus"
        grep -v "^\"[ ]*<\|offset='0'" tests/fuzz/mesh.dict > "$dict"
        ;;
    esac
    [ ! -f "$dict" ] || options+=("-dict=$dict")
    mkdir -p "$BATS_TEST_TMPDIR/new"
    run "$BUILD/$1" "${options[@]}" -seed=1 -runs="$3" -max_len="$length" -print_final_stats=1 \
        -artifact_prefix="$BATS_TEST_TMPDIR/" "$BATS_TEST_TMPDIR/new" "$corpus"
}

# finds PLANT TEXT...: one of the texts is what says that it was found, and nothing else was.
finds() {
    local target=${1%%-*} runs text found=
    fuzz "planted/$1" "$target" 3000000
    echo "$output" | grep -vE 'NEW|REDUCE|pulse' | tail -n 30
    [ "$status" != 0 ]
    for text in "${@:2}"; do [[ $output != *"$text"* ]] || found=$text; done
    [ -n "$found" ]
    runs=$(echo "$output" | sed -n 's/^stat::number_of_executed_units: *//p')
    echo "found by run $runs"
    rm -r "$BATS_TEST_TMPDIR/new"
    fuzz "fuzz_$target" "$target" $((runs < 20000 ? runs : 20000))
    [ "$status" = 0 ]
}

@test "pair_query finds numbers that are read beyond the message" {
    finds pair_query "ERROR: AddressSanitizer: "
}

@test "pair_result finds a certificate that is not printable" {
    finds pair_result "check_decoder(&result, accepted, bytes, size, &whole) == accepted"
}

@test "scene_query finds a negative count" {
    finds scene_query "layout_fits(LAYOUT_SCENE_QUERY"
}

@test "scene_result finds an index of no placement" {
    finds scene_result "check_decoder(&result, accepted, bytes, size, &whole) == accepted"
}

@test "definition_query finds a handle that is cut off" {
    finds definition_query "check_decoder(&query, accepted, bytes, size) == accepted"
}

@test "definition finds a body that does not match its handle" {
    finds definition "check_decoder(&definition, accepted, bytes, size, &whole) == accepted"
}

@test "status finds a string without an end" {
    finds status "check_decoder(&status, accepted, bytes, size) == accepted"
}

@test "answer finds a body that is taken for another" {
    finds answer "this does not hold: "
}

@test "answer finds a pair of a scene that is left out" {
    finds answer-job "n < result->verdict_count"
}

@test "scene_json finds a number that is not finite" {
    finds scene_json "is_placement(&scene->placements[i], owner->dim)" "is_finite(scene->duration)" \
        "is_finite(scene->margin)"
}

@test "event_log finds an event that is overlooked" {
    finds event_log "this does not hold: "
}

@test "mesh finds a coordinate that is not finite" {
    finds mesh "isfinite(mesh->vertex[i][axis])"
}

@test "mesh finds bytes that are read beyond the end" {
    finds mesh-bytes "AddressSanitizer: heap-buffer-overflow"
}

@test "robot_files finds a number that is not finite" {
    # Of an element, of a joint, of its limits, or in poses.
    finds robot_files "this does not hold: "
}

@test "replay_log finds queries that are never answered" {
    finds replay_log "queries == look->events[LOG_PAIR_QUERY] + look->events[LOG_SCENE_QUERY]"
}

@test "every planted fault has a test" {
    local plant
    for plant in tests/fuzz/planted/*.c; do
        plant=${plant##*/}
        grep -q "finds ${plant%.c} " tests/fuzz/fuzz.bats
    done
}
