# The usage of each command of fmb, as 'fmb help' lists them, and of fmbd; and the messages for wrong usage.

load ../ran

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    # As 'fmb help' and 'fmb log help' list them.
    listed() { "$FMB" "$@" help | sed -n '/^Commands:$/,/^$/s/^  \([a-z]*\)  .*/\1/p' | sed '/^help$/d'; }
    mapfile -t commands < <(listed; listed log | sed 's/^/log /')
    cd "$BATS_TEST_TMPDIR" || return
    FMB=$BATS_TEST_DIRNAME/../../$FMB
}

@test "each command prints its usage, in 80 columns, wherever help is asked for" {
    [ "${#commands[@]}" = 13 ]
    for words in '' "${commands[@]}"; do
        # shellcheck disable=SC2086
        run --separate-stderr "$FMB" $words --help
        ended 0
        said ''
        [[ ${lines[0]} == "usage: fmb ${words:-COMMAND}"* ]]
        [ "$(wc -L <<< "$output")" -le 80 ]
        usage=$output
        last=${words##* } first=${words%"$last"}
        for others in "$words -h" "help $words" "${first}help $last"; do
            # shellcheck disable=SC2086
            run --separate-stderr "$FMB" $others
            ended 0
            said ''
            is "$usage"
        done
    done
    run "${FMB}d" --help
    ended 0
    [[ ${lines[0]} == 'usage: fmbd'* ]]
    [ "$(wc -L <<< "$output")" -le 80 ]
    for words in '' log; do
        # shellcheck disable=SC2086
        run --separate-stderr "$FMB" $words
        ended 2
        is ''
        [[ $stderr == "usage: fmb ${words:+$words }COMMAND"* ]]
    done
}

@test "wrong usage of each command is refused with exit code 2 and a hint, and nothing is written" {
    for words in "${commands[@]}"; do
        wrong "$words" --frobnicate
        case $words in
        query | watch | status | log) ;;
        *) wrong "$words" ;;
        esac
    done
    while IFS=: read -r words arguments; do
        # shellcheck disable=SC2086
        wrong "$words" $arguments
    done << 'END'
query:-x
query:--html
query:--method best
query:--timeout 1s
query:--timeout nan
query:--timeout=
query:--retries -1
query:--prefix a.*
query:--json=1
query:--local a b
query:--fail-if
query:--fail-if separated
query:--fail-if near --fail-if near
query:--csv --json
query:--contacts --all
query:-p a.*
query:--lcm-url
watch:-l
watch:--count 0
watch:a
watch:-p a.*
watch:--lcm-url
status:a
status:-p a.*
status:--lcm-url
mesh:a.obj
mesh:a.obj b.obj a.obj
mesh:a.obj b.obj -- --json a.obj
mesh:a.obj b.obj --translate
mesh:a.obj --scale 1,2 b.obj
mesh:a.obj --scale= b.obj
mesh:a.obj --scale inf b.obj
mesh:a.obj --scale 1,2,3,4 b.obj
mesh:a.obj --scale 1e999 b.obj
mesh:a.obj --translate 1 b.obj
mesh:a.obj --translate 1,nan,3 b.obj
mesh:a.obj --velocity 1,2,3x b.obj
mesh:a.obj --rotate 90 b.obj
mesh:a.obj --rotate z b.obj
mesh:a.obj --rotate w,1 b.obj
mesh:a.obj --rotate= b.obj
mesh:a.obj --duration -1 b.obj
mesh:a.obj --duration nan b.obj
mesh:a.obj -x b.obj
mesh:a.obj --json=1 b.obj
replay:--tolerance -1 LOG
replay:--tolerance nan LOG
replay:--tolerance x LOG
replay:--limit -1 LOG
replay:--frames 0 LOG
replay:--frm 1 LOG
replay:--golden
replay:-p a/b LOG
replay:--bus --frames 9 LOG
replay:--timeout 1 LOG
replay:--retries 1 LOG
replay:--lcm-url udpm://239.255.76.67:7667 LOG
replay:--bus --timeout 0 LOG
replay:--bus --retries x LOG
log cut:LOG
log cut:-o FILE
log cut:LOG -o FILE --from -1
log cut:LOG -o FILE --to x
log cut:LOG -o FILE --channel (
log cut:LOG -o FILE --channel A --channel B
log cut:LOG -o FILE --from 10 --to 5
log cut:LOG -o FILE --from 1 --to 1
log cut:LOG -o FILE --what
log results:--csv --json LOG
log results:--csv --csv=1 LOG
log scene:--event 1
log scene:LOG
log scene:LOG --event x
log scene:LOG --event 9223372036854775808
log scene:LOG --what
record:FILE b
record:--duration 0 FILE
record:--duration nan FILE
record:--count -1 FILE
record:--split-mb 0 FILE
record:--max-files 0 FILE
record:--max-files 3 FILE
record:--all --channel A FILE
record:--prefix a.* FILE
record:--channel
record:--channel ( FILE
END
    [ "$(echo *)" = '*' ]
}

# Arguments, and the first line on stderr.
@test "the message of wrong usage names what was wrong" {
    while IFS='|' read -r arguments message; do
        # shellcheck disable=SC2086
        run --separate-stderr "$FMB" $arguments
        ended 2
        is ''
        [ "${stderr_lines[0]}" = "$message" ]
    done << 'END'
frobnicate|fmb: unknown command 'frobnicate'
--help x|fmb: unknown argument 'x'
-h x|fmb: unknown argument 'x'
--version x|fmb: unknown argument 'x'
-V x|fmb: unknown argument 'x'
help frobnicate|fmb: unknown command 'frobnicate'
log frobnicate|fmb log: unknown command 'frobnicate'
log info|fmb log info: expected a LOG
log info --frobnicate x|fmb log info: unknown option '--frobnicate'
query --timeout 1s|fmb query: --timeout: expected a number from 0.001 to 3600, found '1s'
mesh a.obj --rotate 90 b.obj|fmb mesh: --rotate: expected an axis and degrees, such as z,90, found '90'
record|fmb record: expected a FILE to write
record a b|fmb record: expected one FILE, found 'b' too
record --count -1 a|fmb record: --count: expected an integer from 1 to 1000000000000, found '-1'
record --max-files 3 a|fmb record: --max-files: there is one file only without --split-mb
record --all --channel A a|fmb record: --channel: --all records all channels
record --prefix a.* a|fmb record: --prefix: expected at most 32 letters, digits, '_' or '-'
record --channel ( a|fmb record: --channel: '(' is no regular expression: Unmatched ( or \(
record --channel|fmb record: option '--channel' needs a value
END
    wrong status --timeout ''
}
