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

@test "pairs get their answers beside each attack" {
    start_fmbd
    for attack in certificates boxes bodies rate flood definitions ids; do
        share $attack
    done
    stop_fmbd
}

@test "pairs get their answers beside two and four clients that flood" {
    start_fmbd
    share rate --and certificates
    share rate --and flood
    share flood --ids 4
    for _ in {1..8}; do # until the queries that wait at a heartbeat have their results
        "$FMB" status --json > "$BATS_TEST_TMPDIR/status"
        ! jq -e '.received == .answered + .unsent' "$BATS_TEST_TMPDIR/status" || break
    done
    cat "$BATS_TEST_TMPDIR/status"
    jq -e '.received == .answered + .unsent and
        .results.BUSY <= 11 * (64 + .uptime_us / 10000)' "$BATS_TEST_TMPDIR/status" # of 11 clients
    stop_fmbd
}

@test "scenes get their answers beside each attack, and beside four ids" {
    start_fmbd
    for attack in certificates boxes bodies rate definitions; do
        share $attack --scenes --ids 4
    done
    "$FMB" status --json | jq -e '.received == .answered + .unsent and
        .answered == ([.results[]] | add)'
    stop_fmbd
}

@test "queries of clients that are gone wait for at most five seconds" {
    start_fmbd
    timeout -s INT 5 "$TOOLS/soak-fair" flood --ids 4 --seconds 16 || [ $? = 124 ]
    sleep 7
    "$FMB" status --json | jq -e '.waiting == 0 and .results.BUSY > 0'
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
