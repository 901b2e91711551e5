# The logs of the regression set. The generator reproduces the hard logs byte for byte, with any compiler and
# instruction set. All logs are valid event logs of LCM, and contain the cases that the set has to cover.

load ../ran
load ../logs/set

setup() {
    GENERATE=$TOOLS/logs/generate
    DESCRIBE=$TOOLS/logs/describe-log
    cd "$BATS_TEST_DIRNAME/../.." || return
}

# All events of the whole set, as lines of JSON.
describe_all() {
    for log in tests/logs/*.log; do "$DESCRIBE" "$log"; done
}

# capped_at SET KNOWN...: the sets that the program capped at SET knows, the best one last.
capped_at() {
    need_set "$1"
    "$FMB_BUILD/capped/generate-$1" --instructions > "$BATS_TEST_TMPDIR/sets"
    shift
    [ "$(tr '\n' ' ' < "$BATS_TEST_TMPDIR/sets")" = "$* " ]
}

@test "the generator reproduces the hard logs of the set" {
    makes_the_hard_logs "$GENERATE"
}

@test "the generator reproduces the hard logs with plain C only" {
    capped_at plain plain
    makes_the_hard_logs "$FMB_BUILD/capped/generate-plain"
}

@test "the generator reproduces the hard logs with two lanes" {
    capped_at two plain two
    makes_the_hard_logs "$FMB_BUILD/capped/generate-two"
}

@test "the generator reproduces the hard logs with AVX2" {
    capped_at avx2 plain two avx2
    makes_the_hard_logs "$FMB_BUILD/capped/generate-avx2"
}

@test "LCM's own reader reads each to its end, and each event that lcm-gen should decode" {
    for log in tests/logs/*.log; do
        "$DESCRIBE" "$log" > "$BATS_TEST_TMPDIR/events"
        holds -s "$BATS_TEST_TMPDIR/events" '[.[].event] == [range(length)] and ([.[].utime] | . == sort)' \
            '[.[] | select(.channel | endswith("_RESULT"))] | length > 0 and all(has("status"))'
    done
}

@test "the set holds all verdicts, methods and statuses, of pairs and of scenes" {
    describe_all > "$BATS_TEST_TMPDIR/events"
    pairs='.[] | select(.channel == "FMB_PAIR_RESULT")'
    scenes='.[] | select(.channel == "FMB_SCENE_RESULT")'
    # All but NOT_SUPPORTED, which later versions do not give, BAD_ORIENTATION and BAD_SIZE; gaps of all
    # verdicts, and pairs that are named since they are near.
    holds -s "$BATS_TEST_TMPDIR/events" "[$pairs.verdicts[]] | unique == [0,1,2,3]" \
        "[$scenes.verdicts[]] | unique == [0,1,2,3]" \
        "[$pairs.method] | unique == [0,1,2,3,4]" \
        "[$scenes.method] | unique == [0,1,2,3,4]" \
        '[.[] | select(.status).status] | unique == [0,1,2,3,4,5,6,7,8,9,10,11,12,13,15,18,19]' \
        "[$pairs | select(.certificate > 0) | .verdicts[]] | unique == [1,2,3]" \
        "[$pairs | select(.boxes > 0) | .boxes] | unique == [4,6]" \
        "[$scenes | select(.times > 0 and .boxes > 0) | .status] | unique == [0]" \
        "[$pairs | select(.gaps == 2) | [.verdicts[0], .witnesses]] | unique == [[1,5],[1,7],[2,0],[3,0],[3,5],[3,7]]" \
        "[$scenes | select(.pairs > 0 and .gaps > 0) | .verdicts[]] | unique == [1,2,3]" \
        "[1,2,3] - [$scenes | select(.pairs == 0 and .gaps > 0) | .verdicts[]] == []"
}

@test "the set has late, early and missing results, restarts and parallel services" {
    "$DESCRIBE" tests/logs/foreign.log > "$BATS_TEST_TMPDIR/events"
    # The first of all is the result of a query from before.
    holds -s "$BATS_TEST_TMPDIR/events" 'any(.[]; .channel == "LAB_FMB_PAIR_RESULT")' \
        '[.[].channel] | unique | length > 12' '.[0].channel == "FMB_PAIR_RESULT"'

    "$DESCRIBE" tests/logs/clients.log > "$BATS_TEST_TMPDIR/events"
    # Of two services one holds a body, and the other one does not; then both. One query has three results;
    # one is refused twice and then answered.
    holds -s "$BATS_TEST_TMPDIR/events" '[.[] | .server // empty] | unique == [500, 501, 502, 503, 600]' \
        'any(.[]; .channel == "FMB_DEFINITION")' \
        '[.[] | select(.server == 503 or .server == 600)] | group_by([.client, .number])
            | [[0,1], [0,0]] - map(map(.status)) == []' \
        '[.[] | select(.channel == "FMB_PAIR_RESULT" and .server == 500)]
            | group_by([.client, .number]) | [[0,0,0], [2,2,0]] - map(map(.status)) == []'
}

@test "the log of pairs that turn has all verdicts, each with every kind of answer that it can have" {
    "$DESCRIBE" tests/logs/turns.log > "$BATS_TEST_TMPDIR/events"
    pairs='.[] | select(.channel == "FMB_PAIR_RESULT" and .status == 0)'
    # Methods in doubles cannot decide them. Pairs that touch have no certificate.
    holds -s "$BATS_TEST_TMPDIR/events" \
        "[$pairs | select(.gaps == 2) | .verdicts[0]] | unique == [1,2,3]" \
        "[[2,6],[3,4],[3,6]] - [$pairs | select(.boxes > 0) | [.verdicts[0], .boxes]] == []" \
        "[[2,4],[3,3],[3,4]] - [$pairs | select(.points > 0) | [.verdicts[0], .points]] == []" \
        "[$pairs | select(.certificate > 0) | .verdicts[0]] | unique == [1,3]" \
        '[.[] | select(.status == 13) | .method] | unique == [0]' \
        '[.[] | select(.channel == "FMB_SCENE_RESULT") | .verdicts[]] | unique == [0,1,2,3]'
}

@test "an answer that exceeds a message continues in the next one" {
    "$DESCRIBE" tests/logs/crowd.log > "$BATS_TEST_TMPDIR/events"
    # Full to the last contact, which takes 53 bytes.
    holds -s "$BATS_TEST_TMPDIR/events" 'any(.[]; .size > 63600 and .size <= 63900)' \
        '[.[] | .end // empty] | (map(select(. == 9730)) | length == 1) and (max == 9730)
            and any(. > 0 and . < 9730 and . > 4000)'
}

@test "a blast has the number of queries requested, and all have results" {
    "$GENERATE" --blast pairs 300 --box "$BATS_TEST_TMPDIR/blast.log"
    "$DESCRIBE" "$BATS_TEST_TMPDIR/blast.log" > "$BATS_TEST_TMPDIR/events"
    holds -s "$BATS_TEST_TMPDIR/events" '[.[] | select(.status == 0)] | length == 300
        and ([.[].verdicts[0]] | unique == [1, 3])
        and ([.[].boxes] | unique == [0, 4, 6])' 'length == 600'

    "$GENERATE" --blast scenes 2 "$BATS_TEST_TMPDIR/blast.log"
    "$DESCRIBE" "$BATS_TEST_TMPDIR/blast.log" > "$BATS_TEST_TMPDIR/events"
    holds -s "$BATS_TEST_TMPDIR/events" '[.[] | select(.status == 0) | .verdicts] | length == 2
        and (.[1] | length == 13728) and ([.[1][] | select(. == 3)] | length > 3000 and length < 12000)' \
        'all(.[]; .channel != "FMB_SCENE_QUERY" or .size > 63800)'
}

@test "a blast has the dimension, the motion and the form requested" {
    "$GENERATE" --blast pairs 50 --dim 2 --static --whole "$BATS_TEST_TMPDIR/blast.log"
    "$DESCRIBE" "$BATS_TEST_TMPDIR/blast.log" > "$BATS_TEST_TMPDIR/events"
    # 48 bytes, and of each placement 66 and 2 + 4 + 2 numbers.
    jq -es '[.[] | select(.channel == "FMB_PAIR_QUERY").size] | unique == [308]' "$BATS_TEST_TMPDIR/events"
    "$GENERATE" --blast pairs 50 --dim 3 --moving --whole --seed 2 "$BATS_TEST_TMPDIR/other.log"
    "$DESCRIBE" "$BATS_TEST_TMPDIR/other.log" > "$BATS_TEST_TMPDIR/events"
    jq -es '[.[] | select(.channel == "FMB_PAIR_QUERY").size] | min > 330' "$BATS_TEST_TMPDIR/events"
    # One after the other they are a log, and no client is in both.
    cat "$BATS_TEST_TMPDIR/blast.log" "$BATS_TEST_TMPDIR/other.log" > "$BATS_TEST_TMPDIR/both.log"
    "$DESCRIBE" "$BATS_TEST_TMPDIR/both.log" > "$BATS_TEST_TMPDIR/events"
    jq -es '[.[] | .client // empty] | length == 100 and (unique | length == 2)' "$BATS_TEST_TMPDIR/events"
}

@test "the generator reports what it cannot make" {
    for options in '' hard-2d 'nothing FILE' '--blast pears 1 FILE' '--blast pairs 0 FILE' \
        '--blast pairs 1x FILE' '--dim 4 hard-2d FILE' '--what hard-2d FILE' '--blast pairs 1'; do
        # shellcheck disable=SC2086
        run "$GENERATE" $options
        [ "$status" = 2 ]
        [ -n "$output" ]
    done
    [ ! -e FILE ]
    run "$GENERATE" hard-2d /nowhere/hard.log
    [ "$status" = 1 ]
    [[ "$output" == *'No such file or directory'* ]]
    run "$GENERATE" hard-2d /dev/full
    [ "$status" = 1 ]
    [[ "$output" == *'cannot be written in full'* ]]
}
