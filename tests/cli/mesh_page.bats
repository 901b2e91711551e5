# The page of meshes that meet: what it holds, and what a browser shows of it. Chromium opens it,
# clicks and presses keys in it (tests/page/drive_mesh.js); without Chromium these tests are skipped.

bats_require_minimum_version 1.5.0

load ../page/chromium

hostile='</script><script>throw 1;<!--'

# tetrahedron FILE: four faces, at the origin.
tetrahedron() {
    printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1' > "$1"
    printf 'f %s\n' '1 3 2' '1 2 4' '1 4 3' '2 3 4' >> "$1"
}

# page NAME ARGUMENTS: writes NAME.html, and the program's result to NAME.json.
page() {
    "$fmb" mesh --json --html "$1.html" "${@:2}" > "$1.json"
}

setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    local build=${FMB_BUILD:-build}
    fmb=$PWD/$build/fmb
    "$build/mesh/make-mesh" --faces 200 "$BATS_FILE_TMPDIR/a.ply"
    "$build/mesh/make-mesh" --faces 200 --seed 2 "$BATS_FILE_TMPDIR/b.ply"
    "$build/mesh/make-mesh" --faces 2000 "$BATS_FILE_TMPDIR/same.ply"
    cp tests/page/drive_mesh.html tests/page/drive_mesh.js tests/page/tools.js "$BATS_FILE_TMPDIR"
    cd "$BATS_FILE_TMPDIR" || return
    mkdir -p "x$hostile"
    tetrahedron corner.obj
    tetrahedron "x$hostile/\"q'.obj"
    printf 'ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n' > none.ply
    page small a.ply b.ply --translate 1.3,0.4,0.2
    page touching corner.obj "x$hostile/\"q'.obj" --translate 1,0,0
    page moving a.ply --velocity 1,0,0 b.ply --translate 2.6,0.4,0.2
    page self --self a.ply
    page empty none.ply none.ply
    page large same.ply same.ply
    page huge --scale 1e300 a.ply b.ply --translate 1.3e300,0,0
    page tiny --scale 1e-300 a.ply b.ply --translate 1.3e-300,0,0
    command -v chromium > /dev/null || return 0
    as_chromium meshes 1 drive_mesh.html
}

setup() {
    fmb=$(realpath "$BATS_TEST_DIRNAME/../../${FMB_BUILD:-build}/fmb")
    cd "$BATS_FILE_TMPDIR" || return
}

# ---- What it holds ---------------------------------------------------------------------------

@test "the page is one file that refers to nothing else and runs nothing else" {
    for page in small touching moving self empty large; do
        data $page.html | jq -e '.pairs | type == "array"' > /dev/null
        is_self_contained $page.html
    done
    has_policy small.html
}

@test "hostile names end neither script nor page" {
    [ "$(grep -c '</script>' touching.html)" = 2 ]
    [ "$(grep -c '<!--' touching.html)" = 0 ]
    data touching.html | jq -e --arg name "x$hostile/\"q'.obj" '.meshes[1].name == $name'
}

