# The page of a replay: its contents, and what a browser shows. Chromium opens the pages, clicks and
# presses keys in them (tests/page/drive.js); without Chromium those tests are skipped.

bats_require_minimum_version 1.5.0

load ../page/chromium

setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    for page in mixed arm many crowd uneven empty; do
        "${FMB_BUILD:-build}/make-page" $page > "$BATS_FILE_TMPDIR/$page.html"
    done
    cp tests/page/drive.html tests/page/drive.js tests/page/tools.js "$BATS_FILE_TMPDIR"
    cd "$BATS_FILE_TMPDIR" || return
    sed 's/^start();$/start(); start;/' arm.html > changed.html
    sed 's/"pairs":.*/"pairs":[/' arm.html > cut.html
    command -v chromium > /dev/null || return 0
    as_chromium light 1 &
    light=$!
    as_chromium dark 0
    wait $light
}

setup() {
    local top
    top=$(realpath "$BATS_TEST_DIRNAME/../..")
    fmb=$top/${FMB_BUILD:-build}/fmb
    logs=$top/tests/logs
    cd "$BATS_FILE_TMPDIR" || return
}

# ---- Contents --------------------------------------------------------------------------------

@test "the page is one file that refers to nothing else" {
    for page in mixed arm many crowd uneven empty; do
        data $page.html | jq -e '.events | type == "array"' > /dev/null
        is_self_contained $page.html
    done
}

@test "the policy of the page permits its own script and style only" {
    has_policy arm.html
}

@test "hostile strings end neither script nor page" {
    [ "$(grep -c '</script>' mixed.html)" = 2 ]
    [ "$(grep -c '<!--' mixed.html)" = 0 ]
    data mixed.html | jq -e '.title | startswith("</title></script><script>throw")'
    data mixed.html | jq -e '.logs == ["drive.log", "other ä </script>.log"]'
}

# ---- In a browser ----------------------------------------------------------------------------

@test "the page opens without errors" {
    found light '.done and .error == null'
    [ ! -s light.console ] || {
        cat light.console
        return 1
    }
    found light '.opened | .scripts == 2 and .bold == 0 and .resources == 0
        and (.title | startswith("Replay: </title></script>"))
        and .counts == ["56", "49", "3", "1", "1", "1", "1"]'
}

@test "errors in a page are detected" {
    found dark '.done'
    grep -q 'inline script.*violates.*source: .*changed.html' dark.console
    grep -q 'Uncaught SyntaxError.*source: .*cut.html' dark.console
}

@test "the page cannot reach the network, nor run foreign scripts" {
    found dark '.refused.directives == ["connect-src", "img-src", "script-src-attr"]'
    found dark '.refused.title | startswith("Replay: ")'
}

@test "rows with differences come first, then those in contact" {
    found light '.opened.labels[1:6] == ["anonymous – anonymous", "anonymous – 32", "3 – 4", "1 – 2", "7 – 8"]'
    found light '.filled == ["separated", "overlapping"]'
}

@test "a click on a mark shows its query in two dimensions" {
    found light '.clicked | .pair == ["1 – 2"] and .verdict == ["overlapping"] and .scene == "Scene, 2D"
        and .lane == ["1 2"] and .hash == "#0:31" and .query == "Query 31"'
    found light '.clicked | .drawn > 10000 and .red > 3000 and .violet > 300'
    found light '.moved.sum != .clicked.sum and .zoomed.red > 1.5 * .moved.red'
}

@test "a gap has its size, and a line between the nearest points" {
    found light '.gap | .verdict == ["separated"] and .texts[:3] == ["pair", "verdict", "gap"]
        and (.texts[3] | tonumber) > 0.1 and .blue > 20'
    found light '.clicked.blue == 0'
}

@test "the body below the pointer is named" {
    found light '.pointed == ["body 1, parallelogram: overlapping", "body 2, triangle: overlapping"]'
}

@test "the arrow keys step through the queries" {
    found light '.right.query == "Query 33" and .left.query == "Query 31"'
}

