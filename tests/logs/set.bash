# For the tests of the regression set: the logs, and the programs capped at each instruction set.

: "${FMB_BUILD:=build}"
LOGS=$BATS_TEST_DIRNAME/../logs

# Those that this machine has; the others' programs would be the same as one of these.
has_set() {
    grep -qx "$1" <<< "$("$TOOLS/logs/generate" --instructions)"
}

need_set() {
    has_set "$1" || skip "this machine has no $1"
}

# name_of LOG: of tests/logs/arm.log: arm.
name_of() {
    basename "$1" .log
}

# code_of LOG: what a replay in which all is the same exits with. Of the foreign log some messages
# cannot be read, and a replay has to say so.
code_of() {
    if [ "$(name_of "$1")" = foreign ]; then echo 2; else echo 0; fi
}

# as_it_was FMB LOG OPTIONS...
as_it_was() {
    fmb=$1 log=$2
    shift 2
    code=0
    "$fmb" replay --json "$@" "$log" > "$BATS_TEST_TMPDIR/said" 2> "$BATS_TEST_TMPDIR/log" || code=$?
    [ $code = "$(code_of "$log")" ] && jq -e '.different == 0 and .same > 0' "$BATS_TEST_TMPDIR/said" > /dev/null ||
        { echo "$fmb replay $* $log: $code"; cat "$BATS_TEST_TMPDIR/said" "$BATS_TEST_TMPDIR/log"; return 1; }
}

# replays_the_set FMB: its results are the goldens, byte for byte.
replays_the_set() {
    for log in tests/logs/*.log; do
        as_it_was "$1" "$log" --golden "${log%.log}.golden" \
            --force --write-golden "$BATS_TEST_TMPDIR/golden"
        cmp "$BATS_TEST_TMPDIR/golden" "${log%.log}.golden"
    done
}

# makes_the_hard_logs GENERATE: the hard logs are the committed ones.
makes_the_hard_logs() {
    for kind in $("$1" --list | cut -d ' ' -f 1); do
        "$1" "$kind" "$BATS_TEST_TMPDIR/made.log"
        cmp "$BATS_TEST_TMPDIR/made.log" "tests/logs/$kind.log"
    done
}
