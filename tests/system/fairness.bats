# Clients that cost the service as much as they can, beside one that does not. 'make soak' measures
# its share; here half of the promised one is enough, since other tests run at the same time.

load service

# share ATTACK [OPTIONS]: skips the test if the client did not get its share, and other programs used
# more than a tenth of the machine.
share() {
    code=0
    "$TOOLS/soak-fair" "$@" --service "$fmbd" --headroom 2 --seconds 1 > "$BATS_TEST_TMPDIR/report" || code=$?
    cat "$BATS_TEST_TMPDIR/report"
    [ $code != 77 ] || skip "other programs kept the machine busy: $(cat "$BATS_TEST_TMPDIR/report")"
    [ $code = 0 ]
}

@test "a client keeps its share beside others, and their queries wait for at most five seconds" {
    start_fmbd
    "$TOOLS/soak-fair" flood --ids 4 --seconds 3 || true
    settled() {
        "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
        jq -e '.waiting == 0' "$BATS_TEST_TMPDIR/status"
    }
    wait_until settled
    jq -e '.received == .answered + .unsent and .answered == ([.results[]] | add) and
        .results.BUSY > 0 and .results.BUSY <= 5 * (64 + .uptime_us / 10000)' "$BATS_TEST_TMPDIR/status"
    for attack in mixed certificates bodies ids; do
        share $attack
    done
    share pairs --ids 4 --turnaround 60
    share certificates --ids 4 --scenes
    share rate --and flood
    stop_fmbd
}

# flood TYPE CLIENT: for longer than a test takes, in the background.
flood() {
    "$TOOLS/fake-peer" flood "$1" "$2" 60 > /dev/null 3>&- &
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