@test "a difference is reached by the key d, by its flag and by the list" {
    found light '.opened.flags == 2 and .opened.listed == 3'
    found light '.opened.chosen | .query == "Query 65" and .outcome == "≠ different"'
    found light '[.next, .flag] | all(.query == "Query 65" and .outcome == "≠ different"
        and .verdict == ["touching", "overlapping"] and .pair == ["≠3 – 4"])'
    found light '.next.changes | contains("verdicttouchingoverlapping")
        and contains("0.357143 .. 0.6785710.357143 .. 1") and contains("box x0.428571 .. 0.9642860.428571 .. 1.5")'
    found light '.next.words | contains("verdict touching → overlapping")'
    found light '.around.query == "Query 107" and .listed.query == "Query 69"'
}

@test "scenes in three dimensions turn, show the view from above, the end of the window and both boxes" {
    found light '.space | .drawn > 10000 and .red > 3000 and .violet > 300 and .pink > 300'
    found light '[.space, .turned, .above, .slid] | map(.sum) | unique | length == 4'
    found light '.slid | .said == "1 s of 1 s" and .bands == 2 and .then == 1'
}

@test "a scene lists its pairs, one of them selected" {
    found light '.scene | .pair == ["≠1 – 13", "≠2 – 11", "11 – 12", "12 – 13"] and .drawn > 10000'
    found light '.other.pressed == ["11 – 12"] and .other.sum != .scene.sum and .near.red > .other.red'
    found light '.playing == "❚❚"'
}

@test "numbers of all sizes are drawn" {
    found light '.sizes | length == 20 and all(.bad == 0)'
    found light '.sizes | map(select(.query != "Query 83") | .drawn) | min > 10000'
    found light '.sizes[] | select(.query == "Query 83") | .drawn > 300' # of no size
    found light '.many.bad == 0 and .crowd.bad == 0'
}

@test "bodies that cannot be drawn are reported" {
    found light '.sizes[] | select(.query == "Query 101") | .outcome == "not defined" and .missing
        == ["not drawn: body 8: the log does not define its handle, 47474747474747474747474747474747"]'
    found light '.sizes[] | select(.query == "Query 103")
        | .missing == ["not drawn: body 7: it is no body that can be drawn"]'
}

@test "bodies by handle are drawn by their definitions" {
    found light '.sizes[] | select(.query == "Query 99") | .outcome == "unknown body"
        and .missing == [] and .verdict == ["overlapping"]'
    found light '.crowd.missing == []'
}

# The first half defined the bodies: log cut puts their definitions before the second half.
@test "a part of a log shows the bodies that its definitions describe" {
    "$fmb" log cut --from 1.5 --output part.log "$logs/clients.log"
    "$fmb" replay --html part.html part.log > part.said
    data part.html > part.json
    jq -e '.count == [17, 0, 0, 12, 0, 0] and (.events | length) == 29
        and all(.events[].frames[]; .[0] > 0 and .[1] >= 0)' part.json
}

@test "the filter, more rows and zooming work" {
    found light '.filtered.rows == ["all queries", "3 – 4"] and .filteredPair == .filtered.rows'
    found light '.filteredNone == {rows: 1, said: "no pair with it"} and .more == [9, 20]'
    found light '.zoom | .near and .dragged and .back'
}

@test "large and empty logs are drawn: omitted queries, a pause, a crowd, no query" {
    found light '.many | .counts[0] == "5,700" and .rows == 9 and .leftOut == 1
        and .folds == ["24 h without queries"] and .more == "show 40 more of 90 pairs"'
    found light '.many.note | startswith("699 queries are counted, but not shown, from 86474.985 to 86485.470 s.")
        and contains("all of them are here")'
    found light '.crowd | .drawn > 50000 and .rows == 30
        and (.notes | contains("The answers are those of the pairs 0 to"))'
    found light '.crowdMore == 230 and .empty == {said: "No query was replayed.", hidden: true}'
}

@test "bars have no holes where steps are uneven, and end where results stop coming" {
    found light '.uneven.titles | .[0] == "overlapping, 334 queries from 0.000 s" and length == 6'
}

@test "texts on the axis do not overlap" {
    found light '.uneven | .texts > 0 and (.overprints | length == 41 and all(. == 0))'
}

@test "the scene and its controls are in view at 1400 x 900" {
    found light '.foldHidden == false and (.fold | length == 3 and all(. <= 900))'
}

@test "the dark color scheme is followed" {
    found dark '.dark.ground == "rgb(20, 23, 27)" and .dark.drawn > 10000'
    found dark '.dark.sum != 0'
}
