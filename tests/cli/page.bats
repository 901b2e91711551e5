# The page of --html: its contents, and what a browser shows of scenes, recordings and meshes. Chromium
# opens the pages, clicks and presses keys in them (tests/page/drive.js); without Chromium those tests
# are skipped.

load ../ran
load ../page/chromium

hostile='<b>x</b></script><script>alert(1)</script><!--'

# edited PAGE COMMAND...: the page, with its data passed through the command.
edited() {
    sed '/id="data">$/q' "$1"
    data "$1" | "${@:2}" |
        python3 -c 'import base64, sys, zlib; sys.stdout.buffer.write(base64.b64encode(zlib.compress(sys.stdin.buffer.read())))'
    echo
    sed '1,/id="data">$/d' "$1" | sed -n '/^<\/script>/,$p'
}

# hulls: turns the frames of shapes.html into hulls of 9, 5, 5, 2 and 1 vertices: a cube with a vertex
# inside, a square with one inside, a pyramid with a repeated vertex, a segment, a point.
hulls='.shapes |= ([
    [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],[1,1,1],[0.5,0.5,0.5]],
    [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0.5,0.5,0]],
    [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0,0,1]], [[0,0,0],[1,1,1]], [[0,0,0]]]
    | map({dim: 3, frames: [{shape: "hull", vertices: .}]}))'

