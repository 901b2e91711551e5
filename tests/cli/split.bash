# Of events of a log; $T is a folder.

# offset_of LOG N: of the event with index N.
offset_of() {
    "$TOOLS/edit-log" --offset "$2" "$1"
}

# split LOG N: into $T/first.log, with N events, and $T/second.log.
split_at() {
    local at
    at=$(offset_of "$1" "$2")
    head -c "$at" "$1" > "$T/first.log"
    tail -c +$((at + 1)) "$1" > "$T/second.log"
}
