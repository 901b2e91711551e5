# fmb mesh: what is typed, what is printed, exit codes. What is true of meshes is tested in
# tests/unit/test_mesh_intersect.c.

load ../ran

setup() {
    local build=${FMB_BUILD:-build}
    cd "$BATS_TEST_DIRNAME/../.." || return
    FMB=$(realpath "$build")/fmb
    MAKE_MESH=$TOOLS/mesh/make-mesh
    cd "$BATS_TEST_TMPDIR" || return
    # A triangle; one through it, and one that touches it in a vertex.
    obj a.obj '0 0 0' '1 0 0' '0 1 0' -- '1 2 3'
    obj b.obj '0.25 0.25 -1' '0.25 0.25 1' '0.25 5 0' '0 0 0' '-1 0 0' '0 0 -1' -- '1 2 3' '4 5 6'
}

# obj FILE VERTEX... -- FACE...
obj() {
    local file=$1 kind=v
    shift
    : > "$file"
    for line; do
        if [ "$line" = -- ]; then kind=f; else echo "$kind $line" >> "$file"; fi
    done
}

mesh() {
    run --separate-stderr "$FMB" mesh "$@"
}

# answers JSON ARGUMENTS...
answers() {
    local expected=$1
    shift
    mesh --json "$@"
    ended 0
    said ''
    is "$expected"
}

# cannot_read TEXT ARGUMENTS...
cannot_read() {
    local text=$1
    shift
    mesh "$@"
    ended 2
    is ''
    said "fmb: $text"
}

nothing='{"overlapping": 0, "touching": 0, "faces_a": 0, "faces_b": 0, "pairs": []}'

# ---- Answers ---------------------------------------------------------------------------------

# bats test_tags=release
@test "JSON is one line with the counts and the pairs in order" {
    answers '{"overlapping": 1, "touching": 1, "faces_a": 1, "faces_b": 2, "pairs": [[0, 0, "overlapping"], [0, 1, "touching"]]}' a.obj b.obj
    answers '{"overlapping": 1, "touching": 1, "faces_a": 2, "faces_b": 1, "pairs": [[0, 0, "overlapping"], [1, 0, "touching"]]}' b.obj a.obj
    answers "$nothing" a.obj b.obj --translate 0,0,5
    [ "$(wc -l <<< "$output")" = 1 ]
}

# bats test_tags=release
@test "the output as text is a summary" {
    mesh a.obj b.obj
    ended 0
    said ''
    is '             2  pairs of faces meet:
             1  overlap
             1  touch
in them are
             1  of 1 faces of a.obj
             2  of 2 faces of b.obj'
}

# bats test_tags=release
@test "moving meshes have the contact interval of each pair, and the first and the last time" {
    answers '{"overlapping": 1, "touching": 1, "faces_a": 1, "faces_b": 2, "pairs": [[0, 0, "overlapping", [0.5, 2]], [0, 1, "touching", [1.5, 2]]]}' \
        a.obj --translate 0,0,1.5 --velocity 0,0,-1 b.obj --duration 2
    mesh a.obj --translate 0,0,1.5 --velocity 0,0,-1 b.obj --duration 2
    ended 0
    [ "${lines[-1]}" = 'faces meet first at 0.5 s, and last at 2 s' ]
    # A window of no length; a velocity of 0; nothing meets, and there are no times.
    answers '{"overlapping": 1, "touching": 1, "faces_a": 1, "faces_b": 2, "pairs": [[0, 0, "overlapping", [0, 0]], [0, 1, "touching", [0, 0]]]}' \
        a.obj b.obj --velocity 1,1,1 --duration 0
    answers '{"overlapping": 1, "touching": 1, "faces_a": 1, "faces_b": 2, "pairs": [[0, 0, "overlapping", [0, 1]], [0, 1, "touching", [0, 1]]]}' \
        a.obj b.obj --velocity 0,0,-0
    answers "$nothing" a.obj b.obj --translate 0,0,5 --velocity 0,0,1
    mesh a.obj b.obj --translate 0,0,5 --velocity 0,0,1
    ended 0
    [[ $output != *'first at'* ]]
}

@test "the nearest doubles decide: a tenth three times is not three tenths" {
    obj low.obj '0 0 0.1' '1 0 0.1' '0 1 0.1' -- '1 2 3'
    obj high.obj '0 0 0.3' '1 0 0.3' '0 1 0.3' -- '1 2 3'
    answers "$nothing" low.obj --scale 1,1,3 high.obj
    answers '{"overlapping": 1, "touching": 0, "faces_a": 1, "faces_b": 1, "pairs": [[0, 0, "overlapping"]]}' \
        high.obj --scale 1,1,1 high.obj
}

# bats test_tags=release
@test "an empty mesh intersects nothing" {
    printf 'ply\nformat ascii 1.0\nend_header\n' > empty.ply
    printf 'solid nothing\nendsolid nothing\n' > empty.stl
    for empty in empty.ply empty.stl; do
        answers "$nothing" $empty b.obj
        answers "$nothing" b.obj $empty
        answers "$nothing" $empty $empty --velocity 1,0,0
        mesh $empty b.obj
        ended 0
        is "             0  pairs of faces meet:
             0  overlap
             0  touch
in them are
             0  of 0 faces of $empty
             0  of 2 faces of b.obj
only surfaces are compared: one mesh may lie inside the other"
    done
}

# ---- Where meshes are --------------------------------------------------------------------------

meets() {
    mesh --json "$@"
    ended 0
    jq -e '.overlapping + .touching > 0' <<< "$output" > /dev/null
}