setup_file() {
    local top fmb logs
    top=$(realpath "$BATS_TEST_DIRNAME/../..")
    fmb=$(realpath "$top/${FMB_BUILD:-build}")/fmb
    logs=$top/tests/logs
    cp "$top"/tests/page/{drive.html,drive.js,tools.js} "$BATS_FILE_TMPDIR"
    cp "$top/clients/demo/table.json" "$BATS_FILE_TMPDIR/table.json"
    cd "$BATS_FILE_TMPDIR" || return
    "$fmb" query --local --gap --point --html table.html table.json > table.said
    edited table.html jq -c 'del(.steps[].pairs[].point)' > pointless.html
    edited table.html jq -c '.steps[].pairs |= map(.bodies |= reverse)' > reversed.html
    "$fmb" query --local --json --html arm.html < "$top/clients/demo/arm.json" > arm.json
    # Every shape, side by side.
    "$fmb" query --local --html shapes.html > shapes.said << 'SCENE'
{"dim": 3, "bodies": [
  {"id": 1, "shape": "box", "size": [1,1,1]},
  {"id": 2, "shape": "cuboid", "position": [2,0,0], "origin": [0,0,0], "components": [[1,0,0],[0.3,1,0],[0,0,1]]},
  {"id": 3, "shape": "tetrahedron", "position": [4,0,0], "origin": [0,0,0], "components": [[1,0,0],[0,1,0],[0,0,1]]},
  {"id": 4, "shape": "face", "position": [6,0,0], "vertices": [[0,0,0],[1,0,0.1],[0.3,1,0.7]]},
  {"id": 5, "shape": "tetrahedron", "position": [8,0,0], "vertices": [[0,0,0],[1,0,0.1],[0.3,1,0.7],[0.1,0.7,1.3]]}]}
SCENE
    edited shapes.html jq -c "$hulls" > hulls.html
    "$fmb" query --local --html round.html > round.said << 'SCENE'
{"dim": 3, "bodies": [
  {"id": 1, "shape": "sphere", "radius": 1},
  {"id": 2, "shape": "capsule", "radius": 0.5, "length": 1, "position": [3,0,0]},
  {"id": 3, "shape": "box", "size": [1,1,1], "radius": 0.125, "position": [6,0,0]},
  {"id": 4, "position": [9,0,0], "velocity": [0,1,0], "frames": [{"shape": "sphere", "radius": 0.25, "position": [0,0,1]},
    {"shape": "tetrahedron", "radius": 0.25, "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}]}]}
SCENE
    # Two equal scenes: a hand has two fingers, and one of them meets a post, far above a large ground.
    hand='{"dim": 3, "duration": 2, "bodies": [
      {"id": 1, "name": "hand", "frames": [{"shape": "box", "size": [1,1,1]}, {"shape": "box", "position": [3,0,0], "size": [1,1,1]}]},
      {"id": 2, "name": "post", "shape": "box", "size": [0.5,0.5,0.5], "position": [3,3,0], "velocity": [0,-2,0]},
      {"id": 3, "name": "ground", "shape": "box", "size": [200,200,1], "position": [0,0,-10]}]}'
    "$fmb" query --local --html frames.html > frames.said <<< "$hand $hand"
    "$fmb" query --local --html disc.html > disc.said << 'SCENE'
{"dim": 2, "bodies": [
  {"id": 1, "shape": "sphere", "radius": 1},
  {"id": 2, "shape": "capsule", "radius": 0.5, "length": 1, "position": [1.5,0]},
  {"id": 3, "shape": "box", "size": [1,1], "radius": 0.125, "position": [0,2.5], "orientation": [2,1]}]}
SCENE
    "$fmb" query --local --html plane.html > plane.said << 'SCENE'
{"dim": 2, "bodies": [
  {"id": 1, "shape": "box", "size": [1,1], "orientation": [2,1], "velocity": [0.5,0]},
  {"id": 2, "shape": "tetrahedron", "position": [1,0], "origin": [0,0], "components": [[1,0],[0,1]]}]}
SCENE
    # Ends: a quaternion of another length, whose negative is nearer, and a position without an orientation.
    "$fmb" query --local --html ends.html > ends.said 2>&1 << 'SCENE' || true
{"dim": 3, "duration": 2, "bodies": [
  {"id": 1, "shape": "box", "size": [2,1,1], "orientation": [3,0,0,4], "end": {"position": [0,0,4], "orientation": [-8,0,0,-1]}},
  {"id": 2, "shape": "box", "size": [2,1,1], "position": [5,0,0], "end": {"position": [5,2,0]}}]}
SCENE
    "$fmb" query --local --html hostile.html - > hostile.said << SCENE
{"dim": 2, "label": "$hostile", "bodies": [{"id": 1, "name": "$hostile", "shape": "box", "size": [1,1]},
  {"id": 2, "name": "\u202e\"'&amp;", "shape": "box", "size": [1,1]}]}
SCENE
    "$fmb" query --local --html empty.html > empty.said <<< '{"dim": 2, "bodies": []}' || true
    for log in stack refused hard-2d hard-3d; do
        "$fmb" replay --html $log.html "$logs/$log.log" > replay.said
    done
    awk -v scenes=1 -f "$top/tests/page/many.awk" | "$fmb" query --local --html many.html > many.said
    # A recording whose last scene says another verdict of its first pair.
    "${fmb%fmb}edit-log" --flip 8 "$logs/crowd.log" crowd.log
    "$fmb" replay --html crowd.html crowd.log > replay.said || true
    edited stack.html jq -c '.steps |= to_entries | .steps |= map(.value + {t: (.value.t + if .key > 20 then 86400 else 0 end)})' > paused.html
    "$fmb" replay --golden "$logs/crowd.golden" --html golden.html "$logs/crowd.log" > replay.said || true
    # The end of an interval that differs beyond six digits.
    "${fmb%fmb}edit-log" --nudge 2 1e-13 "$logs/stack.log" nudged.log
    "$fmb" replay --html nudged.html nudged.log > replay.said || true
    "$fmb" replay --golden "$logs/stack.log" --html other.html "$logs/arm.log" > replay.said 2>&1 || true
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' > b.obj
    "$fmb" mesh --html mesh.html --json b.obj b.obj --translate 1.5,0.1,0.1 --velocity=-1,0,0 > mesh.json
    "$fmb" mesh --html apart.html b.obj b.obj --translate 5,0,0 > apart.said
    # 35 faces through 35 others, of which one pair of a thousand bodies has the last 226.
    awk 'BEGIN { for (i = 0; i < 35; i++) printf "v %g -1 -1\nv %g 40 -1\nv %g -1 40\n", i, i, i
        for (i = 0; i < 35; i++) print "f " 3 * i + 1, 3 * i + 2, 3 * i + 3 }' > plates.obj
    "$fmb" mesh --html plates.html plates.obj plates.obj --rotate z,-90 --scale 1,0.5,1 --translate=-1.5,17.75,0 --json > plates.json
    sed 's/^start();$/start(); start;/' arm.html > changed.html
    sed '/id="data">$/{n;s/^./!/;}' arm.html > cut.html
    ! command -v chromium > /dev/null ||
        "$top/tests/page/browser.py" drive.html 1500 1200 --disable-gpu > found.json 2> browser.said || true
}

setup() {
    cd "$BATS_FILE_TMPDIR" || return
}

# ---- Contents --------------------------------------------------------------------------------

@test "the page is one file that refers to nothing else, with its policy and the licence of three.js" {
    for page in table arm stack mesh; do
        data $page.html | jq -e '.steps | type == "array"' > /dev/null
        is_self_contained $page.html
        has_policy $page.html
        grep -q 'Copyright (c) 2010-2019 three.js authors' $page.html
    done
}

@test "hostile names and labels end neither script nor page" {
    [ "$(grep -c '</script>' hostile.html)" = 2 ]
    [ "$(grep -c '<!--' hostile.html)" = 0 ]
    data hostile.html | jq -e --arg name "$hostile" '.steps[0].bodies[0].name == $name and .steps[0].label == $name'
    found '.hostile | .bold == 0 and (.labels | any(startswith("<b>x</b></script>")))'
}

# Names of bodies stand for the faces of the pairs.
@test "the pairs of a mesh's page are those of the program" {
    jq -c '.pairs[] | ["A \(.[0])", "B \(.[1])", .[2]]' mesh.json | sort > expected
    data mesh.html | jq -c '.steps[0] | .bodies as $bodies | .pairs[] | [$bodies[.bodies[]].name, .verdict]' | sort > held
    diff expected held
    data plates.html | jq -e --slurpfile said plates.json '.steps[0] | ($said[0].pairs | length) > 1000 and (.pairs | length) == 1000
        and ([.bodies[.pairs[999].bodies[]].name] == ["A, others that meet", "B, others that meet"]) and (.more | not)' > /dev/null
    data plates.html | jq -e --slurpfile said plates.json '[.shapes[.steps[0].bodies[].shape].frames | length] | add == 70' > /dev/null
}

# ---- In a browser ----------------------------------------------------------------------------

@test "a recording of other bodies is a note, and the pairs are those of the query" {
    # 10 bodies and 17 pairs, against 16 bodies and 120 pairs.
    data other.html | jq -e '.steps[0] | (.note | startswith("the recording has 16 bodies, the query 10: "))
        and (.result[0].counts | add) == 120 and (.result[1].counts | add) == 17 and .differs' > /dev/null
    data other.html | jq -e '[.steps[].pairs[].bodies[]] | max < 10' > /dev/null
    data other.html | jq -e '[.steps[] | select(.outcome == "no result recorded") | .result | .[0] == null and .[1].counts != null] | length > 0 and all' > /dev/null
}

@test "the pages open without errors" {
    found '.errors == [] and (.console | del(.restored, .network, .broken, .noScene) | length >= 8 and all(.[]; . == []))' \
        '.opened | .scripts == 1 and .resources == 0 and .title == "table.json"'
}

@test "errors in a page are detected" {
    found '.console.broken | any(test("changed.html: .*inline script.*violates")) and any(test("cut.html: .*SyntaxError"))'
}

@test "the page cannot reach the network, nor run foreign scripts" {
    found '.foreign == {directives: ["connect-src", "img-src", "script-src-attr"], title: "standard input"}'
}

@test "a scene opens at the begin of its window, with the answers of the program" {
    found '.opened | .counts == "3 pairs: 1 overlapping, 1 touching, 1 separated" and .text == "0.000 s"
        and .table == ["cube – gripper | overlapping | 1.9 to 2 s | -0.025", "table – cube | touching | 0 to 2 s | 0",
            "table – gripper | separated | 0.025"]'
    found '.opened | .drawn > 40000 and .yellow > 10000 and .red == 0 and .violet > 100' \
        '.opened.widths | length == 5 and all(. >= 90)' \
        '.opened | .lanes == [["separated", "overlapping"], ["touching"], ["separated"]]' \
        '.opened.misplaced == [] and (.opened.labels | sort) == ["cube", "gripper", "table"] and .opened.over[:2] == ["table: touching", "cube: touching"]'
}

@test "each column sorts the pairs, up and down; a pair is named in the order of its ids" {
    found '.reversed == .opened.table' '[.sorts[] | split(",")] as $all | [range(0; 10; 2) | $all[.], ($all[. + 1] | reverse)]
        | map(map({"cube – gripper": 1, "table – cube": 2, "table – gripper": 3}[.]))
        == ([[1, 2, 3], [1, 2, 3], [2, 1, 3], [1, 2, 3], [2, 1, 3]] | map(., .))'
}

@test "frames in contact are red, the other frames of their bodies are not" {
    data frames.html | jq -e '[.steps[].pairs[].frame_contacts | select(.)] == [[[1,0,3,1.125,1.875]], [[1,0,3,1.125,1.875]]]' > /dev/null
    found '.frames.times | map(.fingers | map(.red > 100)) == [[false, false], [false, true], [false, false], [false, true]]' \
        '.frames.times[0] | .red == 0 and all(.fingers[]; .drawn == 144)'
}

@test "contacts are given in clock time" {
    found '.frames.times | map(.moment.text[:7]) == ["0.000 s", "1.250 s", "2.000 s", "3.250 s"]' \
        '[.frames.times[].table[0]] == ([range(2) | "hand – post | overlapping | 1.125 to 1.875 s"] + [range(2) | "hand – post | overlapping | 3.125 to 3.875 s"])' \
        '.frames.next.text == "3.125 s · step 2 of 2"'
}

@test "the lane of a pair has no holes" {
    found '.frames.lane == ["separated", "overlapping", "separated", "overlapping", "separated"]'
}

# Without the ground, which is 283 long, the scene is about 8 long.
@test "a body ten times larger than all others does not determine the view" {
    found '.frames.radius | . > 3 and . < 6'
}

@test "axes and a scale are drawn, in the unit of the scene" {
    found '.frames.scale, .round.scale | .drawn > 100 and (.bar - .said * .unit | fabs) < 3 and .bar > 38 and .bar < 103'
}

@test "the next contact is red, and has the numbers of the answer" {
    found '.contact.text == "1.900 s" and .contact.hash == "#t=1.9" and .contact.red > 1000
        and .nextContact.text == "0.000 s"'
    found '.opened.facts | .pair == "cube – gripper" and .["box z"] == "0.475 to 0.5" and .gap == "-0.025"'
}

@test "each contact has a mark at its point, which is listed" {
    data table.html | jq -e '[.steps[0].pairs[].point | select(.)] | length == 2'
    found '.opened.violet > .pointless.violet + 40' \
        '(.opened.facts.point | test("^\\(0\\.[0-9]+, -?[0-9.]+, 0\\.4[0-9]+\\) at 1\\.9[0-9]* s$")) and .pointless.facts.point == null'
}

@test "the chosen pair has a line between its nearest points" {
    found '.gap.chosen == ["table – gripper"] and .gap.blue > .opened.blue + 10'
}

@test "a scene plays over its window, stops, loops, and is scrubbed and linked to" {
    found '.playing == "❚❚" and .played.button == "▶" and .played.text == "2.000 s" and .played.red > 1000' \
        '(.played.places[2][2] - .opened.places[2][2] + 0.5 | fabs) < 0.001 and .played.places[0] == .opened.places[0]' \
        '.looped' \
        '.scrubbed.text == "1.000 s" and (.scrubbed.places[2][2] - .opened.places[2][2] + 0.25 | fabs) < 0.001' \
        '.linked == "0.500 s"'
}

@test "views and colours change, the mouse turns the scene, the pointer names a body" {
    found '[.opened, .byBody, .top, .pair, .turned] | map(.sum) | unique | length == 5' \
        '.pair.drawn != .top.drawn and (.pointed | test("^(cube|gripper|table)(: (touching|overlapping))?$"))'
}

@test "the mouse turns the scene about the vertical" {
    found '.orbit | (.before[2] - .after[2] | fabs) < 1e-6 and (.before[0] - .after[0] | fabs) > 0.05'
}

@test "what moves is drawn with fewer pixels where frames take long, and at rest with all of them" {
    found '.pace == [1, 1, 1, 0.75, 0.5, 0.5, 0.5, 0.75, 0.5, 0.5, 0.75, 1]' \
        '[.slow, .turning] | all(.scale == 0.5 and (.drawn - 0.5 | fabs) < 0.01)' \
        '[.rested, .turnedSlow] | all(.scale == 1 and (.drawn - 1 | fabs) < 0.01)'
}

@test "every shape is drawn, hulls too" {
    found '.shapes | .kinds == [12, 12, 4, 1, 4] and .drawn > 2000 and .bad == 0 and (.table | length) == 10' \
        '.hulls | .kinds == [[12, 12], [2, 4], [4, 6], [0, 1], [0, 0]] and .drawn > 2000'
    # Area, length of the edges, and ends on each axis.
    found '.shapes.surfaces == [[6, 12, [-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5]], [6.088, 12.176, [0, 1.3], [0, 1], [0, 1]],
            [2.366, 7.243, [0, 1], [0, 1], [0, 1]], [0.604, 3.622, [0, 1], [0, 1], [0, 0.7]], [2.243, 7.457, [0, 1], [0, 1], [0, 1.3]]]' \
        '.hulls.surfaces == [[6, 12, [0, 1], [0, 1], [0, 1]], [1, 4, [0, 1], [0, 1], [0, 0]], .shapes.surfaces[2],
            [0, 1.732, [0, 1], [0, 1], [0, 1]], [0, 0, [0, 0], [0, 0], [0, 0]]]' \
        '.plane.surfaces == [[1, 4, [-0.5, 0.5], [-0.5, 0.5], [0, 0]], [0.5, 3.414, [0, 1], [0, 1], [0, 0]]]'
}

# Areas are a little less than those of the round shapes: 4 pi, 2 pi, 6 + 12 edges * pi / 16 + pi / 16; in 2D pi,
# 1 + pi / 4, 1.5 + pi / 64.
@test "shapes with a radius are drawn round" {
    found '.round.surfaces | map(.[2:]) == [[[-1, 1], [-1, 1], [-1, 1]], [[-0.5, 0.5], [-0.5, 0.5], [-1, 1]],
            [[-0.625, 0.625], [-0.625, 0.625], [-0.625, 0.625]], [[-0.25, 1.25], [-0.25, 1.25], [-0.25, 1.25]]]' \
        '.round.surfaces | map(.[0]) | .[0] > 12.4 and .[0] < 12.567 and .[1] > 6.2 and .[1] < 6.284 and .[2] > 8.4 and .[2] < 8.552' \
        '.disc.surfaces | map(.[2:4]) == [[[-1, 1], [-1, 1]], [[-0.5, 0.5], [-1, 1]], [[-0.625, 0.625], [-0.625, 0.625]]]' \
        '.disc.surfaces | map(.[0]) | .[0] > 3.13 and .[0] < 3.142 and .[1] > 1.78 and .[1] < 1.786 and .[2] > 1.53 and .[2] < 1.55' \
        '.round.facing | .drawn == 256 and .shades > 15' \
        '[.round, .disc] | all(.bad == 0 and .drawn > 2000) and .[1].yellow > 100'
}

