# The README's commands print what the README says.

load service

# The commands of the console blocks, one after the other in one shell, each followed by a line
# that ends what it prints.
readme_script() {
    awk '
        /^```/ { inside = ($0 == "```console"); next }
        inside && /^\$ / { print substr($0, 3); print "echo \"--- end\"" }
    ' README.md
}

# What is to be expected of them, in the same form; "..." stands for any lines.
readme_expected() {
    awk '
        /^```/ { if (inside) print "--- end"; inside = ($0 == "```console"); first = 1; next }
        inside && /^\$ / { if (!first) print "--- end"; first = 0; next }
        inside { print }
    ' README.md
}

# matches ACTUAL EXPECTED: line by line; "..." matches as few lines as it can.
matches() {
    awk '
        NR == FNR { actual[++lines] = $0; next }
        $0 == "..." { skip = 1; next }
        {
            at++
            while (skip && at <= lines && actual[at] != $0) at++
            skip = 0
            if (at > lines || actual[at] != $0) {
                print "expected: " $0
                print "found:    " (at > lines ? "the end" : actual[at])
                exit failed = 1
            }
        }
        END { if (!failed && at < lines) { print "more than expected: " actual[at + 1]; exit 1 } }
    ' "$1" "$2"
}

@test "the README's commands print what it shows" {
    readme_script | sed "s|build/|$FMB_BUILD/|g" > "$BATS_TEST_TMPDIR/script"
    [ "$(grep -c 'fmb query' "$BATS_TEST_TMPDIR/script")" -ge 4 ]
    # The daemon that the README starts is stopped at the end; queries wait until it is there.
    echo 'kill %1; wait' >> "$BATS_TEST_TMPDIR/script"
    bash -m "$BATS_TEST_TMPDIR/script" > "$BATS_TEST_TMPDIR/actual" 2>&1 3>&-
    readme_expected > "$BATS_TEST_TMPDIR/expected"
    matches "$BATS_TEST_TMPDIR/actual" "$BATS_TEST_TMPDIR/expected"
}

@test "the demo runs, shows a table, draws a picture and ends" {
    session=$BATS_TEST_TMPDIR/session
    run setsid -w sh -c 'echo $$ > "$0"; exec timeout 60 "$@"' "$session" clients/demo/run.sh "$FMB_BUILD" 3>&-
    [ "$status" = 0 ]
    [[ "$output" == *"overlapping"*"touching"* ]]
    [[ "$output" == *"the picture: $FMB_BUILD/demo/scene.svg"* ]]
    grep -q '</svg>' "$FMB_BUILD/demo/scene.svg"
    # Nothing of its session is left (the sixth field of stat).
    [ -z "$(cat /proc/[0-9]*/stat 2> /dev/null | awk -v session="$(cat "$session")" '$6 == session')" ]
}
