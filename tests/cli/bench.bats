# The benchmark runs, on small samples. No time is tested.

load ../ran

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    BENCH=${FMB_BUILD:-build}/bench/bench
    JSON=$BATS_TEST_TMPDIR/report.json
}

@test "bench --quick measures every section, in every cell, by every method" {
    run "$BENCH" --quick --json "$JSON"
    [ "$status" = 0 ]
    holds "$JSON" 'all(.cells, .box, .contacts, .poses, .rest, .gaps, .hulls, .radii, .turns, .worst; length > 0)' \
        '[.cells[] | [.dim, .moving, .shapes, .contact]] | unique | length == 32' \
        'all(.cells[]; [.methods[].name] | contains(["batch", "single", "query", "fmb", "sat", "exact"]))' \
        'all(.cells[].methods[]; .ns > 0 and .low <= .ns and .ns <= .high)' \
        '[.poses[] | [.dim, .moving, .shapes, .contact]] | unique | length == 72' \
        '.unsure.unsure < 5' \
        '[.gaps[] | [.kind, .gap]] | unique | length == 32' \
        'all(.gaps[]; [.runs[].name] | contains(["batch", "single", "query"]))' \
        '[.hulls[].pairs_are] | unique | length == 48' \
        '[.radii[].pairs_are] | unique | length == 77' \
        'all(.hulls[], .radii[]; [.methods[].name] | contains(["batch", "query", "query+box", "query+gap"]))' \
        'all(.hulls[], .radii[] | select(.pairs_are | startswith("touch, exactly")); .touching == 1)' \
        'all((.hulls[], .radii[]).methods[] | select(.name | test("batch|query")); .wrong == 0)' \
        '[.turns[].pairs_are] | unique | length == 26' \
        'all(.turns[]; [.methods[].name] | contains(["batch", "query"]))' \
        'all(.turns[].methods[] | select(.name | test("batch|query")); .wrong == 0)' \
        'all(.turns[] | select(.pairs_are | test("random") | not); .undecided == 0 and .meet == (.pairs_are |
            if test("depth|on a table|closes$") then 1 else 0 end))'
    # Certified verdicts are right; the other methods are right about random pairs, not about all; what
    # other libraries have here is nearly right about random pairs.
    holds "$JSON" '[.contacts[] | [.dim, .moving, .shapes, .pairs_are]] | unique | length == 140' \
        'all(.contacts[]; [.methods[].name] | contains(["batch", "batch+box", "single", "query", "sat"]))' \
        'all(.contacts[].methods[]; .ns > 0 and .wrong >= 0 and .wrong <= 1)' \
        'all(.contacts[].methods[] | select(.name | test("batch|single|query")); .wrong == 0)' \
        '[.contacts[] | select(.pairs_are | startswith("random")) | .methods[]]
            | all(.[] | select(.name == "sat"); .wrong == 0) and all(.[]; .wrong < 0.05)' \
        'any(.contacts[].methods[] | select(.name == "sat"); .wrong > 0)'
}

@test "bench reports a wrong option with exit code 2" {
    run "$BENCH" --section nowhere
    [ "$status" = 2 ]
    run "$BENCH" --instructions abacus
    [ "$status" = 2 ]
    run "$BENCH" --help
    [ "$status" = 0 ]
}
