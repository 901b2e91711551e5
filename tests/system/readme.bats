# The commands in the pages of documentation print what the pages say, and the README's example is
# a program that works.

load service

# The pages with commands that are run: blocks of "console".
pages='README.md service/README.md clients/README.md clients/robot/README.md'

# script PAGE: its commands, one after the other in one shell, each followed by a line that ends what
# it prints.
script() {
    awk '
        /^```/ { inside = ($0 == "```console"); next }
        inside && /^\$ / { print substr($0, 3); print "echo \"--- end\"" }
    ' "$1"
}

# expected PAGE: what is to be expected of them, in the same form; "..." stands for any lines.
expected() {
    awk '
        /^```/ { if (inside) print "--- end"; inside = ($0 == "```console"); first = 1; next }
        inside && /^\$ / { if (!first) print "--- end"; first = 0; next }
        inside { print }
    ' "$1"
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

# prints_what_it_shows PAGE COMMANDS: that many commands at least.
prints_what_it_shows() {
    script "$1" | sed "s|build/|$FMB_BUILD/|g" > "$BATS_TEST_TMPDIR/script"
    [ "$(grep -c 'echo "--- end"' "$BATS_TEST_TMPDIR/script")" -ge "$2" ]
    # The daemon that the page starts is stopped at the end; queries wait until it is there.
    echo 'for job in $(jobs -p); do kill $job; done; wait' >> "$BATS_TEST_TMPDIR/script"
    timeout 120 bash "$BATS_TEST_TMPDIR/script" > "$BATS_TEST_TMPDIR/actual" 2>&1 3>&-
    expected "$1" | sed "s|build/|$FMB_BUILD/|g" > "$BATS_TEST_TMPDIR/expected"
    matches "$BATS_TEST_TMPDIR/actual" "$BATS_TEST_TMPDIR/expected"
}

@test "the commands of the README print what it shows" {
    prints_what_it_shows README.md 6
    grep -q '](clients/demo/robot.png)' README.md
}

@test "the commands of the page of the service print what it shows" {
    prints_what_it_shows service/README.md 3
}

@test "the commands of the page of the clients print what it shows" {
    prints_what_it_shows clients/README.md 12
    # The curve has the six steps, whose points have the same size.
    [ "$(grep -c "^.*<use xlink:href='#gpPt0' transform=" "$FMB_BUILD/path.svg")" = 7 ]
}

@test "the script for CI systems fails if a scene has a contact or a log is answered differently, and reports which" {
    local build
    build=$(realpath "$FMB_BUILD")
    cp -r clients/demo/robot "$BATS_TEST_TMPDIR/ci"
    mkdir "$BATS_TEST_TMPDIR/ci/logs"
    cp tests/logs/{arm,stack}.log "$BATS_TEST_TMPDIR/ci/logs"
    awk '/^```/ { inside = ($0 == "```sh"); next } inside' clients/README.md | sed -n '/^#!/,$p' > "$BATS_TEST_TMPDIR/ci/ci.sh"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/ci/ci.sh")" -le 10 ]
    cd "$BATS_TEST_TMPDIR/ci"
    PATH=$build:$PATH
    ! sh ci.sh > said 2> /dev/null || false
    grep -qx 'overlapping in 2 of 9 scenes, first in scene 4 (swing .*): forearm and post; .*' said
    # Keep only the rows before this contact.
    sed -i 4q path.csv
    sh ci.sh > said 2> /dev/null
    [ "$(cat said)" = "no contact in 3 scenes" ]
    grep -q '</html>' scenes.html
    "$TOOLS/edit-log" --label 3 home --flip 3 logs/arm.log flipped.log
    mv flipped.log logs/arm.log
    ! sh ci.sh > said 2> /dev/null || false
    [ "$(sed -n '2,$s/  .*//p' said)" = 'logs/arm.log: event 7 (home)' ]
    grep -A 1 '<testcase .* name="home">' replay.xml | grep -q '<failure'
}

@test "the commands of the page of robots print what it shows" {
    prints_what_it_shows clients/robot/README.md 3
}

@test "no other page has commands that these tests do not run" {
    found=$(find . -name '*.md' -not -path './build/*' -not -path './.git/*' \
        -exec grep -l '^```console' {} + | sed 's|^\./||' | sort)
    [ "$found" = "$(tr ' ' '\n' <<< "$pages" | sort)" ]
}

@test "the example in C of the README prints what it states" {
    example=clients/examples/scene.c
    includes='-Iservice/fmb -Iclients/lib -Imsgs/codec'
    gcc -std=c99 -Wall -Wextra -Werror $includes $example "$FMB_BUILD/libfmb-client.a" \
        "$FMB_BUILD/libfmb.a" -llcm -lglib-2.0 -lgmp -lm -o "$BATS_TEST_TMPDIR/scene"
    ! command -v g++ || g++ -std=c++20 -x c++ -Wall -Werror -fsyntax-only $includes $example
    "$BATS_TEST_TMPDIR/scene" > "$BATS_TEST_TMPDIR/printed"
    sed -n '/^ \* Both print$/,/\*\/$/s/^ \*     \(.* s\)\( \*\/\)*$/\1/p' $example | cmp - "$BATS_TEST_TMPDIR/printed"
}

# As its section on licences says.
@test "the libraries whose licences the README names are linked dynamically" {
    for library in lcm glib-2.0 gmp seccomp; do
        grep -q "NEEDED.*\[lib$library\.so" <<< "$(readelf -d "$FMB_BUILD/fmbd")"
    done
    for library in lcm glib-2.0 gmp cjson expat z; do
        grep -q "NEEDED.*\[lib$library\.so" <<< "$(readelf -d "$FMB_BUILD/fmb")"
    done
}

@test "the demo prints a table, writes a page and ends" {
    session=$BATS_TEST_TMPDIR/session
    run setsid -w sh -c 'echo $$ > "$0"; exec timeout 60 "$@"' "$session" clients/demo/run.sh "$FMB_BUILD" 3>&-
    [ "$status" = 0 ]
    [[ "$output" == *"overlapping"*"touching"* ]]
    # What meets, and how many pairs do not.
    ! grep '[a-z]  separated *$' <<< "$output" || false
    [[ "$output" == *", 37 separated"* ]]
    [[ "$output" == *"the page: $FMB_BUILD/demo/scene.html"* ]]
    grep -q '</html>' "$FMB_BUILD/demo/scene.html"
    # Nothing of its session is left (the sixth field of stat).
    [ -z "$(cat /proc/[0-9]*/stat 2> /dev/null | awk -v session="$(cat "$session")" '$6 == session')" ]
}