# In the middle, q = (3,0,0,4) + (8,0,0,1) = (11,0,0,5), which turns the axis x to (121 - 25, 2 * 11 * 5) / 146.
@test "a turning body is drawn in the pose of fmb_pose_at()" {
    data ends.html | jq -e '.steps[0].bodies | map(.end) == [{position: [0,0,4], orientation: [-8,0,0,-1]}, {position: [5,2,0]}]' > /dev/null
    found '.ends | length == 3 and .[1].text == "1.000 s" and map(.places) == [[[0, 0, 0], [5, 0, 0]], [[0, 0, 2], [5, 1, 0]], [[0, 0, 4], [5, 2, 0]]]' \
        '.ends | map(.turn) == [[-0.28, 0.96], [0.658, 0.753], [0.969, 0.246]]'
}

@test "two dimensions are seen from above" {
    found '.plane | .direction == [0, 0, -1] and .kinds == [2, 1] and .red > 1000'
}

@test "scenes follow each other, filtered, sorted, in contact only" {
    found '.arm.counts == "6 scenes · 42 pairs: 3 overlapping, 5 touching, 34 separated" and .arm.last.text == "1.250 s · step 6 of 6"'
    count=$(jq -s '[.[].pairs[] | [.a, .b]] | unique | length' arm.json)
    found "(.arm.rows | length) == $count and .contacts == {rows: 8, said: \"8 of $count pairs\"}" \
        '.filtered | .rows == 1 and .said == "1 of 42 pairs" and (.first | contains("lid"))' \
        '.sorted | .first < .last and .down == .last' \
        '.arm.widths | length == 6 and (unique | length) == 1' \
        '.arm.lane == ["separated", "overlapping", "separated"]'
}

