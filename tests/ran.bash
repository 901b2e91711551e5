# What suites share: the programs of the tests, waiting with bounds, and checks of what a command printed,
# said on stderr, and ended with.

# A pipeline fails where any of its commands does. One that ends before it has read all, such as grep -q or
# head, takes its input from a file: a writer that finds no reader has failed too.
set -o pipefail

# The programs of the tests themselves: run.sh takes those of the default build, which start sooner than
# sanitized ones.
TOOLS=${FMB_TOOLS:-${FMB_BUILD:-build}}
[[ $TOOLS == /* ]] || TOOLS=$BATS_TEST_DIRNAME/../../$TOOLS

# run [!] [--separate-stderr] COMMAND...: as bats' own, which starts five processes for one.
run() {
    local flags=$- negated='' out=$BATS_TEST_TMPDIR.out said=$BATS_TEST_TMPDIR.said
    set +eET
    if [ "$1" = ! ]; then negated=1; shift; fi
    : > "$said"
    if [ "$1" = --separate-stderr ]; then
        shift
        "$@" > "$out" 2> "$said" && status=0 || status=$?
    else
        "$@" > "$out" 2>&1 && status=0 || status=$?
    fi
    read_text output lines "$out"
    read_text stderr stderr_lines "$said"
    set "-$flags"
    [ -z "$negated" ] || [ "$status" != 0 ]
}

# read_text TEXT LINES FILE: without the line feeds at its end; and its lines that are not empty.
read_text() {
    IFS= read -rd '' "$1" < "$3"
    while [[ ${!1} == *$'\n' ]]; do printf -v "$1" %s "${!1%$'\n'}"; done
    IFS=$'\n' read -rd '' -a "$2" < "$3"
}

# Waits up to a minute until a command succeeds. A read from a pipe without data sleeps without a process of
# its own.
exec {nothing}<> <(:)
wait_until() {
    local i
    for ((i = 0; i < 1200; i++)); do
        if "$@"; then return 0; fi
        read -rt 0.05 -u "$nothing" || true
    done
    echo "waited in vain for: $*" >&2
    return 1
}

# has FILE TEXT
has() {
    local text
    IFS= read -rd '' text 2> /dev/null < "$1" || true
    [[ $text == *"$2"* ]]
}

# has_lines FILE COUNT: or more.
has_lines() {
    [ "$(wc -l < "$1")" -ge "$2" ]
}

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

# holds [-s] FILE EXPRESSION...: each is true of the JSON in the file, with -s of the array of all that it
# holds. One jq for all: it takes long to start.
holds() {
    local slurp='' file expression all=true
    if [ "$1" = -s ]; then slurp=-s; shift; fi
    file=$1
    shift
    for expression; do all+=" and ($expression)"; done
    # shellcheck disable=SC2086
    jq -e $slurp "$all" "$file" > /dev/null || {
        for expression; do jq -e $slurp "$expression" "$file" > /dev/null || echo "not so: $expression"; done
        head -c 3000 "$file"
        return 1
    }
}

# generate KIND LOG | --blast ... LOG: copies a log of the regression set, or generates one.
generate() {
    if [ "$1" = --blast ]; then "$TOOLS/logs/generate" "$@"; else cp "$BATS_TEST_DIRNAME/../logs/$1.log" "$2"; fi
}