@test "the pairs of the page are those of the program" {
    for page in small touching moving; do
        data $page.html | jq -c '[.count, .overlapping, .touching, .pairs]' > held
        jq -c '[.overlapping + .touching, .overlapping, .touching,
            [.pairs[] | [.[0], .[1], (if .[2] == "overlapping" then 3 else 2 end)] + (.[3] // [])]]' \
            $page.json > expected
        [ "$(jq '.[0]' expected)" -gt 0 ]
        diff expected held
    done
}

# numbers PAGE WHICH MEMBER FORMAT: what is packed, a row each.
numbers() {
    data "$1.html" | jq -r ".meshes[$2].$3" | base64 -d | od -An -v -t "$4" -w"$5" |
        sed 's/^ *//; s/  */ /g'
}

@test "the page has the faces, their colours and their rounded vertices" {
    [ "$(numbers small 1 face u4 12 | wc -l)" = 200 ]
    [ "$(numbers touching 1 colour u1 1 | wc -l)" = 4 ]
    data small.html | jq -r '.pairs[][1]' | sort -un > met
    numbers small 1 colour u1 1 | awk '$1 == 3 { print NR - 1 }' > coloured
    diff met coloured
    # The third corner of the last face, from the file and from the page.
    face=$(tail -n 1 b.ply | cut -d ' ' -f 4)
    vertex=$(sed '1,/end_header/d' b.ply | sed -n "$((face + 1))p")
    place=$(numbers small 1 face u4 12 | tail -n 1 | cut -d ' ' -f 3)
    numbers small 1 corner f4 12 | sed -n "$((place + 1))p" > corner
    data small.html | jq -r '"\(.centre | join(" ")) \(.exponent)"' >> corner
    echo "$vertex" | awk '
        NR == FNR && FNR == 1 { for (i = 1; i <= 3; i++) at[i] = $i; next }
        NR == FNR { for (i = 1; i <= 3; i++) at[i] = $i + 2 ^ $4 * at[i]; next }
        { split("1.3 0.4 0.2", by)
          for (i = 1; i <= 3; i++) { off = at[i] - $i - by[i]; if (off > 1e-6 || off < -1e-6) exit 1 } }' corner -
}

@test "the list is bounded, and omitted pairs are counted" {
    data large.html | jq -e '.count > 20000 and (.pairs | length) == 20000'
}

@test "a file that cannot be written is reported" {
    run -1 --separate-stderr "$fmb" mesh --html missing/x.html a.ply b.ply
    [[ $stderr == "fmb: missing/x.html: "* ]]
}

# ---- In a browser ----------------------------------------------------------------------------

@test "the page opens without errors" {
    found meshes '.done and .error == null'
    [ ! -s meshes.console ] || {
        cat meshes.console
        return 1
    }
    found meshes '.opened | .scripts == 2 and .resources == 0 and .title == "a.ply and b.ply"'
}

# counts PAGE: as they stand in the head of a page.
counts() {
    jq -c '[.overlapping + .touching, .overlapping, .touching | tostring]' "$1.json"
}

@test "the counts of the page are those of the program" {
    found meshes ".opened.counts == $(counts small) and .touch.counts == $(counts touching)"
    found meshes ".moving.counts == $(counts moving) and .self.counts == $(counts self)"
    found meshes ".opened.facts == \"A a.ply: $(jq .faces_a small.json) of 200 faces meet\" +
        \"B b.ply: $(jq .faces_b small.json) of 200 faces meet\" or (.opened.facts | error)"
}

@test "overlapping faces are red, touching ones yellow, others of the second mesh blue" {
    found meshes '.opened | .drawn > 50000 and .red > 3000 and .yellow < 50 and .blue > 10000'
    found meshes '.touch | .yellow > 10000 and .red < 50 and .notes == []'
    found meshes '.self | .red < 50 and .yellow < 50 and .drawn > 50000'
}

@test "a click on a pair selects it and moves the camera to it" {
    name=$(jq -r '.pairs[2] | "A \(.[0]) – B \(.[1])"' small.json)
    next=$(jq -r '.pairs[3] | "A \(.[0]) – B \(.[1])"' small.json)
    found meshes ".clicked | .row == [\"$name\"] and .said == \"$name: overlapping\""
    found meshes '.clicked.red > .opened.red and .clicked.sum != .opened.sum'
    found meshes ".next.row == [\"$next\"] and .none.row == [] and .back.sum == .opened.sum"
    face=$(jq -r '.pairs[2][0] | "A \(.): overlapping, "' small.json)
    found meshes ".pointed | any(startswith(\"$face\"))"
}

@test "mouse, wheel and keys turn the view, and y may be up" {
    found meshes '[.opened, .turned, .zoomed, .keys, .up] | map(.sum) | unique | length == 5'
    found meshes '.zoomed.blue > 1.2 * .turned.blue'
}

@test "the list is sorted by face or by verdict" {
    found meshes '.filtered.names | length > 0 and all(test("\\b3\\b"))'
    count=$(jq '[.pairs[] | select(.[0] == 3 or .[1] == 3)] | length' small.json)
    found meshes ".filtered.said == \"$count of $(jq '.pairs | length' small.json) pairs\""
    found meshes '.touching == 0 and .all == (.opened.rows)'
}

@test "a hostile name is shown verbatim" {
    found meshes ".touch.title == \"corner.obj and \\\"q'.obj\" and (.touch.facts | contains(\"x$hostile/\"))"
}

@test "the time slider moves a mesh, and the faces in contact are red" {
    found meshes '.moving.moment | startswith("0.731051 s of 1 s")'
    found meshes '.moving.bands == 1 and .before.moment == "0 s of 1 s" and .after.moment == "1 s of 1 s"'
    found meshes '.before.red < 50 and .after.red > 3000 and .before.sum != .after.sum'
    found meshes '.after.grey > .before.grey + 50'
    first=$(jq -r '.pairs[0][3][0]' moving.json)
    found meshes ".movingPair.moment | startswith(\"$(printf %.6g "$first") s\")"
    found meshes ".movingPair.times | startswith(\"$(printf %.6g "$first") .. \")"
    found meshes '.playing == "❚❚"'
}

@test "large and empty meshes and numbers of all sizes are drawn" {
    found meshes '.large | .notes == ["The list has the first 20,000 of " + .counts[0]
        + " pairs; the program tells them all."] and .rows == 100 and .then == 200 and .red > 10000'
    found meshes '.empty | .counts == ["0", "0", "0"] and .list == "No faces meet." and .rows == 0'
    found meshes '[.huge, .tiny] | all(.drawn > 50000 and .red > 3000)'
}
