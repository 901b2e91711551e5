# fmb log: what event logs are said to hold, good ones and broken ones; exit codes.

load ../ran

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    log=$BATS_TEST_TMPDIR/a.log
    pair_query=07880d0b8ca7b624
    status=15fcba856d637fca
}

# bytes HEX
bytes() {
    # shellcheck disable=SC2059
    printf "$(sed 's/../\\x&/g' <<< "$1")"
}

# hex TEXT: the bytes of what printf makes of it.
hex() {
    # shellcheck disable=SC2059
    printf "$1" | od -An -v -tx1 | tr -d ' \n'
}

# event UTIME CHANNEL HEX: as it stands in a log; the data begins with the type's fingerprint.
event() {
    local name
    name=$(hex "$2")
    bytes "$(printf 'eda1da01%016x%016x%08x%08x' 7 "$1" $((${#name} / 2)) $((${#3} / 2)))$name$3"
}

# Three events in two seconds and a quarter.
good() {
    event 1700000000000000 FMB_PAIR_QUERY ${pair_query}00112233
    event 1700000002250000 FMB_PAIR_QUERY ${pair_query}0011
    event 1700000001000001 FMB_STATUS $status
}

info() {
    run --separate-stderr "$FMB" log info "$@"
}

# field FILTER: of the JSON.
field() {
    jq -c "$1" <<< "$output"
}

# ---- Good logs -------------------------------------------------------------------------------

@test "a log is summarised as text" {
    good > "$log"
    info "$log"
    ended 0
    said ''
    is "$log: 152 bytes, 3 events
  from  2023-11-14 22:13:20.000000 UTC
  to    2023-11-14 22:13:22.250000 UTC
  2.250000 s
      events          bytes  type                        channel
           2             22  fmb_msgs.pair_query_t       FMB_PAIR_QUERY
           1              8  fmb_msgs.status_t           FMB_STATUS
  no damage"
}

@test "a log is summarised as JSON" {
    good > "$log"
    info --json "$log"
    ended 0
    said ''
    is "{\"log\": \"$log\", \"size\": 152, \"events\": 3, \"bytes\": 30, \"begin\": 1700000000000000, \"end\": 1700000002250000, \"channels\": [{\"channel\": \"FMB_PAIR_QUERY\", \"type\": \"fmb_msgs.pair_query_t\", \"events\": 2, \"bytes\": 22}, {\"channel\": \"FMB_STATUS\", \"type\": \"fmb_msgs.status_t\", \"events\": 1, \"bytes\": 8}], \"damage\": {\"places\": 0, \"bytes\": 0, \"first\": []}}"
}

@test "messages of the service have names, others their fingerprint" {
    for type in 18fc974de94f47b6 e2c4e2ab0ebcd9d9 ef476d61362c5fba $pair_query 44daa0700d3b2b97 \
        8e860009f2301ec1 3104e734f0051957 437691c0f4a35986 $status c5646e8cb4490b7c 0123456789abcdef 00; do
        event 1 A $type
    done > "$log"
    info --json "$log"
    ended 0
    [ "$(field '[.channels[] | .type] | sort')" = '[null,"0x0123456789abcdef","fmb_msgs.body_t","fmb_msgs.definition_query_t","fmb_msgs.definition_t","fmb_msgs.names_t","fmb_msgs.pair_query_t","fmb_msgs.pair_result_t","fmb_msgs.placement_t","fmb_msgs.scene_query_t","fmb_msgs.scene_result_t","fmb_msgs.status_t"]' ]
    info "$log"
    grep -Eqx ' +1 +8  0x0123456789abcdef +A' <<< "$output"
    grep -Eqx ' +1 +1  \(too short\) +A' <<< "$output"
}

@test "each channel and type is counted separately, in the order of the channels" {
    zeros=000000000000
    for i in $(seq 0 199); do
        printf -v type '%016x' $((i % 2))
        event "$i" "C$((i % 10 / 2))" "$type${zeros:0:$((2 * (i % 7)))}"
    done > "$log"
    info --json "$log"
    ended 0
    [ "$(field '[.channels[] | [.channel, .type[-1:], .events]]')" = "$(jq -nc '[range(5) as $c | range(2) as $t | ["C\($c)", "\($t)", 20]]')" ]
    [ "$(field '[([.channels[].bytes] | add) == .bytes, .bytes]')" = '[true,2194]' ]
}

@test "an empty file is a log" {
    : > "$log"
    info "$log"
    ended 0
    is "$log: empty, a log of no events"
    info --json "$log"
    ended 0
    is "{\"log\": \"$log\", \"size\": 0, \"events\": 0, \"bytes\": 0, \"channels\": [], \"damage\": {\"places\": 0, \"bytes\": 0, \"first\": []}}"
}

