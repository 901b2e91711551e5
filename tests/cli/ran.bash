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
