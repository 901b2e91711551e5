# The options of fmb record.

load ../ran

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
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

@test "--help prints the usage" {
    run --separate-stderr "$FMB" record --help
    [ "$status" = 0 ]
    [ "$stderr" = '' ]
    [ "${lines[0]}" = 'usage: fmb record [OPTIONS] FILE' ]
    help=$output
    run "$FMB" help record
    [ "$output" = "$help" ]
    grep -q '^  record  ' <<< "$("$FMB" --help)"
}

@test "wrong options are refused with exit code 2" {
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

@test "an invalid regular expression is refused" {
    wrong '--channel: '"'('"' is no regular expression: Unmatched ( or \(' --channel '(' "$log"
}