@test "the scene is drawn in every frame of a window that is resized, light and dark, wide and narrow" {
    found '.screenshots | map([.scheme] + .size) == ([["dark", "light"], [[1400, 900], [1100, 620], [390, 800]]] | [combinations | flatten])' \
        '.screenshots | all(.painted.drawn > 30000 and .painted.yellow > 25000 and .seen.yellow > 25000)'
}

@test "the scene is drawn again when the GPU was reset" {
    found '.restored.drawn == .opened.drawn and .restored.yellow == .opened.yellow'
}

@test "labels overprint neither each other nor bodies in front of their own" {
    found '.arm.misplaced == [] and .many.misplaced == [] and .many.labels > 10 and .narrow.misplaced == [] and all(.frames.times[]; .misplaced == [])'
    found '.arm.overprints == [0, 0, 0, 0, 0] and .crowd.overprints == 0 and .narrow.overprints == 0'
}

@test "scene, table and time are in view at 1400 x 900, and nothing is wider than 390" {
    found '.scrolls <= 900 and (.wide | all(. <= 900)) and .narrow.width <= 390 and .narrow.stage > 300'
}

@test "a recording plays queries that alternate together, with the gap over time" {
    found '.stack.bodies == [16, 16, 16, 16, 16, 16, 16, 16] and .stack.lane == ["overlapping"]' \
        '.stack.gap and .stack.gapSaid == "gap of 1 – 12: -0.208034 to -0.146024, in the scene'"'"'s unit of length, over time; dashed: the margin" and .stack.plot.dark > 300 and .stack.plot.blue > 1000' \
        '(.stack.facts.query | startswith("event 0 at byte 0 of ")) and (.stack.facts["answered again"] | startswith("119 separated, 1 overlapping, by certified"))'
}

