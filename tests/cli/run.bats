# tests/run.sh: the summary of skipped tests.

load ../ran

@test "the reasons of skipped tests are one line, the most frequent first" {
    cat > "$BATS_TEST_TMPDIR/a.tap" <<'TAP'
1..6
ok 1 one # skip needs root
ok 2 two
not ok 3 three
ok 4 - test_four # SKIP
# no skip
ok 5 of # a kind that we skip
TAP
    printf 'ok 1 other # skip (no /dev/full)\nok 2 another # skip needs root\n' > "$BATS_TEST_TMPDIR/b.tap"
    run "$BATS_TEST_DIRNAME/../run.sh" --reasons "$BATS_TEST_TMPDIR"/*.tap
    ended 0
    is 'skipped: 2 needs root; 1 (no /dev/full); 1 test_four'
    run "$BATS_TEST_DIRNAME/../run.sh" --reasons /dev/null
    ended 0
    is ''
}
