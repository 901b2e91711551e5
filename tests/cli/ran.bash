# What the last run (bats' own, --separate-stderr) printed, said on stderr, and ended with.

bats_require_minimum_version 1.5.0

# is TEXT
is() {
    [ "$output" = "$1" ] || {
        echo "expected: $1"
        echo "found:    $output${stderr:+ ($stderr)}"
        return 1
    }
}

# said TEXT
said() {
    [ "$stderr" = "$1" ] || {
        echo "expected: $1"
        echo "found:    $stderr"
        return 1
    }
}

# ended CODE
ended() {
    [ "$status" = "$1" ] || {
        echo "expected exit code $1, found $status"
        echo "$output${stderr:+ ($stderr)}" | tail -n 20
        return 1
    }
}

# wrong COMMAND ARGUMENTS...: wrong usage of fmb is refused with one line and a hint.
wrong() {
    # shellcheck disable=SC2086
    run --separate-stderr "$FMB" $1 "${@:2}" < /dev/null
    ended 2
    is ''
    [[ $stderr == "fmb $1: "*$'\n'"Try 'fmb $1 --help'." ]]
    [ "$(wc -l <<< "$stderr")" = 2 ]
}