@test "a long pause is shortened, and times stay those of the log" {
    found '.paused.span < 10 and (.paused.end | startswith("86400."))'
}

@test "differences are marked, and name both recordings" {
    found '.crowd | .different == 1 and (.counts | endswith("1 different")) and .rows == 100 and .more == 200 and (.notes | contains("left out"))' \
        '.difference | (.text | contains("step ")) and (.facts.query | endswith(": different")) and (.lane | index("difference")) != null' \
        '.golden | (.title | test("/crowd.log, answered again, compared with .*/crowd.golden$")) and (.facts | keys | any(endswith("crowd.golden")))'
}

@test "a number that differs beyond the digits of a fact has its name and all digits" {
    found '.nudged | .text[:7] == "0.010 s" and (.facts | .contact == "0.01 to 0.02 s" and (has("first contact in the window") or has("gap, upper bound") | not))' \
        '.nudged.facts["last contact in the window"] == "the recording: 0.0100000000001 · answered again: 0.01"'
}

@test "bodies that cannot be drawn, and refusals, are reported" {
    found '.refused | .bad == 0 and .missing > 0 and (.outcomes | length) > 10'
}

@test "numbers of all sizes are drawn" {
    # Bodies may be smaller than a pixel beside each other: then their names show where they are.
    found '.sizes | length > 100 and all(.bad == 0 and (.drawn > 100 or .labels > 0)) and (map(select(.drawn > 100)) | length) > 0.7 * length'
}

@test "faces of meshes that meet are red, and a pair is shown from near" {
    pairs=$(jq '.pairs | length' mesh.json)
    found ".mesh | (.rows | length) == $pairs and .moving.red + .moving.yellow > 1000" \
        '(.face.facts.pair | test("^A [0-3] – B [0-3]$")) and .moved.sum != .mesh.sum and .moved.text == "1.000 s"' \
        '.apart | .drawn > 10000 and .red == 0 and .rows == 0'
}

@test "without WebGL table and timeline remain, and one line says so" {
    found '.none | .stage and (.said | startswith("This browser has no WebGL")) and (.rows | length) == 42
        and (.lane | index("overlapping")) and (.next.text | contains("step"))'
}

@test "the dark colour scheme is followed" {
    found '.dark.ground == "rgb(20, 23, 27)" and .dark.drawn > 40000'
}
