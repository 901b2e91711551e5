# Clients that ask as fast as they can, beside one that does not.

load service

# flood TYPE CLIENT: for longer than a test takes, in the background.
flood() {
    "$FMB_BUILD/poke" flood "$1" "$2" 60 > /dev/null 3>&- &
    started="${started-} $!"
    flooders="${flooders-} $!"
}

end_floods() {
    kill $flooders
    for pid in $flooders; do wait "$pid" || true; done
    flooders=
}

is_flooded() {
    [ "$(status_of received)" -gt 1000 ]
}

# The scene's answers are right, all of them, within so many tries for each.
ask_beside() {
    "$FMB" query --json --box --timeout 0.3 --retries 150 "$1" > "$BATS_TEST_TMPDIR/bus"
    "$FMB" query --json --box --local "$1" | cmp - "$BATS_TEST_TMPDIR/bus"
}

counts_add_up() {
    "$FMB" status --json | jq -e '.received == .answered + .unsent and .answered == ([.results[]] | add)'
}

@test "who asks pairs as fast as it can does not keep another from its answers" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    flood pair_query 101
    wait_until is_flooded
    for _ in 1 2 3; do ask_beside "$BATS_TEST_TMPDIR/scene.json"; done
    end_floods
    counts_add_up
    stop_fmbd
}

@test "nor do several of them, of pairs and of long scenes" {
    start_fmbd
    random_scene 3 12 > "$BATS_TEST_TMPDIR/scene.json"
    flood pair_query 101
    flood scene_query 102
    flood scene_query 103
    wait_until is_flooded
    ask_beside "$BATS_TEST_TMPDIR/scene.json"
    end_floods
    counts_add_up
    stop_fmbd
}
