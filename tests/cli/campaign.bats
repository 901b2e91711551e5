# The campaigns, in small: they run, find nothing wrong, and find what is planted.

load ../ran

setup() {
    BUILD=${FMB_BUILD:-build}
    JSON=$BATS_TEST_TMPDIR/report.json
    cd "$BATS_TEST_DIRNAME/../.." || return
    pairs=1 # of each cell
}

@test "accuracy: no exact method is wrong, and families have the properties that they state" {
    run "$BUILD/accuracy" --pairs $pairs --every 4 --json "$JSON"
    ended 0
    holds "$JSON" "all(.cells[].methods[] | select(.name == \"certified\" or .name == \"exact\");
            .broken == 0 and .order_verdict == 0 and .refused == 0
            and .false_separated + .false_contact + .false_kind == 0
            and .gap.count == $pairs and .gap.unproven == 0 and .gap.width_max <= 1)" \
        '[.cells[].methods[] | select(.name == "certified")] | length > 800' \
        'all(.cells[]; .not_as_made == 0)' \
        '[.families[] | select(.verdict == "touching") | .name] |
         contains(["touch-face-face", "pose-whole-255", "pose-yaw", "hull-whole-255", "round-slide"])'
    # The picture of tests/bench/README.md, of these counts.
    jq -r --rawfile css tests/report/picture.css -f tests/report/speed_error.jq "$JSON" > "$BATS_TEST_TMPDIR/picture.svg"
    grouped() { sed -E ':a; s/^([0-9]+)([0-9]{3})/\1,\2/; ta' <<< "$1"; }
    for method in certified exact; do
        grep -qF ">$method: none wrong of $(grouped $((2 * pairs * $(jq '.cells | length' "$JSON"))))," "$BATS_TEST_TMPDIR/picture.svg"
    done
    [ "$(grep -c '^<path class="mark ' "$BATS_TEST_TMPDIR/picture.svg")" = "$(jq '[.cells[] | .family as $family | .methods[]
        | select(.refused < .queries) | [$family, .name]] | unique | length + 4' "$JSON")" ]
    ! command -v xmllint > /dev/null || xmllint --noout "$BATS_TEST_TMPDIR/picture.svg"
    # tests/bench/README.md counts the same families and cells.
    read -r families posed hulls rounds flat_cells posed_cells hull_cells round_cells <<< "$(jq -r '
        def count(test): map(select(test)) | length;
        [.families[].name] as $families | [.families[] | range(.cells) as $cell | .name] as $cells
        | [($families | length, count(test("^pose-")), count(test("^hull-")), count(test("^round-"))),
           ($cells | count(test("^(pose|hull|round)-") | not), count(test("^pose-")), count(test("^hull-")),
            count(test("^round-")))] | @tsv' "$JSON")"
    has() { grep -qF -- "$1" tests/bench/README.md || { echo "not in README.md: $1"; false; }; }
    has "| $families families of hard pairs"
    has "and $posed families posed by quaternions"
    has "$hulls families of hulls"
    has "and $rounds families of shapes with a radius"
    has "Of the $((families - posed - hulls - rounds)) families that are not turned"
    has "certified: $((2 * 5000 * flat_cells)) queries"
    has "none of $(grouped $((2 * 120 * posed_cells))) queries of posed bodies ($posed families)"
    has "$((families - hulls - rounds)) families, each gap proven"
    has "certified: $((40 * (flat_cells + posed_cells))) gaps"
    has "exact: $((40 * (flat_cells + posed_cells))) gaps"
    has "certified: $((10 * hull_cells)) gaps"
    has "certified: $((10 * round_cells)) gaps"
}

@test "accuracy: the counts do not depend on the number of workers" {
    for workers in 1 3; do
        run "$BUILD/accuracy" --pairs 20 --family gap-ulp --family faces --workers $workers \
            --json "$JSON"
        ended 0
        jq 'del(.workers, .cells[].methods[].ns_verdict, .cells[].methods[].ns_box,
            .cells[].methods[].ns_gap)' "$JSON" \
            > "$BATS_TEST_TMPDIR/$workers"
    done
    cmp "$BATS_TEST_TMPDIR/1" "$BATS_TEST_TMPDIR/3"
}

@test "accuracy: a wrong bound is detected" {
    run "$BUILD/accuracy-planted" --pairs 20 --family touch-vertex-vertex --family gap-ulp \
        --family random --json "$JSON"
    ended 1
    holds "$JSON" '[.cells[].methods[] | select(.name == "certified") |
            .false_separated + .false_contact + .false_kind] | add > 0' \
        '[.cells[] | select(.family == "random").methods[] |
            select(.name == "certified") | .gap.unproven] | add > 0' \
        'all(.cells[].methods[] | select(.name == "exact"); .broken == 0)'
    [[ $output == *"struct question question = {"* ]] # a reproducer
}

@test "turning: no answer about turning bodies is wrong; bodies that rest, slide, hang, land or lift off are decided" {
    run "$BUILD/turning" --pairs 2
    ended 0
    [[ ${lines[-1]} =~ ", 0 wrong, "([0-9]+)" undecided" ]]
    [ "${BASH_REMATCH[1]}" -le 3 ]
    # NAME DIM PAIRS APART TOUCH OVER OPEN | WRONG UNDECIDED LACKS WIDE ...: neither the engine nor the oracle leaves one open.
    [ "$(awk '/^turn-(table|lift|land|tumble|door)/ { count++; open += $7 + $10 } END { print count, open }' <<< "$output")" = "9 0" ]
    [ "$(awk '/^turn-/ && !/^turn-(exponents|flat|thin)/ { wide += $12 } END { print wide }' <<< "$output")" = 0 ]
    [ "$(awk '/^turn-(hull|round|capsule)/ { undecided += $10 } END { print undecided }' <<< "$output")" = 0 ]
}

@test "campaigns print their usage, and refuse wrong options with exit code 2" {
    run "$BUILD/accuracy" --help
    ended 0
    for options in '--pairs 0' --nothing more '--family nobody' '--pairs 1 --family random --json /nowhere/report.json'; do
        # shellcheck disable=SC2086
        run "$BUILD/accuracy" $options
        ended 2
    done
    run "$BUILD/turning" --help
    ended 0
    run "$BUILD/turning" --family random # a family without turning bodies
    ended 2
}

@test "hull-poses: doubles decide random poses of hulls" {
    run "$BUILD/hull-poses" 100000
    ended 0
    [[ ${lines[-1]} == *", 0 need integers" ]]
}
