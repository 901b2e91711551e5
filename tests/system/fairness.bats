# Clients that cost the service as much as they can, beside one that does not. 'make soak' measures
# what it gets; here it is enough that no answer is lost and that it gets a share, since other tests
# run at the same time.

load service

@test "pairs get their answers beside each attack" {
    start_fmbd
    for attack in certificates boxes bodies rate definitions ids; do
        "$FMB_BUILD/soak-fair" $attack --seconds 1 > "$BATS_TEST_TMPDIR/report" || true
        cat "$BATS_TEST_TMPDIR/report"
        jq -e '.lost == 0 and .failed == 0 and .share > 0.05' "$BATS_TEST_TMPDIR/report"
    done
    stop_fmbd
}

@test "scenes get their answers beside each attack, and beside four ids" {
    start_fmbd
    for attack in certificates boxes bodies rate definitions; do
        "$FMB_BUILD/soak-fair" $attack --scenes --ids 4 --seconds 1 > "$BATS_TEST_TMPDIR/report" || true
        cat "$BATS_TEST_TMPDIR/report"
        jq -e '.lost == 0 and .failed == 0 and .share > 0.02' "$BATS_TEST_TMPDIR/report"
    done
    "$FMB" status --json | jq -e '.received == .answered + .unsent and .answered == ([.results[]] | add)'
    stop_fmbd
}

# flood TYPE CLIENT: for longer than a test takes, in the background.
flood() {
    "$FMB_BUILD/poke" flood "$1" "$2" 60 > /dev/null 3>&- &
    started="${started-} $!"
}

@test "answers are right beside clients that send as fast as they can" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    flood pair_query 101
    flood scene_query 102
    is_flooded() { [ "$(status_of received)" -gt 1000 ]; }
    wait_until is_flooded
    for _ in 1 2 3; do
        "$FMB" query --json --box --timeout 0.3 --retries 20 "$BATS_TEST_TMPDIR/scene.json" > "$BATS_TEST_TMPDIR/bus"
        "$FMB" query --json --box --local "$BATS_TEST_TMPDIR/scene.json" | cmp - "$BATS_TEST_TMPDIR/bus"
    done
    # The flood was turned away, not queued without end.
    "$FMB" status --json | jq -e '.results.BUSY > 0'
    stop_fmbd
}
