# Turns what a program prints with --help into a page of the manual, in the macros of man(7).
# Variables: name (fmb-query), section, version, summary, also (pages for SEE ALSO). What it reads:
#
#   usage: fmb query [OPTIONS]     these lines up to the first empty one
#   Commands:                      a heading, of commands
#   Poses:                         one capitalised word and a colon: a heading, of options
#   Exit codes: ...                begins a section too
#     -l, --lcm-url URL   text     an item: a tag, two spaces, text that goes on in deeper lines
#     anything else                lines to print as they are

function text(line)
{
    gsub(/\\/, "\\(rs", line)
    gsub(/-/, "\\-", line)
    gsub(/'/, "\\(aq", line)
    gsub(/`/, "\\(ga", line)
    gsub(/\^/, "\\(ha", line)
    gsub(/~/, "\\(ti", line)
    return (line ~ /^\./ ? "\\&" : "") line
}

function end_block()
{
    if (example)
        print ".EE"
    example = item = 0
}

function heading(macro, title)
{
    end_block()
    print macro, title
    begins = 1
}

# The options and commands of a tag bold, what stands for values italic.
function print_item(line,    tag, words, count, i)
{
    tag = line
    sub(/   *[^ ].*/, "", tag)
    count = split(tag, words, " ")
    for (i = 1; i <= count; i++)
        words[i] = (words[i] ~ /^[-a-z]/ ? "\\fB" : "\\fI") text(words[i]) "\\fR"
    printf ".TP\n%s", words[1]
    for (i = 2; i <= count; i++)
        printf " %s", words[i]
    line = substr(line, length(tag) + 1)
    sub(/^ */, "", line)
    print line == "" ? "" : "\n" text(line)
    item = 1
    begins = 0
}

BEGIN {
    printf ".TH %s %d \"\" \"fmb %s\"\n.SH NAME\n%s \\- %s\n", toupper(name), section, version, \
        name, text(summary)
    print ".SH SYNOPSIS"
}

!described && /^$/ { heading(".SH", "DESCRIPTION"); described = 1; next }
!described {
    sub(/^(usage:)? */, "")
    match($0, /^[a-z]+([- ][a-z]+)*/)
    if (NR > 1) print ".br"
    print "\\fB" substr($0, 1, RLENGTH) "\\fR" text(substr($0, RLENGTH + 1))
    next
}
/^$/ { end_block(); parted = 1; next }
example && /^ / { print text($0); next }
item && /^    / { sub(/^ */, ""); print text($0); next }
/^  -/ || (commands && /^  [a-z]/) {
    if (!commands && !options++) heading(".SH", "OPTIONS")
    sub(/^ */, "")
    print_item($0)
    next
}
/^[^ ]/ { end_block() }
/^Commands:$/ { heading(".SH", "COMMANDS"); commands = 1; next }
/^[A-Z][a-z]*:$/ {
    if (!options++) heading(".SH", "OPTIONS")
    sub(/:/, "")
    heading(".SS", $0)
    next
}
/^Exit codes: / { heading(".SH", "EXIT STATUS"); sub(/^Exit codes: /, ""); notes = 1 }
/^[^ ]/ && (options || commands) && !notes { heading(".SH", "NOTES"); notes = 1; commands = 0 }
{
    if (parted && !begins) print ".PP"
    parted = begins = 0
}
/^ / { print ".EX"; example = 1 }
{ print text($0) }

END {
    end_block()
    printf ".SH SEE ALSO\n%s\n", also
}
