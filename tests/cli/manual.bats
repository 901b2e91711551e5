# The pages of the manual and the completion for bash: both come from --help.

load ../ran

# commands WORD...: those that its help lists, a line each, with those that they have; and itself.
commands() {
    echo "$*"
    "$FMB_BUILD/$@" --help | sed -n '/^Commands:$/,/^$/s/^  \([a-z]*\)  .*/\1/p' | sed '/^help$/d' |
        while read -r command; do commands "$@" "$command"; done
}

# Without the line breaks and headings in which they differ.
pressed() {
    sed 's/^usage://; s/^Exit codes://; s/^[A-Z][a-z]*:$//' | tr -d ' \t\n'
}

@test "each command has a page, which says what --help says, without warnings" {
    count=0
    while read -r words; do
        name=${words// /-}
        page=$FMB_BUILD/man/$name.$([ "$name" = fmbd ] && echo 8 || echo 1)
        run env LC_ALL=C MANWIDTH=80 man --warnings --nh --nj -l "$page"
        [ "$status" = 0 ]
        [[ $output != *warning:* ]]
        printed=$(sed '1d; $d; /^NAME$/,/^SYNOPSIS$/d; /^ \{0,3\}[A-Z]/d' <<< "$output")
        said=$("$FMB_BUILD/"$words --help)
        also=$(sed -n '/^SEE ALSO$/,$p' <<< "$output" | grep '^[[:space:]]')
        diff <(pressed <<< "$printed") <(pressed <<< "$said"; pressed <<< "$also")
        # Its options are in one section; text after an option without a text is not its text.
        [ "$(sed -n '/^OPTIONS$/,/^[A-Z]/p' <<< "$output" | grep -c '^       -')" = "$(grep -c '^  -' <<< "$said")" ]
        [[ ! $output =~ --help$'\n'\ *[A-Z] || $said == *'--help  '* ]]
        count=$((count + 1))
    done < <(commands fmb; echo fmbd; echo fmb-check-path)
    [ $count -gt 10 ]
    [ "$(find "$FMB_BUILD/man" -type f | wc -l)" = $count ]
}

@test "a page names the others, which exist" {
    grep -h -A9 '^.SH SEE ALSO' "$FMB_BUILD"/man/* | grep -o '[a-z-]*([18])' | sort -u > "$BATS_TEST_TMPDIR/named"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/named")" = "$(find "$FMB_BUILD/man" -type f | wc -l)" ]
    while IFS='()' read -r name section; do
        [ -f "$FMB_BUILD/man/$name.$section" ]
    done < "$BATS_TEST_TMPDIR/named"
}

# completed WORD...: what is offered for the last one.
completed() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    _fmb "$1"
    echo "${COMPREPLY[*]}"
}

@test "bash completes the commands and options of --help, and file names" {
    source clients/manual/fmb.bash
    fmb=$FMB_BUILD/fmb
    [ "$(completed "$fmb" re)" = 'record replay' ]
    [[ $(completed "$fmb" log '') == 'info cut scene'* ]]
    [ "$(completed "$fmb" log c)" = cut ]
    [ "$(completed "$fmb" query --loc)" = --local ]
    [ "$(completed "$fmb" query table.json --ti)" = --timeout ]
    [ "$(completed "$fmb" log cut --from)" = --from ]
    [ "$(completed "$FMB_BUILD/fmbd" '')" = "$(completed "$FMB_BUILD/fmbd" -)" ]
    [[ $(completed "$FMB_BUILD/fmbd" '') == *--lcm-url*--version* ]]
    # Nothing, so that bash completes file names.
    [ -z "$(completed "$fmb" query '')$(completed "$fmb" query log '')$(completed "$fmb" query -x '')" ]
    [[ $(complete -p fmb) == *'-o default'* ]]
}
