#!/bin/sh
# record.sh BUILD_DIR [SECONDS]: how much of what the bus carries a recording holds, and where the
# remainder was lost: fmb record, and lcm-logger, as it is and with a larger receive buffer, in turns;
# where the user may, also fmb record scheduled before all others (chrt). One line for each trial. What
# is written goes to BUILD_DIR/soak/, and is removed.
set -u

self=$0
build=${1:?usage: record.sh BUILD_DIR [SECONDS]}
seconds=${2:-5}
out=$build/soak
log=$out/record.log
url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304'

# Dropped since the socket's buffer was full: here is no socket but the recorder's.
overflowed() {
    awk '/^Udp: [0-9]/ { print $6 }' /proc/net/snmp
}

# Up to a minute.
wait_until() {
    tries=1200
    until "$@" || [ $tries = 0 ]; do
        tries=$((tries - 1))
        sleep 0.05
    done
}

# receives: whether the recorder's socket and log exist. has_read: whether the socket is empty, and the log
# has not grown since the last call.
receives() {
    [ -e "$log" ] && grep -q ':1DF3 ' /proc/net/udp
}
has_read() {
    before=${size-}
    size=$(stat -c %s "$log")
    [ "$size" = "$before" ] && ! grep ':1DF3 ' /proc/net/udp | grep -qv ' 00000000:00000000 '
}

# one RECORDER WHAT RATE: in a network of its own.
one() {
    rm -f "$log"
    case $1 in
    fmb) "$build/fmb" record --json "$log" > "$out/record.json" 2> /dev/null & ;;
    fmb-first) chrt -f 10 "$build/fmb" record --json "$log" > "$out/record.json" 2> /dev/null & ;;
    lcm-logger) lcm-logger -q "$log" 2> /dev/null & ;;
    lcm-logger-4MB) lcm-logger -q --lcm-url="$url" "$log" 2> /dev/null & ;;
    esac
    recorder=$!
    wait_until receives
    blast=$("$build/soak-blast" "$2" "$3" "$seconds")
    wait_until has_read
    cpu=$(awk '{ print $14 + $15 }' "/proc/$recorder/stat")
    kill -INT $recorder
    wait $recorder
    kept=$("$build/events" "$log" | wc -l)
    echo "$blast" | jq -r --arg who "$1" --argjson kept "$kept" \
        --argjson socket "$(overflowed)" --argjson cpu "$cpu" '
        [$who, .what, .bytes, .rate, .mb_per_s, .sent, .sent - $kept,
         ((.sent - $kept) / .sent * 1000 | round / 10), $socket,
         .sent - $kept - $socket, $cpu / 100] | @tsv'
    rm -f "$log"
}

if [ "${3-}" = --one ]; then
    shift 3
    one "$@"
    exit
fi

recorders='fmb lcm-logger lcm-logger-4MB'
if chrt -f 10 true 2> /dev/null; then recorders="fmb-first $recorders"; fi
mkdir -p "$out"
printf 'recorder\twhat\tbytes\trate\tMB/s\tsent\tlost\t%%\tin the socket\telsewhere\tCPU s\n'
for trial in 'pairs 20000' 'pairs 50000' 'pairs 100000' 'pairs 0' 'scenes 1000' 'scenes 3000' \
    'scenes 6000' 'scenes 0'; do
    for recorder in $recorders; do
        # shellcheck disable=SC2086
        "$build/netns" "$self" "$build" "$seconds" --one $recorder $trial
    done
done
