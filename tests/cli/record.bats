# fmb record without a network: its options, and a bus on which nothing passes.

bats_require_minimum_version 1.5.0

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    export LCM_DEFAULT_URL=memq://
    log=$BATS_TEST_TMPDIR/log
}

# wrong MESSAGE ARGUMENTS...: refused with that message, and a hint; nothing is written.
wrong() {
    local message=$1
    shift
    run --separate-stderr "$FMB" record "$@" < /dev/null
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [ "$stderr" = "fmb record: $message
Try 'fmb record --help'." ]
    [ ! -e "$log" ]
}

@test "help" {
    run --separate-stderr "$FMB" record --help
    [ "$status" = 0 ]
    [ "$stderr" = '' ]
    [ "${lines[0]}" = 'usage: fmb record [OPTIONS] FILE' ]
    help=$output
    run "$FMB" help record
    [ "$output" = "$help" ]
    "$FMB" --help | grep -q '^  record  '
}

@test "wrong options" {
    wrong 'expected a FILE to write'
    wrong "expected one FILE, found 'b' too" "$log" b
    wrong "unknown option '--frobnicate'" --frobnicate "$log"
    wrong "--duration: expected a number from 0.001 to 1e+08, found '0'" --duration 0 "$log"
    wrong "--duration: expected a number from 0.001 to 1e+08, found 'nan'" --duration nan "$log"
    wrong "--count: expected an integer from 1 to 1000000000000, found '-1'" --count -1 "$log"
    wrong "--split-mb: expected a number from 0.001 to 1e+06, found '0'" --split-mb 0 "$log"
    wrong "--max-files: expected an integer from 1 to 1000000, found '0'" --max-files 0 "$log"
    wrong "--max-files: there is one file only without --split-mb" --max-files 3 "$log"
    wrong "--channel: --all records all channels" --all --channel A "$log"
    wrong "--prefix: expected at most 32 letters, digits, '_' or '-'" --prefix 'a.*' "$log"
    wrong "option '--channel' needs a value" --channel
}

@test "a regular expression that is none" {
    # LCM forgets to free what it refuses.
    ASAN_OPTIONS=detect_leaks=0 run --separate-stderr "$FMB" record --channel '(' "$log"
    [ "$status" = 2 ]
    [ "$output" = '' ]
    [[ $stderr == *"fmb: LCM takes no such regular expression: '('" ]]
    [ ! -e "$log" ]
}

@test "a recording of nothing" {
    run --separate-stderr "$FMB" record --duration 0.01 "$log"
    [ "$status" = 0 ]
    [[ ${lines[0]} =~ ^"$log: 0 messages in 0."[0-9]" s, 0 bytes"$ ]]
    [ "${lines[6]}" = '  lost                           0' ]
    [ "${#lines[@]}" = 7 ]
    [ "$stderr" = "fmb: recording to $log" ]
    [ -f "$log" ] && [ ! -s "$log" ]
    "$FMB" record --json --duration 0.01 --split-mb 1 "$log" > "$BATS_TEST_TMPDIR/heard"
    [ "$(jq -c '[.files, .events, .bytes, .lost, .dropped, .receive_buffer]' "$BATS_TEST_TMPDIR/heard")" = \
        "[[\"$log.000\"],0,0,0,null,null]" ]
    [ "$(wc -l < "$BATS_TEST_TMPDIR/heard")" = 1 ]
}