apart() {
    mesh --json "$@"
    ended 0
    jq -e '.overlapping + .touching == 0' <<< "$output" > /dev/null
}

@test "steps apply to the file before them, or to both" {
    meets a.obj a.obj
    apart a.obj --translate 0,0,1 a.obj
    apart a.obj a.obj --translate 0,0,1
    meets a.obj --translate 0,0,1 a.obj --translate 0,0,1
    meets --translate 0,0,1 a.obj a.obj
    meets --translate 0,0,1 a.obj a.obj --translate 1,0,0
    apart --json --velocity 0,0,1 a.obj a.obj --translate 0,0,1
    meets a.obj --velocity 0,0,1 a.obj --translate 0,0,1
    apart a.obj a.obj --velocity 0,0,1 --translate 0,0,1
    meets a.obj a.obj --velocity 0,0,1 --velocity 0,0,-1 --translate 0,0,1 # the last one counts
    meets -- a.obj b.obj
}

# bats test_tags=release
@test "steps are applied in the order of the command line" {
    obj point.obj '8 1 0' '8 1 0' '8 1 0' -- '1 1 1'
    obj from.obj '1 2 0' '1 2 0' '1 2 0' -- '1 2 3'
    meets from.obj --rotate z,90 --translate 10,0,0 point.obj
    apart from.obj --translate 10,0,0 --rotate z,90 point.obj
    meets from.obj --translate 10,0,0 --rotate z,90 point.obj --translate -10,10,0
    meets from.obj --scale 2 point.obj --translate -6,3,0
    meets from.obj --scale 2,0.5,7 point.obj --translate -6,0,0
    meets from.obj --scale -1,-1,1 --rotate z,-180 point.obj --translate -7,1,0
    meets --rotate x,90 from.obj --rotate x,-90 point.obj --rotate x,270 --translate -7,1,0
}

# bats test_tags=release
@test "more than 32 steps for a mesh are refused" {
    steps=$(printf -- '--scale 1 %.0s' $(seq 32))
    # shellcheck disable=SC2086
    meets a.obj a.obj $steps
    # shellcheck disable=SC2086
    meets a.obj $steps a.obj $steps
    # shellcheck disable=SC2086
    wrong mesh a.obj a.obj $steps --scale 1
}

@test "coordinates beyond the largest double are reported" {
    cannot_read 'a.obj: vertex 1 is farther out than edges in doubles go: scale the mesh' a.obj --scale 1e308 b.obj
    cannot_read 'b.obj: vertex 2 is farther out than edges in doubles go: scale the mesh' a.obj b.obj --scale 8e307
    meets a.obj --scale 8e307 a.obj
}

# ---- Files -------------------------------------------------------------------------------------

@test "unreadable and broken files are reported with the place" {
    cannot_read 'no.obj: No such file or directory' no.obj b.obj
    cannot_read 'no.obj: No such file or directory' a.obj no.obj
    cannot_read "$BATS_TEST_TMPDIR: a folder, not a file" a.obj "$BATS_TEST_TMPDIR"
    : > nothing.obj
    cannot_read 'nothing.obj: byte 0: the file is empty' nothing.obj b.obj
    # A file of the kernel, which states a size of 4096 bytes.
    size=$(wc -c < <(cat /sys/devices/system/cpu/online))
    cannot_read "/sys/devices/system/cpu/online: byte $size: the file became shorter while it was read" a.obj /sys/devices/system/cpu/online
    printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' > broken.obj
    mesh a.obj broken.obj --json
    ended 2
    is ''
    [[ $stderr == 'fmb: broken.obj: line 3: '* ]]
    printf 'v 0 0 nan\n' > broken.obj
    mesh broken.obj a.obj
    ended 2
    [[ $stderr == 'fmb: broken.obj: line 1: '* ]]
    "$MAKE_MESH" --faces 8 --format ply-le whole.ply
    head -c -1 whole.ply > cut.ply
    mesh cut.ply a.obj
    ended 2
    is ''
    [[ $stderr == 'fmb: cut.ply: '* ]]
    [ "$(wc -l <<< "$stderr")" = 1 ]
}

# bats test_tags=release
@test "output that cannot be written is reported" {
    mesh a.obj b.obj --json --html "$BATS_TEST_TMPDIR/no/out.html"
    ended 1
    said "fmb: $BATS_TEST_TMPDIR/no/out.html: No such file or directory"
    jq -e .overlapping <<< "$output"
    mesh a.obj b.obj --html /dev/full
    ended 1
    said 'fmb: /dev/full: No space left on device; free space there, or write elsewhere'
    run bash -c "'$FMB' mesh a.obj b.obj --json 2>&1 > /dev/full"
    ended 1
    is 'fmb: standard output: No space left on device'
}

# ---- Usage -------------------------------------------------------------------------------------

# ---- The terminal ------------------------------------------------------------------------------

# bats test_tags=release
@test "progress is shown on a terminal only" {
    script -qfc true /dev/null < /dev/null > /dev/null 2>&1 3>&- || skip 'there is no pseudo-terminal'
    "$MAKE_MESH" --faces 100000 large.ply
    script -qfc "'$FMB' mesh large.ply large.ply" screen < /dev/null > /dev/null 3>&- &
    script=$!
    wait_until grep -q 'fmb: [0-9,]* of 100,352 faces' screen
    kill "$script"
    wait "$script" || true
    run --separate-stderr timeout 2 "$FMB" mesh large.ply large.ply
    ended 124
    said ''
}
