# fmb query --local, and the command around it: what is typed, what is printed, exit codes.

load ../ran

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    CASES=$BATS_TEST_DIRNAME/../cases
    cd "$BATS_TEST_DIRNAME/../.." || return
    cube='"shape": "cuboid", "components": [[1,0,0],[0,1,0],[0,0,1]]'
    square='"shape": "cuboid", "components": [[1,0],[0,1]]'
    two="{\"dim\": 3, \"bodies\": [{\"id\": 1, $cube, \"origin\": [0,0,0]},
          {\"id\": 2, $cube, \"origin\": [1,0,0]}]"
    scene="$two}"
}

# query TEXT [OPTIONS]: answers of the text, as JSON. Standard error is kept apart.
query() {
    local text=$1
    shift
    run --separate-stderr "$FMB" query --local --json "$@" <<< "$text"
}

# ---- Answers ---------------------------------------------------------------------------------

@test "the example has the answer of the documentation" {
    query '{"dim": 3, "duration": 1.0,
 "bodies": [{"id": 1, "shape": "cuboid", "origin": [0,0,0], "components": [[1,0,0],[0,1,0],[0,0,1]], "velocity": [0,0,0]},
            {"id": 2, "shape": "tetrahedron", "origin": [0.5,0,0], "components": [[1,0,0],[0,1,0],[0,0,1]]}],
 "pairs": [[1,2]]}' --box
    ended 0
    said ''
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "overlapping", "contact": [0, 1], "box": {"min": [0.5,0,0], "max": [1,1,1]}}]}'
}

