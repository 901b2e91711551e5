# tests/run.sh: the summary of skipped tests; which suites run, and when.

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

# A tree of suites, whose make and bats only say what they were called for, in the file called.
small_tree() {
    cd "$BATS_TEST_TMPDIR"
    export called=$PWD/called
    mkdir -p tree/tests/{cli,system,fuzz} tree/build tools
    cp "$BATS_TEST_DIRNAME/../run.sh" tree/tests
    for suite in cli/page cli/query cli/replay cli/mesh cli/replay_set system/{service,daemon,record,replay_bus,soak} \
        fuzz/fuzz; do
        touch "tree/tests/$suite.bats"
    done
    printf '#!/bin/sh\nexec "$@"\n' > tree/build/netns
    cat > tools/bats << 'END'
#!/bin/sh
for suite; do :; done
until_called 'make .*MODE=asan'
echo "$FMB_BUILD $suite" >> "$called"
[ "$(grep -c '^build ' "$called")" -le "$awaited" ] || until_called made
printf '1..1\nok 1 one\n'
END
    # Up to ten seconds, until the word begins so many lines.
    cat > tools/until_called << 'END'
#!/bin/sh
tries=100
until [ "$(grep -c "^$1" "$called")" -ge "${2:-1}" ] || [ $tries = 0 ]; do
    sleep 0.1
    tries=$((tries - 1))
done
END
    # The second build takes as long as so many suites beside it.
    cat > tools/make << 'END'
#!/bin/sh
echo "make $*" >> "$called"
case $* in
*MODE=asan*)
    until_called build "$awaited"
    mkdir -p build/asan-clang-two/tests
    cp build/netns build/asan-clang-two
    echo "made" >> "$called"
    exit "${asan_code:-0}" ;;
esac
END
    chmod +x tree/build/netns tools/*
}

@test "suites that wait run beside the builds, and each runs once in each build that has it" {
    small_tree
    awaited=5 PATH=$PWD/tools:$PATH run env -u FMB_FAST tree/tests/run.sh
    ended 0
    [ "${lines[-1]}" = '20 passed, 0 failed' ]
    [ "$(sed -n '/MODE=asan/,/^made/p' "$called" | grep -c '^build ')" = 5 ]
    [ "$(grep -v -e ^ma "$called" | sort | uniq -d)" = '' ]
    [ "$(grep -c '^build/asan-clang-two ' "$called")" = 10 ]
}

@test "a second build that fails is one failure, and no further suite begins" {
    small_tree
    awaited=1 asan_code=1 PATH=$PWD/tools:$PATH run env -u FMB_FAST tree/tests/run.sh
    ended 1
    [ "${lines[-1]}" = '0 passed, 1 failed' ]
    # The one that was running has ended, and the next one may just have begun.
    [ "$(grep -c '^build ' "$called")" -le 3 ]
}