@test "a log of one event has no duration" {
    event -1 A '' > "$log"
    info --json "$log"
    ended 0
    [ "$(field '[.begin, .end, .events]')" = '[-1,-1,1]' ]
    info "$log"
    [[ $output == *"  from  1969-12-31 23:59:59.999999 UTC"* ]]
    [[ $output == *"  0.000000 s
"* ]]
}

@test "times of any size and order are reported" {
    event -9223372036854775808 A '' > "$log"
    event 9223372036854775807 A '' >> "$log"
    info "$log"
    ended 0
    [[ $output == *"  18446744073709.551615 s
"* ]]
    info --json "$log"
    [[ $output == *'"begin": -9223372036854775808, "end": 9223372036854775807'* ]]
}

@test "names of channels are escaped, and remain distinct" {
    event 1 '\e[2J\e]0;x\a' '' > "$log"
    event 1 'a\0b"\\' '' >> "$log"
    event 1 '\xff\xc3\xa4' '' >> "$log"
    event 1 "$(printf '%0999d' 0)" '' >> "$log"
    event 1 "$(printf '%063d' 1)" '' >> "$log"
    info "$log"
    ended 0
    # shellcheck disable=SC1003
    [[ $output == *' \x1b[2J\x1b]0;x\x07'* && $output == *' a\x00b"\'* && $output == *' �ä'* ]]
    [[ $output == *" $(printf '%0999d' 0)"* && $output == *" $(printf '%063d' 1)"* ]]
    info --json "$log"
    [ "$(field '[.channels[].channel | length]')" = '[10,999,63,5,2]' ]
    [ "$(field '.channels[3].channel')" = '"a\u0000b\"\\"' ]
    [ -z "$(tr -d '\n -~' <<< "$output")" ]
}

@test "several logs are reported in turn, and the worst sets the exit code" {
    good > "$log"
    head -c 100 "$log" > "$BATS_TEST_TMPDIR/b.log"
    info --json "$log" "$log"
    ended 0
    [ "${#lines[@]}" = 2 ]
    info "$log" "$BATS_TEST_TMPDIR/b.log" "$log"
    ended 1
    [ "$(grep -c 'bytes, . event' <<< "$output")" = 3 ]
    info "$log" "$BATS_TEST_TMPDIR/none.log" "$BATS_TEST_TMPDIR/b.log"
    ended 2
    [ "$(grep -c 'bytes, . event' <<< "$output")" = 2 ]
    said "fmb: $BATS_TEST_TMPDIR/none.log: No such file or directory"
}

# ---- Damage ----------------------------------------------------------------------------------

@test "damage is reported with its offset, and the good events are read" {
    { good && printf 'garbage' && good && event 1 A 001122 | head -c 30; } > "$log"
    info "$log"
    ended 1
    said ''
    [[ $output == "$log: 341 bytes, 6 events"* ]]
    [[ $output == *"
  damage: 2 places, 37 bytes
    at 152, 7 bytes: no event
    at 311, 30 bytes: the last event is cut off" ]]
    info --json "$log"
    ended 1
    [ "$(field '[.events, .damage]')" = '[6,{"places":2,"bytes":37,"first":[{"offset":152,"length":7,"what":"no event"},{"offset":311,"length":30,"what":"the last event is cut off"}]}]' ]
}

@test "of many damages the first are listed, and all are counted" {
    good > "$BATS_TEST_TMPDIR/good"
    for _ in $(seq 25); do cat "$BATS_TEST_TMPDIR/good" && printf '?'; done > "$log"
    info "$log"
    ended 1
    [[ $output == *"
  damage: 25 places, 25 bytes
    at 152, 1 byte: no event
"* ]]
    [ "$(grep -c '^    at ' <<< "$output")" = 20 ]
    [[ $output == *"    and 5 more" ]]
    info --json "$log"
    [ "$(field '[.damage.places, (.damage.first | length)]')" = '[25,20]' ]
}

@test "a file that is not a log is refused" {
    info README.md
    ended 2
    is ''
    said 'fmb: README.md: no event log: there is no event in it'
    info tests
    ended 2
    said 'fmb: tests: no regular file'
    mkfifo "$BATS_TEST_TMPDIR/pipe"
    info "$BATS_TEST_TMPDIR/pipe"
    ended 2
    said "fmb: $BATS_TEST_TMPDIR/pipe: no regular file"
}

# ---- The command -----------------------------------------------------------------------------

@test "names of files are printed without control characters" {
    name=$BATS_TEST_TMPDIR/$'\e[31mred'
    good > "$name"
    run "$FMB" log info "$name"
    ended 0
    [[ ${lines[0]} == "$BATS_TEST_TMPDIR/\x1b[31mred: "* ]]
    name=$BATS_TEST_TMPDIR/naïf
    good > "$name"
    run "$FMB" log info "$name"
    [[ ${lines[0]} == "$name: "* ]]
}

@test "output that cannot be written is a failure" {
    [ -w /dev/full ] || skip 'no /dev/full'
    good > "$log"
    run bash -c '"$1" log info "$2" > /dev/full' - "$FMB" "$log"
    ended 1
    is 'fmb: standard output: No space left on device'
}