@test "every case of tests/cases has its answer" {
    for file in "$CASES"/*.json; do
        query "$(jq -c .scene "$file")" --box
        ended 0
        jq -e --argjson found "$output" '.answer == $found' "$file" || {
            echo "$file: found $output"
            return 1
        }
    done
}

# Bodies that touch in the plane y = 0 overlap by -0.
@test "the sign of zero is written" {
    query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $square, \"origin\": [-0,-0]}, {\"id\": 2, $square, \"origin\": [-0,-1]}]}" --gap
    ended 0
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1], "gap": [-0, -0], "direction": [0,-1]}]}'
}

# bats test_tags=release
@test "without --box there is no box" {
    query "$scene"
    ended 0
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1]}]}'
}

@test "a byte order mark is skipped at the start of the input, and nowhere else" {
    mark=$'\xef\xbb\xbf'
    query "$mark$scene $scene"
    ended 0
    [ "${#lines[@]}" = 2 ]
    run --separate-stderr bash -c '{ printf "\357"; sleep 0.1; printf "\273"; sleep 0.1; printf "\277%s" "$1"; } |
        "$2" query --local --json' - "$scene" "$FMB"
    ended 0
    query "$scene $mark$scene"
    ended 2
    [[ $stderr == *'found byte 0xef'* ]]
    query "$mark$mark$scene"
    ended 2
    query "${mark:0:2}"
    ended 2
}

# bats test_tags=release
@test "separated pairs have neither contact nor box" {
    query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $square, \"origin\": [0,0]},
           {\"id\": 2, $square, \"origin\": [3,0], \"velocity\": [-1,0]}]}" --box
    ended 0
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "separated"}]}'
}

# bats test_tags=release
@test "pairs are answered as listed: both orientations, repeats" {
    query "$two, \"pairs\": [[2,1],[1,2],[2,1]]}"
    ended 0
    is '{"pairs": [{"a": 2, "b": 1, "verdict": "touching", "contact": [0, 1]}, {"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1]}, {"a": 2, "b": 1, "verdict": "touching", "contact": [0, 1]}]}'
}

# bats test_tags=release
@test "an empty list of pairs has no answers" {
    query "$two, \"pairs\": []}"
    ended 0
    is '{"pairs": []}'
}

# bats test_tags=release
@test "without a list all pairs are answered, in body order" {
    query "{\"dim\": 3, \"bodies\": [{\"id\": 9, $cube, \"origin\": [0,0,0]},
           {\"id\": 5, $cube, \"origin\": [1,0,0]}, {\"id\": 7, $cube, \"origin\": [5,0,0]}]}"
    ended 0
    is '{"pairs": [{"a": 9, "b": 5, "verdict": "touching", "contact": [0, 1]}, {"a": 9, "b": 7, "verdict": "separated"}, {"a": 5, "b": 7, "verdict": "separated"}]}'
}

# bats test_tags=release
@test "each scene of an input has one line of answers" {
    query "$scene $scene
$two, \"pairs\": []}"
    ended 0
    [ "${#lines[@]}" = 3 ]
    [ "${lines[2]}" = '{"pairs": []}' ]
}

# bats test_tags=release
@test "a scene is answered before the next one arrives" {
    mkfifo "$BATS_TEST_TMPDIR/in"
    "$FMB" query --local --json < "$BATS_TEST_TMPDIR/in" > "$BATS_TEST_TMPDIR/out" 3>&- &
    exec 9> "$BATS_TEST_TMPDIR/in"
    echo "$scene" >&9
    wait_until has_lines "$BATS_TEST_TMPDIR/out" 1
    [ "$(wc -l < "$BATS_TEST_TMPDIR/out")" = 1 ]
    exec 9>&-
    wait $!
}

@test "numbers read back bit for bit" {
    query "{\"dim\": 2, \"bodies\": [
        {\"id\": 1, $square, \"origin\": [0.1,5e-324]},
        {\"id\": 9007199254740991, $square, \"origin\": [0.30000000000000004,-0.7000000000000001]}]}" --box
    ended 0
    is '{"pairs": [{"a": 1, "b": 9007199254740991, "verdict": "overlapping", "contact": [0, 1], "box": {"min": [0.30000000000000004,4.94065645841247e-324], "max": [1.1,0.29999999999999993]}}]}'
}

# bats test_tags=release
@test "a file, a dash and standard input give the same answers" {
    echo "$scene" > "$BATS_TEST_TMPDIR/scene.json"
    expected='{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1]}]}'
    run "$FMB" query --local --json "$BATS_TEST_TMPDIR/scene.json"
    is "$expected"
    query "$scene" -
    is "$expected"
    query "$scene"
    is "$expected"
}

@test "--format text is a table" {
    run "$FMB" query --local --box <<< "{\"dim\": 2, \"duration\": 3, \"bodies\": [
        {\"id\": 1, $square, \"origin\": [0,0]},
        {\"id\": 20, $square, \"origin\": [2,0], \"velocity\": [-3,0]},
        {\"id\": 3, $square, \"origin\": [0,1]}]}"
    ended 0
    is "scene 1: 3 bodies in 2D, 3 pairs, 0 to 3 s
   a   b  verdict      contact               box
   1  20  overlapping  0.333333 to 1 s       x        0 .. 1         y        0 .. 1
   1   3  touching     0 to 3 s              x        0 .. 1         y        1 .. 1
  20   3  touching     0.333333 to 1 s       x        0 .. 1         y        1 .. 1
1 overlapping, 2 touching, 0 separated"
}

# bats test_tags=release
@test "a table in large coordinates shows distinct ends of a box, in columns" {
    run "$FMB" query --local --box <<< "{\"dim\": 2, \"bodies\": [
        {\"id\": 1, $square, \"origin\": [500000,5400000]},
        {\"id\": 2, \"shape\": \"cuboid\", \"origin\": [500000.125,5400000.25], \"components\": [[1,0],[0,0.0625]]},
        {\"id\": 3, $square, \"origin\": [500000,5400000.5], \"velocity\": [0,0.000000001]}]}"
    ended 0
    is "scene 1: 3 bodies in 2D, 3 pairs, 0 to 1 s
  a  b  verdict      contact               box
  1  2  overlapping  0 to 1 s              x 500000.125 .. 500001    y 5400000.25 .. 5400000.3125
  1  3  overlapping  0 to 1 s              x     500000 .. 500001    y  5400000.5 .. 5400001
  2  3  separated
2 overlapping, 0 touching, 1 separated"
}

# ---- Poses -----------------------------------------------------------------------------------

@test "boxes, frames, orientations and names are read" {
    query '{"dim": 3, "bodies": [
        {"id": 1, "name": "table", "shape": "box", "size": [2,1,0.25], "position": [0,0,0.125]},
        {"id": 2, "name": "tool", "position": [0.5,0,0.5], "orientation": [3,0,0,-3], "velocity": [0,0,-0.5],
         "frames": [{"shape": "box", "size": [0.5,0.25,0.25], "position": [0,0,-0.125]},
                    {"shape": "cuboid", "origin": [0,0,0], "components": [[1,0,0],[0,1,0],[0,0,1]]}]},
        {"id": 3, "shape": "cuboid", "origin": [8,0,0.25], "components": [[1,0,0],[0,1,0],[0,0,1]]}]}' --box
    ended 0
    is '{"pairs": [{"a": 1, "b": 2, "names": ["table", "tool"], "verdict": "overlapping", "contact": [0, 1], "box": {"min": [0.375,-0.5,0], "max": [1,0.25,0.25]}}, {"a": 1, "b": 3, "names": ["table", null], "verdict": "separated"}, {"a": 2, "b": 3, "names": ["tool", null], "verdict": "separated"}]}'
}

# A quarter turn puts the corner of one square onto that of the other.
@test "an origin without a pose is the position, and with one in body coordinates" {
    corner='"shape": "cuboid", "components": [[1,0],[0,1]], "origin": [1,0]'
    for pose in '' ', "position": [0,0]' ', "orientation": [1,0]'; do
        query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $corner $pose}, {\"id\": 2, $square, \"origin\": [0,0]}]}"
        is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1]}]}'
    done
    query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $corner, \"orientation\": [1,1]},
        {\"id\": 2, $square, \"origin\": [0,0]}]}" --box
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1], "box": {"min": [0,1], "max": [0,1]}}]}'
}

# 3-4-5: the quarter turn of a rotation by (3, 4), squared.
# bats test_tags=release
@test "a box that is turned within its body is a cuboid, rounded once" {
    query '{"dim": 2, "bodies": [
        {"id": 1, "frames": [{"shape": "box", "size": [2,2], "position": [5,0], "orientation": [1,1]}]},
        {"id": 2, "shape": "box", "size": [2,2], "position": [3,0]},
        {"id": 3, "shape": "box", "size": [2,2], "position": [7,2]}]}' --box
    ended 0
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1], "box": {"min": [4,-1], "max": [4,1]}}, {"a": 1, "b": 3, "verdict": "touching", "contact": [0, 1], "box": {"min": [6,1], "max": [6,1]}}, {"a": 2, "b": 3, "verdict": "separated"}]}'
}

# bats test_tags=release
@test "names stand in tables" {
    scene="{\"dim\": 2, \"bodies\": [{\"id\": 1, \"name\": \"Tür <1>\", $square, \"origin\": [0,0]},
        {\"id\": 20, $square, \"origin\": [2,0]}]}"
    run "$FMB" query --local <<< "$scene"
    ended 0
    [ "${lines[2]}" = '  Tür <1>       20  separated' ]
    query "$scene"
    is '{"pairs": [{"a": 1, "b": 20, "names": ["T\u00fcr \u003c1\u003e", null], "verdict": "separated"}]}'
}

# bats test_tags=release
@test "ignored pairs are left out, in either order, once or more" {
    row='"shape": "box", "size": [1,1]'
    bodies="{\"dim\": 2, \"bodies\": [{\"id\": 1, $row}, {\"id\": 2, $row, \"position\": [1,0]},
        {\"id\": 3, $row, \"position\": [0,1]}]"
    query "$bodies, \"ignore\": [[2,1],[1,2],[2,3]]}"
    ended 0
    is '{"pairs": [{"a": 1, "b": 3, "verdict": "touching", "contact": [0, 1]}]}'
    query "$bodies, \"ignore\": [[2,1]], \"pairs\": [[3,1]]}"
    is '{"pairs": [{"a": 3, "b": 1, "verdict": "touching", "contact": [0, 1]}]}'
}

# ---- Rows ------------------------------------------------------------------------------------

# row N [MEMBERS]: squares 1 to N in a row: 1 and 2 overlap, 2 and 3 touch.
row() {
    awk -v n="$1" -v members="${2-}" 'BEGIN {
        printf "{\"dim\": 2, %s\"bodies\": [", members
        for (i = 1; i <= n; i++)
            printf "%s{\"id\": %d, \"shape\": \"box\", \"size\": [1,1], \"position\": [%g,0]}",
                i == 1 ? "" : ", ", i, i <= 2 ? 0.5 * i : i == 3 ? 2 : 3 * i
        print "]}"
    }'
}

# bats test_tags=release
@test "a table leaves out separated pairs after the first 20, and says how many" {
    run "$FMB" query --local <<< "$(row 10)"
    ended 0
    [ "$(grep -c '  separated$' <<< "$output")" = 20 ]
    [ "${lines[-2]}" = '  ... and 23 more separated (--all shows them)' ]
    [ "${lines[-1]}" = '1 overlapping, 1 touching, 43 separated' ]
    run "$FMB" query --local --all <<< "$(row 10)"
    [ "${#lines[@]}" = 48 ]
    run "$FMB" query --local <<< "$(row 7)"
    [ "$(grep -c '  separated$' <<< "$output")" = 19 ]
    [[ $output != *...* ]]
    # Near pairs are never left out, in whatever place.
    run "$FMB" query --local <<< "$(row 10 '"margin": 2, ')"
    [ "$(grep -c '  separated$' <<< "$output")" = 20 ]
    [ "$(grep -c '  separated  ' <<< "$output")" = 7 ]
    [ "${lines[-2]}" = '  ... and 16 more separated (--all shows them)' ]
    [ "${lines[-1]}" = '1 overlapping, 1 touching, 43 separated (7 near)' ]
    # JSON and CSV have all of them.
    query "$(row 10)"
    [ "$(jq '.pairs | length' <<< "$output")" = 45 ]
    run "$FMB" query --local --csv <<< "$(row 10)"
    [ "${#lines[@]}" = 46 ]
}

# bats test_tags=release
@test "--contacts prints pairs that touch, overlap or are near" {
    query "$(row 10 '"margin": 2, ')" --contacts
    ended 0
    [ "$(jq -c '[.pairs[] | [.a, .b]]' <<< "$output")" = '[[1,2],[1,3],[2,3],[4,5],[5,6],[6,7],[7,8],[8,9],[9,10]]' ]
    run "$FMB" query --local --contacts <<< "$(row 10)"
    ended 0
    [ "${lines[-1]}" = '1 overlapping, 1 touching, 43 separated' ]
    [ "${#lines[@]}" = 5 ]
    run --separate-stderr "$FMB" query --local --contacts --csv <<< "$(row 10)"
    [ "${#lines[@]}" = 3 ]
    # Of the steps of a path, those without contacts are only counted.
    local apart
    apart=$(printf '{"dim": 2, "bodies": [{"id": 1, %s, "origin": [0,0]}, {"id": 2, %s, "origin": [9,0]}]}' "$square" "$square")
    run "$FMB" query --local --contacts <<< "$apart $(row 10) $apart $(row 10) $apart"
    ended 0
    [ "$(grep -c '^scene ' <<< "$output")" = 2 ]
    [[ "${lines[0]}" = 'scene 2: '* ]]
    [ "${lines[-1]}" = 'overlapping in 2 of 5 scenes, first in scene 2: 1 and 2' ]
    run "$FMB" query --local --contacts <<< "$apart"
    ended 0
    [ "$output" = 'no contact' ]
    run "$FMB" query --local --gap <<< "$apart ${apart/9,0/4,0}"
    [ "${lines[-1]}" = 'no contact in 2 scenes; least gap 3' ]
    apart=${apart/'"dim"'/'"label": "home", "dim"'}
    apart=${apart/'"id": 2'/'"id": 2, "name": "post"'}
    run "$FMB" query --local --gap <<< "$apart ${apart/9,0/1,0} ${apart/9,0/0.5,0} ${apart/9,0/0.25,0}"
    [ "${lines[-1]}" = 'overlapping in 2 of 4 scenes, first in scene 3 (home): 1 and post; least gap -0.75' ]
    # A pair that could not be decided is one to look at.
    query '{"dim": 2, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[1,0]]},
        {"id": 2, "shape": "cuboid", "origin": [9,0], "components": [[1,0],[0,1]]}]}' --method sat --contacts
    ended 1
    jq -e '.pairs[0].error' <<< "$output"
}

@test "--csv has a line of names, and a line for each pair of all scenes" {
    run --separate-stderr "$FMB" query --local --csv --box <<< "{\"dim\": 2, \"margin\": 0.25, \"label\": \"a, \\\"b\\\"\", \"bodies\": [
        {\"id\": 1, \"name\": \"a \\\"b\\\", c\", $square, \"origin\": [0,0]},
        {\"id\": 20, $square, \"origin\": [1,0.125]},
        {\"id\": 3, \"name\": \"ü\", $square, \"origin\": [3,0]}]} $scene"
    ended 0
    is 'utime,scene,label,a,b,name_a,name_b,verdict,contact_first,contact_last,gap_low,gap_high,min_x,min_y,min_z,max_x,max_y,max_z,error,point_time,point_x,point_y,point_z
,1,"a, ""b""",1,20,"a ""b"", c",,touching,0,1,0,0,1,0.125,,1,1,,,,,,
,1,"a, ""b""",1,3,"a ""b"", c","ü",separated,,,,,,,,,,,,,,,
,1,"a, ""b""",20,3,,"ü",separated,,,,,,,,,,,,,,,
,2,,1,2,,,touching,0,1,,,1,0,0,1,1,1,,,,,'
    run --separate-stderr "$FMB" query --local --csv --method sat <<< '{"dim": 2, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[1,0]]},
        {"id": 2, "shape": "cuboid", "origin": [9,0], "components": [[1,0],[0,1]]}]}'
    ended 1
    [[ ${lines[1]} == ',1,,1,2,,,,,,,,,,,,,,"'?*'",,,,' ]]
}

# bats test_tags=release
@test "an infinite end of a box is inf in CSV" {
    far='{"dim": 2, "bodies": [
        {"id": 1, "shape": "box", "size": [1e308,1], "position": [1.7e308,0]},
        {"id": 2, "shape": "box", "size": [1e308,0.1], "position": [1.7e308,0.3]}]}'
    query "$far" --box
    json=$(jq -r '.pairs[0].box | [.min[], .max[]] | map(. // "inf") | join(",")' <<< "$output")
    run "$FMB" query --local --csv --box <<< "$far"
    ended 0
    cut -d , -f 13,14,16,17 <<< "${lines[1]}" | grep -x '.*,.*,inf,.*'
    jq -en --arg json "$json" --arg csv "$(cut -d , -f 13,14,16,17 <<< "${lines[1]}")" \
        '[$json, $csv] | map(split(",") | map(tonumber? // "inf")) | .[0] == .[1]'
}

# bats test_tags=release
@test "a label stands in the table and before the pairs" {
    query "$(row 2 '"label": "shelf <1>", ')"
    [[ $output == '{"label": "shelf \u003c1\u003e", "pairs": [{"a": 1, '* ]]
    run "$FMB" query --local <<< "$(row 2 '"label": "shelf <1>", ')"
    [ "${lines[0]}" = 'scene 1 (shelf <1>): 2 bodies in 2D, 1 pair, 0 to 1 s' ]
}

# fails CODE TEXT OPTIONS: with the answers of all scenes of the text.
fails() {
    query "$2" "${@:3}"
    ended "$1"
    [ "$(wc -l <<< "$output")" = "$(grep -o '"dim"' <<< "$2" | wc -l)" ]
}

# bats test_tags=release
@test "--fail-if exits with 3 after all scenes" {
    apart='{"dim": 2, "margin": 1, "bodies": [{"id": 1, "shape": "box", "size": [1,1]}, {"id": 2, "shape": "box", "size": [1,1], "position": [9,0]}]}'
    near=${apart/9/1.5}
    touching=${apart/9/1}
    overlapping=${apart/9/0.5}
    fails 0 "$apart" --fail-if near
    fails 3 "$apart $near $apart" --fail-if near
    fails 0 "$apart $near $apart" --fail-if touching
    fails 3 "$touching $near" --fail-if touching
    fails 3 "$touching $near" --fail-if near
    fails 0 "$touching $near" --fail-if overlapping
    for what in near touching overlapping; do
        fails 3 "$overlapping $apart" --fail-if $what
    done
    fails 0 "$overlapping $apart"
    # Without a margin no pair is near.
    run --separate-stderr "$FMB" query --local --fail-if near <<< "${near/\"margin\": 1, /}"
    ended 0
    said 'fmb: --fail-if near: no scene has a "margin", so no separated pair is near'
}

@test "scenes without a pair, and velocities without a duration, are reported" {
    one='{"dim": 2, "bodies": [{"id": 7, "shape": "box", "size": [1,1]}]}'
    query "$one"
    ended 0
    said 'fmb: the scene has no pair to decide'
    query "$one ${scene%\}}, \"pairs\": []} $scene"
    ended 0
    said 'fmb: 2 of 3 scenes have no pair to decide'
    moving='{"dim": 2, "duration": 0, "bodies": [{"id": 7, "shape": "box", "size": [1,1]}, {"id": 8, "shape": "box", "size": [1,1], "velocity": [0,-1]}]}'
    query "$scene $moving $moving"
    ended 0
    said 'fmb: body 8 has a velocity, but "duration" is 0: nothing moves'
    query "$moving ${moving/: 0/: 1}" # the last one of a path, perhaps
    said ''
    query "${moving/,-1/,0}"
    said ''
}

# bats test_tags=release
@test "with --fail-if, 1 and 2 keep their meaning" {
    flat='{"dim": 2, "bodies": [{"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[1,0]]},
        {"id": 2, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[0,1]]}]}'
    fails 1 "$scene $flat" --fail-if touching --method sat
    query "$scene {}" --fail-if touching
    ended 2
    query "$scene" --fail-if touching --html /no/such/folder/scene.html
    ended 1
}

# ---- Points ----------------------------------------------------------------------------------

# Two cubes that overlap in [0.5,1] x [0,1] x [0,1], and one that is apart.
overlap="{\"dim\": 3, \"bodies\": [{\"id\": 1, \"shape\": \"box\", \"size\": [1,1,1], \"position\": [0.5,0.5,0.5]},
    {\"id\": 2, \"shape\": \"box\", \"size\": [1,1,1], \"position\": [1,0.5,0.5]},
    {\"id\": 3, \"shape\": \"box\", \"size\": [1,1,1], \"position\": [4,0.5,0.5]}]}"

@test "--point gives a time and a point of each contact" {
    query "$overlap" --point
    ended 0
    said ''
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "overlapping", "contact": [0, 1], "point": {"time": 0, "position": [0.75,0.5,0.5]}}, {"a": 1, "b": 3, "verdict": "separated"}, {"a": 2, "b": 3, "verdict": "separated"}]}'
    query "$overlap" --point --box --gap
    jq -e '.pairs[0] | keys_unsorted[-5:] == ["box", "point", "gap", "direction", "witness"]' <<< "$output"
    # Squares that meet at the corner (1, 1) when one has come half a unit: 0.25 s.
    query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $square, \"origin\": [0,0]},
        {\"id\": 2, $square, \"origin\": [1,1.5], \"velocity\": [2,-2]}, {\"id\": 3, $square, \"origin\": [0.5,1.5], \"velocity\": [2,-2]}],
        \"pairs\": [[1,3],[2,1]]}" --point
    ended 0
    jq -e '.pairs[0] | .verdict == "touching" and .contact == [0.25, 0.25] and .point == {time: 0.25, position: [1, 1]}' <<< "$output"
    jq -e '.pairs[1] | .verdict == "separated" and (has("point") | not)' <<< "$output"
    # Of methods that may be wrong there is none, as there is no box of sat.
    for method in fmb sat; do
        query "$scene" --point --method $method
        ended 0
        jq -e '.pairs[0] | .contact and (has("point") | not)' <<< "$output"
    done
    query "$overlap"
    [[ $output != *point* ]]
}

@test "a point stands in a table before the box, and in CSV after the error" {
    run "$FMB" query --local --point --box --gap <<< "$overlap"
    ended 0
    is "scene 1: 3 bodies in 3D, 3 pairs, 0 to 1 s
  a  b  verdict      contact               gap           point                                       box
  1  2  overlapping  0 to 1 s              -0.5          (0.75, 0.5, 0.5) at 0 s                     x      0.5 .. 1         y        0 .. 1         z        0 .. 1
  1  3  separated                          2.5
  2  3  separated                          2
1 overlapping, 0 touching, 2 separated"
    run "$FMB" query --local --point <<< "$overlap"
    [ "${lines[2]}" = '  1  2  overlapping  0 to 1 s              (0.75, 0.5, 0.5) at 0 s' ]
    run --separate-stderr "$FMB" query --local --csv --point --contacts <<< "$overlap {\"dim\": 2, \"bodies\": [
        {\"id\": 1, $square, \"origin\": [0,0]}, {\"id\": 2, $square, \"origin\": [1,1]}]}"
    ended 0
    [ "${lines[1]}" = ',1,,1,2,,,overlapping,0,1,,,,,,,,,,0,0.75,0.5,0.5' ]
    [ "${lines[2]}" = ',2,,1,2,,,touching,0,1,,,,,,,,,,0,1,1,' ]
}

# ---- Gaps ------------------------------------------------------------------------------------

# spaced REST: a square with others at -0.5, 0, 0.5 and 3 from it, the last one moving towards it.
spaced() {
    local unit='"shape": "box", "size": [1,1]'
    echo "{\"dim\": 2, \"duration\": 0.5, \"bodies\": [{\"id\": 1, $unit},
        {\"id\": 2, $unit, \"position\": [0.5,0]}, {\"id\": 3, $unit, \"position\": [0,-1]},
        {\"id\": 4, $unit, \"position\": [-1.5,0]},
        {\"id\": 5, $unit, \"position\": [0,4], \"velocity\": [0,-2]}],
        \"pairs\": [[1,2],[1,3],[1,4],[1,5]]$1}"
}

# gap K NUMBER: the gap of pair K encloses the number, and no more than it may
gap() {
    jq -e --argjson k "$1" --argjson gap "$2" \
        '.pairs[$k].gap | .[0] <= $gap and $gap <= .[1] and .[1] - .[0] <= 5e-12' <<< "$output"
}

@test "--gap gives depths, distances, directions and nearest points" {
    query "$(spaced)" --gap
    ended 0
    gap 0 -0.5
    jq -e '.pairs[0] | .verdict == "overlapping" and .direction == [1,0] and
        (.witness | .time == 0 and .a[0] - .b[0] == 0.5 and .a[1] == .b[1])' <<< "$output"
    jq -e '.pairs[1] | .verdict == "touching" and .gap == [0,0] and .direction == [0,-1] and (has("witness") | not)' <<< "$output"
    gap 2 0.5
    jq -e '.pairs[2] | .verdict == "separated" and .direction == [-1,0]' <<< "$output"
    jq -e '.pairs[2].witness | .a[0] == -0.5 and .b[0] == -1 and (.a[1] - .b[1] | fabs) <= 1e-12' <<< "$output"
    gap 3 2
    jq -e '.pairs[3] | .direction == [0,1] and .witness.time == 0.5 and .witness.b[1] == 2.5' <<< "$output"
    jq -e '[.pairs[] | keys_unsorted[-2:] == ["gap", "direction"] or keys_unsorted[-3:] == ["gap", "direction", "witness"]] | all' <<< "$output"
    query "$(spaced)"
    [[ $output != *gap* ]]
}

# bats test_tags=release
@test "the gap stands in a table, before the box" {
    run "$FMB" query --local --gap --box <<< "$(spaced)"
    ended 0
    is "scene 1: 5 bodies in 2D, 4 pairs, 0 to 0.5 s
  a  b  verdict      contact               gap           box
  1  2  overlapping  0 to 0.5 s            -0.5          x        0 .. 0.5       y     -0.5 .. 0.5
  1  3  touching     0 to 0.5 s            0             x     -0.5 .. 0.5       y     -0.5 .. -0.5
  1  4  separated                          0.5
  1  5  separated                          2
1 overlapping, 1 touching, 2 separated"
}

@test "with a margin, contacts and near pairs have gaps" {
    query "$(spaced ', "margin": 0.5000001')"
    ended 0
    [ "$(jq -c '[.pairs[] | has("gap")]' <<< "$output")" = '[true,true,true,false]' ]
    gap 2 0.5
    near=$output
    query "$(spaced ', "margin": 0.5000001')" --gap
    [ "$(jq -c '[.pairs[] | has("gap")]' <<< "$output")" = '[true,true,true,true]' ]
    [ "$(jq -c '.pairs[:3]' <<< "$output")" = "$(jq -c '.pairs[:3]' <<< "$near")" ]
    run "$FMB" query --local <<< "$(spaced ', "margin": 2.25')"
    ended 0
    [ "${lines[-1]}" = '1 overlapping, 1 touching, 2 separated (2 near)' ]
    # The gap is the margin.
    run "$FMB" query --local <<< '{"dim": 2, "margin": 0.5, "bodies": [{"id": 1, "shape": "box", "size": [1,1]},
        {"id": 2, "shape": "box", "size": [1,1], "position": [1.5,0]}]}'
    [ "${lines[-1]}" = '0 overlapping, 0 touching, 1 separated (1 near)' ]
    run "$FMB" query --local <<< "$(spaced ', "margin": 0.4999')"
    [ "${lines[-1]}" = '1 overlapping, 1 touching, 2 separated (0 near)' ]
}

# bats test_tags=release
@test "cubes at rest as programs compute it are near at a margin of 1e-9, whatever their verdict" {
    clients/demo/cubes.sh > "$BATS_TEST_TMPDIR/cubes.json"
    query "$(cat "$BATS_TEST_TMPDIR/cubes.json")"
    ended 0
    jq -e '[.pairs[] | select(.gap)] | length == 96 and all(.a == 97) and all(.gap[0] > -1e-12 and .gap[1] < 1e-12)' <<< "$output"
    jq -e '[.pairs[] | select(.gap) | .verdict] | unique | length == 3' <<< "$output"
    jq -e '[.pairs[] | select(.gap) | select(.verdict != "separated")] | length < 96' <<< "$output"
}

# bats test_tags=release
@test "a gap beyond the largest double is null" {
    query "{\"dim\": 2, \"bodies\": [{\"id\": 1, $square, \"origin\": [1e308,0]},
        {\"id\": 2, $square, \"origin\": [-1e308,0]}]}" --gap
    ended 0
    jq -e '.pairs[0] | .verdict == "separated" and .gap[1] == null and .direction == [-1,0]' <<< "$output"
}

# bats test_tags=release
@test "methods without gaps give errors and exit code 1" {
    for method in fmb sat; do
        query "$(spaced)" --gap --method $method
        ended 1
        [ "$(jq -c '[.pairs[].error] | unique' <<< "$output")" = '["method: gives no gaps"]' ]
        query "$(spaced ', "margin": 1e-9')" --method $method
        ended 1
        query "$(spaced ', "margin": 0')" --method $method
        ended 0
    done
    query "$(spaced)" --gap --method exact
    ended 0
}

# ---- Certificates ----------------------------------------------------------------------------

# Three squares: 1 and 2 touch, 1 and 3 overlap, and 2 and 3 are apart. squares MEMBERS: with these
# members more in the third.
squares() {
    echo "{\"dim\": 2, \"bodies\": [{\"id\": 1, $square, \"origin\": [0,0]},
        {\"id\": 2, $square, \"origin\": [1,0]}, {\"id\": 3, $square, \"origin\": [-0.5,0.25] $1}]}"
}

@test "--certificate proves every verdict, at rest and moving, as the last field" {
    for members in '' ', "velocity": [0,0.5]'; do
        query "$(squares "$members")" --certificate --box
        ended 0
        said ''
        jq -e '[.pairs[].verdict] == ["touching", "overlapping", "separated"]' <<< "$output"
        jq -e '[.pairs[] | (.verdict as $verdict | .certificate | startswith($verdict + " "))
            and (keys_unsorted | last == "certificate")] | all' <<< "$output"
        certified=$output
        query "$(squares "$members")" --box
        jq -e --argjson certified "$certified" '. == ($certified | del(.pairs[].certificate))' <<< "$output"
        [[ $output != *certificate* ]]
    done
}

# bats test_tags=release
@test "a certificate stands below its row in a table" {
    certificates=$(query "$(squares)" --certificate && jq -r '.pairs[].certificate' <<< "$output")
    run "$FMB" query --local --certificate <<< "$(squares)"
    ended 0
    [ "${#lines[@]}" = 9 ]
    [ "${lines[2]}" = '  1  2  touching     0 to 1 s' ]
    [ "${lines[4]}" = '  1  3  overlapping  0 to 1 s' ]
    [ "${lines[6]}" = '  2  3  separated' ]
    [ "$(sed -n '4p;6p;8p' <<< "$output" | sed 's/^        //')" = "$certificates" ]
}

# bats test_tags=release
@test "every case of tests/cases has certificates, and the same answers" {
    for file in "$CASES"/*.json; do
        scene=$(jq -c .scene "$file")
        query "$scene" --box
        plain=$output
        query "$scene" --box --certificate
        ended 0
        jq -e '[.pairs[] | has("certificate")] | all' <<< "$output"
        jq -e --argjson plain "$plain" 'del(.pairs[].certificate) == $plain' <<< "$output"
    done
}

@test "a certificate of many digits is whole in JSON, and shortened in a table" {
    scene='{"dim": 2, "duration": 1e-300, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[0,1]]},
        {"id": 2, "shape": "cuboid", "origin": [-3,0.3], "velocity": [4e300,0],
         "components": [[1,0],[0,1]]}]}'
    query "$scene" --certificate
    ended 0
    length=$(jq '.pairs[0].certificate | length' <<< "$output")
    [ "$length" -gt 300 ]
    run "$FMB" query --local --certificate <<< "$scene"
    ended 0
    [ "${#lines[3]}" -lt 250 ]
    [[ ${lines[3]//,/} == *"... ($length characters)" ]]
}

# bats test_tags=release
@test "a pair whose numbers span too much for a certificate is not decided with one" {
    scene='{"dim": 2, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[0,1]]},
        {"id": 2, "shape": "cuboid", "origin": [1e200,0], "components": [[1,0],[0,1]]}]}'
    query "$scene" --certificate
    ended 1
    [ "$(jq -r '.pairs[0].error' <<< "$output")" = "no certificate: there is none for bodies that turn and touch, or for numbers that span more than 512 bits" ]
    query "$scene"
    ended 0
}

@test "turning bodies that do not touch have certificates, which hold" {
    door='{"dim": 3, "bodies": [{"id": 1, "shape": "box", "size": [1,1,1], "orientation": [1,0,0,0], "end": {"orientation": [1,1,0,0]}},
        {"id": 2, "shape": "box", "size": [1,1,1], "position": [1,0,0]}, {"id": 3, "shape": "box", "size": [1,1,1], "position": [0,1.125,0]},
        {"id": 4, "shape": "box", "size": [1,1,1], "position": [-2,0,0]}], "pairs": [[1,2], [1,3], [1,4]]}'
    query "$door" --certificate
    ended 1
    jq -e '[.pairs[] | .verdict // .error | .[:14]] == ["no certificate", "overlapping", "separated"]' <<< "$output"
    jq -e '.pairs[1].certificate | test("^overlapping at [0-9/]+ a .* b ")' <<< "$output"
    jq -e '.pairs[2].certificate == "separated from 0 to 1 normal b (-1 0 0)"' <<< "$output"
}

# bats test_tags=release
@test "a pair with a body of several frames has its verdict, but no certificate" {
    box='"shape": "box", "size": [1,1]'
    scene="{\"dim\": 2, \"bodies\": [{\"id\": 1, $box}, {\"id\": 2, $box, \"position\": [1,0]},
        {\"id\": 3, \"frames\": [{$box}, {$box, \"position\": [5,0]}]}]}"
    query "$scene" --certificate --fail-if overlapping
    ended 3
    said 'fmb: no certificate for 2 of the pairs: a body has several frames'
    jq -e '[.pairs[] | [.a, .b, .verdict, has("certificate")]] ==
        [[1, 2, "touching", true], [1, 3, "overlapping", false], [2, 3, "touching", false]]' <<< "$output"
}

@test "where an inexact method is wrong, the certificate does not hold" {
    scene='{"dim": 2, "bodies": [
        {"id": 1, "shape": "tetrahedron", "origin": [-0.5,-0.6], "components": [[-0.2,0.9], [0.5,-0.2]]},
        {"id": 2, "shape": "tetrahedron", "origin": [-0.7,0.3], "components": [[0.2,0.5], [0.5,-0.2]]}]}'
    for method in fmb sat; do
        query "$scene" --method $method
        ended 0
        query "$scene" --method $method --certificate
        ended 1
        [[ $(jq -r '.pairs[0].error' <<< "$output") == "the certificate does not hold: "?* ]]
    done
    query "$scene" --certificate
    ended 0
}

# bats test_tags=release
@test "a pair that is not decided has no certificate" {
    query '{"dim": 2, "bodies": [
        {"id": 1, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[1,0]]},
        {"id": 2, "shape": "cuboid", "origin": [0,0], "components": [[1,0],[0,1]]}]}' --method sat --certificate
    ended 1
    [ "$(jq -c '.pairs[0] | keys' <<< "$output")" = '["a","b","error"]' ]
}

# ---- Methods ---------------------------------------------------------------------------------

# bats test_tags=release
@test "the inexact methods answer" {
    for method in exact fmb sat; do
        query "$two, \"pairs\": [[1,2]]}" --method $method
        ended 0
        jq -e '.pairs[0] | .a == 1 and has("verdict")' <<< "$output"
    done
}

# bats test_tags=release
@test "a pair that a method cannot decide has an error, and the exit code is 1" {
    flat='{"dim": 3, "bodies": [
        {"id": 1, "shape": "face", "origin": [0,0,0], "components": [[1,0,0],[0,1,0]]},
        {"id": 2, "shape": "face", "origin": [0,0,0], "components": [[1,0,0],[0,1,0]]}]}'
    query "$flat" --method sat
    ended 1
    jq -e '.pairs[0] | has("error") and (has("verdict") | not)' <<< "$output"
    run "$FMB" query --local --method sat <<< "$flat"
    ended 1
    [[ $output == *"1  2  not decided: "* ]]
    [[ $output == *", 1 not decided" ]]
    query "$flat"
    ended 0
}

# ---- What is refused -------------------------------------------------------------------------

@test "a bad scene is refused with one line that names the place, and exit code 2" {
    query "{\"dim\": 3, \"bodies\": [{\"id\": 1, $cube, \"origin\": [0,0,0]},
        {\"id\": 2, \"shape\": \"cuboid\", \"origin\": [0,0,0], \"components\": [[1,0,0],[0,1],[0,0,1]]}]}"
    ended 2
    is ''
    said 'fmb: standard input: bodies[1].components[1]: expected 3 numbers, found 2'
}

@test "answers before a bad scene are printed, and scenes after it are not read" {
    query "$scene {\"dim\": 3, \"bodies\": [], \"bodies\": []} $scene"
    ended 2
    is '{"pairs": [{"a": 1, "b": 2, "verdict": "touching", "contact": [0, 1]}]}'
    said 'fmb: standard input: scene 2: repeated key "bodies"'
}

@test "a name of a file stands in its errors" {
    printf '{"dim": 3,\n "bodies": [1,]}' > "$BATS_TEST_TMPDIR/bad.json"
    run "$FMB" query --local "$BATS_TEST_TMPDIR/bad.json"
    ended 2
    is "fmb: $BATS_TEST_TMPDIR/bad.json: line 2, column 15: invalid JSON"
}

# refused BODIES REST PLACE: a 3D scene of these bodies.
refused() {
    query "{\"dim\": ${dim:-3}, \"bodies\": [{\"id\": 9, $cube, \"origin\": [0,0,0]}, {\"id\": 1, $1}]$2}"
    ended 2
    is ''
    [[ $stderr == "fmb: standard input: $3: "* ]]
    [ "$(wc -l <<< "$stderr")" = 1 ]
}

@test "bad poses, boxes, frames, names and ignored pairs are refused with the place" {
    box='"shape": "box", "size": [1,1,1]'
    refused "$box, \"orientation\": [0,0,0,0]" '' 'bodies[1].orientation'
    refused "$box, \"orientation\": [1,0,0]" '' 'bodies[1].orientation'
    refused "$box, \"orientation\": [1,0,0,0,0]" '' 'bodies[1].orientation'
    refused "$box, \"orientation\": [1,0,1e999,0]" '' 'bodies[1].orientation[2]'
    refused "$box, \"orientation\": [1e200,0,0,1e-200]" '' 'bodies[1].orientation'
    refused "$box, \"frames\": []" '' 'bodies[1]'
    refused '"frames": []' '' 'bodies[1].frames'
    refused '"frames": [{"shape": "box", "size": [1,1]}]' '' 'bodies[1].frames[0].size'
    refused '"frames": [{"shape": "face", "components": [[1,0,0],[0,1,0]], "position": [0,0,0]}]' '' 'bodies[1].frames[0]'
    refused '"frames": [{"id": 3}]' '' 'bodies[1].frames[0]'
    refused '"shape": "box", "size": [1,-1,1]' '' 'bodies[1].size[1]'
    refused "$box, \"origin\": [0,0,0]" '' 'bodies[1]'
    refused "$cube, \"origin\": [0,0,0], \"size\": [1,1,1]" '' 'bodies[1]'
    refused "$cube" '' 'bodies[1]'
    refused '"shape": "box"' '' 'bodies[1]'
    refused "$box, \"name\": 5" '' 'bodies[1].name'
    refused "$box, \"name\": \"a\\u0085b\"" '' 'bodies[1].name'
    refused "$box, \"name\": \"$(printf '%065d' 0)\"" '' 'bodies[1].name'
    refused "$box" ', "margin": -1' 'margin'
    refused "$box" ', "margin": 1e999' 'margin'
    refused "$box" ', "ignore": [[1,9],[1,2]]' 'ignore[1][1]'
    refused "$box" ', "ignore": [[1,1]]' 'ignore[0]'
    refused "$box" ', "ignore": [[1,9]], "pairs": [[9,1]]' 'pairs[0]'
    frames=$(printf '{"shape": "face", "components": [[1,0,0],[0,1,0]]},%.0s' $(seq 900))
    refused "\"frames\": [${frames%,}]" '' 'bodies[1].frames'
    query '{"dim": 2, "bodies": [{"id": 1, "shape": "box", "size": [1,1], "orientation": [1,0,0,0]}]}'
    ended 2
    said 'fmb: standard input: bodies[0].orientation: expected 2 numbers, found 4'
}

@test "scenes with radii, and pairs given by name, are answered; how far hulls extend beyond cylinders is reported" {
    query '{"dim": 3, "duration": 8, "bodies": [
      {"id": 1, "name": "ball", "shape": "sphere", "radius": 3},
      {"id": 2, "name": "other", "shape": "sphere", "radius": 4, "position": [2,3,6]},
      {"id": 3, "name": "capsule", "shape": "capsule", "radius": 1, "length": 6, "position": [0,-4,-3]},
      {"id": 4, "name": "padded", "shape": "box", "size": [2,2,2], "radius": 1, "position": [0,0,-5]},
      {"id": 5, "name": "flying", "shape": "sphere", "radius": 2, "position": [-13,3,0], "velocity": [2,0,0]},
      {"id": 6, "name": "turned", "position": [0,9,0], "orientation_xyzw": [0,0,3,3],
       "frames": [{"shape": "capsule", "radius": 2, "length": 4, "orientation_xyzw": [0,1,0,1]}, {"shape": "cylinder", "radius": 4, "length": 1, "sides": 8, "position": [0,0,9]}]}],
      "pairs": [["ball","other"], [1,"capsule"], ["padded",1], [1,"flying"], ["flying","other"], ["ball","turned"], ["flying","turned"]]}' --gap --certificate
    ended 0
    [ "$(jq -c '[.pairs[].verdict]' <<< "$output")" = '["touching","touching","touching","overlapping","touching","separated","touching"]' ]
    jq -e '.pairs | (.[3] | (.contact[0] - 4.5 | fabs) < 1e-11 and .gap[0] <= -2 and .gap[1] >= -2) and (.[5].gap | .[0] <= 2 and .[1] >= 2)
        and (.[4].contact | .[0] <= 7.5 and .[1] >= 7.5 and .[1] - .[0] <= 1.6e-11)' <<< "$output"
    [[ $stderr == *'fmb: standard input: hulls enclose its cylinders, and extend beyond them by at most 0.329572'* ]]
    query '{"dim": 2, "bodies": [{"id": 1, "shape": "sphere", "radius": 2}, {"id": 2, "shape": "capsule", "radius": 3, "length": 1, "position": [4,3.5]}]}' --box
    [[ $output == *touching* ]]
}

@test "a body has an end only in a window, and in place of a velocity; orientations of different lengths are reported once" {
    ending='{"dim": 3, "duration": 2, "bodies": [{"id": 1, "shape": "sphere", "radius": 1}, {"id": 7, "shape": "box", "size": [1,1,1], "position": [9,0,0],
        "end": {"orientation": [2,0,0,2]}}, {"id": 8, "shape": "box", "size": [1,1,1], "position": [0,9,0], "end": {"orientation": [2,0,0,0]}}]}'
    for scenes in "$ending" "$ending $ending"; do
        query "$scenes"
        said 'fmb: body 7 turns unevenly: its orientations at the start and at the end of the window have different lengths'
    done
    query "${ending/2,0,0,2/0.6,0,0,-0.8}" # of length 1, up to rounding
    said ''
    query "${ending/: 2,/: 0,}"
    ended 2
    said 'fmb: standard input: bodies[1].end: "duration" is 0: the window has no end of its own'
    query "${ending/2,0,0,2/0,0,1,0}"
    ended 2
    said 'fmb: standard input: bodies[1].end.orientation: half a turn away, which takes two windows, or not from 1/4 to 4 times as long'
    query "${ending/9,0,0],/9,0,0], \"velocity\": [0,0,0],}"
    ended 2
    said 'fmb: standard input: bodies[1]: both "velocity" and "end"'
}

@test "an unknown key or shape lists what there is" {
    query '{"dim": 3, "bodies": [{"id": 1, "radii": 1}]}'
    ended 2
    said 'fmb: standard input: bodies[0]: unknown key "radii" (there are id, name, group, velocity, link, shape, origin, components, vertices, size, radius, length, sides, position, orientation, orientation_xyzw, frames, end)'
    query '{"dim": 3, "bodies": [{"id": 1, "shape": "ball"}]}'
    said 'fmb: standard input: bodies[0].shape: unknown shape "ball" (there are cuboid, tetrahedron, face, box, hull, sphere, capsule, cylinder)'
    query '{"dim": 3, "bodys": []}'
    said 'fmb: standard input: unknown key "bodys" (there are label, dim, duration, margin, bodies, pairs, ignore)'
}

@test "an empty input is refused, and a URDF" {
    run "$FMB" query --local <<< '<robot/>'
    ended 2
    is "fmb: standard input: line 1, column 1: expected an object, '{', found '<' (is it a URDF? fmb scene reads it)"
    run "$FMB" query --local < /dev/null
    ended 2
    is 'fmb: standard input: the input is empty: expected a scene'
}

# bats test_tags=release
@test "a missing file and a directory are reported" {
    run "$FMB" query --local /no/such/file
    ended 2
    is 'fmb: /no/such/file: No such file or directory'
    run "$FMB" query --local .
    ended 2
    is 'fmb: .: Is a directory'
}

@test "a hundred million brackets are refused" {
    run bash -c "head -c 100000000 /dev/zero | tr '\\0' '[' | '$FMB' query --local"
    ended 2
    is "fmb: standard input: line 1, column 1: expected an object, '{', found '['"
    run bash -c "{ echo -n '{\"dim\":'; head -c 100000000 /dev/zero | tr '\\0' '['; } | '$FMB' query --local"
    ended 2
    is 'fmb: standard input: line 1, column 39: nested more than 32 deep'
}

# bats test_tags=release
@test "a full standard output is a failure" {
    [ -w /dev/full ] || skip "no /dev/full"
    run bash -c "'$FMB' query --local --json > /dev/full" <<< "$scene"
    ended 1
    [[ $output == "fmb: standard output: "* ]]
}

# ---- Much ------------------------------------------------------------------------------------

# all_pairs N: a scene of N cubes in a row, each touching the next.
all_pairs() {
    awk -v n="$1" 'BEGIN {
        printf "{\"dim\":3,\"bodies\":["
        for (i = 1; i <= n; i++)
            printf "%s{\"id\":%d,\"shape\":\"cuboid\",\"origin\":[%d,0,0],\"components\":[[1,0,0],[0,1,0],[0,0,1]]}",
                i == 1 ? "" : ",", i, i
        print "]}"
    }'
}

@test "100,000 pairs take memory that does not grow with them" {
    case ${FMB_BUILD:-build} in *asan*) skip "address sanitizer takes memory of its own" ;; esac
    all_pairs 448 > "$BATS_TEST_TMPDIR/many.json"
    (
        ulimit -v 65536
        "$FMB" query --local --json "$BATS_TEST_TMPDIR/many.json" > "$BATS_TEST_TMPDIR/answers"
    )
    [ "$(jq -c '[.pairs | length, (map(select(.verdict == "touching")) | length)]' "$BATS_TEST_TMPDIR/answers")" = '[100128,447]' ]
}

@test "a list of 100,000 pairs is answered" {
    awk 'BEGIN {
        printf "{\"dim\":2,\"bodies\":["
        for (i = 1; i <= 1000; i++)
            printf "%s{\"id\":%d,\"shape\":\"tetrahedron\",\"origin\":[%d,0],\"components\":[[1,0],[0,1]]}",
                i == 1 ? "" : ",", 7 * i, i
        printf "],\"pairs\":["
        for (i = 0; i < 100000; i++)
            printf "%s[%d,%d]", i == 0 ? "" : ",", 7 * (i % 1000 + 1), 7 * ((i + 1) % 1000 + 1)
        print "]}"
    }' > "$BATS_TEST_TMPDIR/listed.json"
    "$FMB" query --local --json "$BATS_TEST_TMPDIR/listed.json" > "$BATS_TEST_TMPDIR/answers"
    [ "$(jq -c '[.pairs | length, (map(select(.verdict == "touching")) | length)]' "$BATS_TEST_TMPDIR/answers")" = '[100000,99900]' ]
}

# ---- Pages: what they show is tested by page.bats --------------------------------------------

# bats test_tags=release
@test "--html implies --box" {
    query "$scene $scene" --html "$BATS_TEST_TMPDIR/scene.html"
    ended 0
    [ "$(jq -s 'map(.pairs[0] | has("box")) | all' <<< "$output")" = true ]
}

# bats test_tags=release
@test "a page that cannot be written leaves the answers, with exit code 1" {
    query "$scene" --html /no/such/folder/scene.html
    ended 1
    [ "$(jq '.pairs | length' <<< "$output")" = 1 ]
    said 'fmb: /no/such/folder/scene.html: No such file or directory'
}

# ---- The command -----------------------------------------------------------------------------

# bats test_tags=release
@test "the example of the help is a scene" {
    "$FMB" query --help | sed -n '/^  {"dim"/,/^Exit/p' | sed '$d' > "$BATS_TEST_TMPDIR/scene.json"
    run "$FMB" query --local --json "$BATS_TEST_TMPDIR/scene.json"
    ended 0
    [ "$(jq '.pairs | length' <<< "$output")" = 2 ]
}

# bats test_tags=release
@test "--version prints the version" {
    run "$FMB" --version
    ended 0
    [[ $output =~ ^fmb\ [0-9]+\.[0-9]+\.[0-9]+$ ]]
}

@test "names with control characters are escaped on the terminal, by every command" {
    # Of the terminal, a line that seems to be another message, and marks that reorder the text after them.
    name=$(printf '%s/\033[31mred\302\233\nfmb: forged\342\200\256' "$BATS_TEST_TMPDIR")
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > "$name.obj"
    printf x > "$name"
    printf '%s' "$scene" > "$name.json"
    cp "$BATS_TEST_DIRNAME/../logs/stack.log" "$name.log"
    for arguments in "query --local @" "query @/none" "query --local --html @/none @.json" "mesh @.obj @" \
        "mesh @.obj @.obj" "mesh @.obj @.obj --html @/none" "log info @" "log info @.log" "log cut --output @/none @.log" \
        "log scene --event 99999 @.log" "log scene --event 1 @" "replay @" "replay @/none" "replay --golden @ @.log" \
        "replay --junit /dev/stderr @.log" "scene @" "scene --joints @ @" "record @/none" "record --@" "watch @" "log @" "@" \
        "help @" "status --lcm-url @" "status --timeout @" "mesh --scale @"; do
        words=()
        for word in $arguments; do words+=("${word/@/$name}"); done
        "$FMB" "${words[@]}" > "$BATS_TEST_TMPDIR/said" 2>&1 < /dev/null || true
        grep -qaE '(\\x1b|�)\[31mred' "$BATS_TEST_TMPDIR/said" || { echo "does not name it: $arguments"; cat -v "$BATS_TEST_TMPDIR/said"; false; }
        ! LC_ALL=C grep -qa -e $'\033' -e $'\302\233' -e '^fmb: forged' -e $'\342\200\256' "$BATS_TEST_TMPDIR/said" ||
            { echo "raw: $arguments"; cat -v "$BATS_TEST_TMPDIR/said"; false; }
    done
    for mark in 061c 200e 200f 2028 2029 202a 202b 202c 202d 202e 2066 2067 2068 2069; do
        jq -c ".label = \"l\\u$mark\" | .bodies[0].name = \"n\\u$mark\"" <<< "$scene" > "$BATS_TEST_TMPDIR/marked"
        for form in '' --csv; do
            # shellcheck disable=SC2086
            run "$FMB" query --local $form "$BATS_TEST_TMPDIR/marked"
            ended 0
            [[ $output == *"l\\u$mark"* && $output == *"n\\u$mark"* && $output != *$(jq -r '.label[1:]' "$BATS_TEST_TMPDIR/marked")* ]]
        done
    done
}
