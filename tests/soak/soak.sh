#!/bin/sh
# soak.sh BUILD_DIR [SECONDS]: clients that know the answers query a service to which bad things are
# done. One line for each trial, what went on in build/soak/; exit code 0 only if no answer was lost
# and none was wrong.
set -u

build=${1:?usage: soak.sh BUILD_DIR [SECONDS [TRIAL]]}
tools=${FMB_TOOLS:-$build}
seconds=${2:-60}
trial=${3-}
out=$build/soak
# Pair queries a second: of a machine of two cores 80 % of what the bare echo takes without loss is
# some 50,000 (make bench-bus).
rate=${FMB_SOAK_RATE:-25000}
ids=${FMB_SOAK_IDS:-10000000}
channels=${FMB_SOAK_CHANNELS:-300000}

trials='rate pairs scenes crowd killed crash-packets hostile lossy halved ids channels fair floods ageing'

mkdir -p "$out" || exit 1
log=$out/$trial.log
started=

start() {
    "$@" >> "$log" 2>&1 &
    started="$started $!"
}

stop_all() {
    for pid in $started; do
        kill "$pid" && wait "$pid"
    done 2> /dev/null
    started=
}

# start_fmbd [OPTIONS]
start_fmbd() {
    "$build/fmbd" "$@" 2> "$out/$trial.fmbd" &
    fmbd=$!
    echo $fmbd > "$out/$trial.pid"
    tries=100
    until grep -q ready "$out/$trial.fmbd"; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || { echo "soak.sh: fmbd did not start" >&2; exit 1; }
        sleep 0.1
    done
}

# every PERIOD COMMAND...: again and again, until it is ended.
every() {
    period=$1
    shift
    while :; do
        "$@"
        sleep "$period"
    done
}

# As a service manager does.
restart() {
    kill -KILL "$(cat "$out/$trial.pid")"
    start_fmbd
}

send_crash_packets() {
    "$tools/crash-liblcm" wrap FMB_PAIR_QUERY
    "$tools/crash-liblcm" short FMB_SCENE_QUERY
}

# share ATTACK [OPTIONS]: the share of a client beside an attack. A share that is too small because
# other programs kept the machine busy is reported as skipped, not as a failure. Each takes a tenth of
# the time, since there are many.
share() {
    "$tools/soak-fair" "$@" --service "$fmbd" --seconds $(((seconds + 9) / 10))
    case $? in
    0) ;;
    77) echo "skipped: other programs used more than a tenth of the machine" ;;
    *) code=1 ;;
    esac
}

# One query under way, at each turnaround; scenes, and eight pairs under way, beside each attack.
fair() {
    code=0
    for attack in pairs mixed certificates boxes; do
        for ids in 1 2 4; do
            for turnaround in 0 5 20 60 150 400 1000; do
                share $attack --ids $ids --turnaround $turnaround
            done
        done
    done
    for attack in pairs mixed certificates boxes bodies rate flood definitions ids; do
        share $attack --window 8
        share $attack --scenes
    done
    return $code
}

# Beside clients that send without waiting for answers.
floods() {
    code=0
    for ids in 1 2; do
        share rate --and certificates --ids $ids
        share rate --and flood --ids $ids
    done
    share flood --ids 2
    share flood --ids 4
    return $code
}

# After a flood of certificates that take minutes to compute: nothing waits by the sixth heartbeat, one
# a second.
ageing() {
    "$tools/soak-fair" flood --seconds "$seconds" --headroom 1000 --ids 4 >> "$log"
    for _ in 1 2 3 4 5 6; do
        counts=$("$build/fmb" status --json |
            jq -c '{received, answered, unsent, expired, refusals_unsent, waiting} + (.results | {OK, BUSY})')
        if echo "$counts" | jq -e '.waiting == 0' >> "$log"; then break; fi
    done
    echo "$counts"
    echo "$counts" | jq -e '.waiting == 0 and .BUSY > 0' >> "$log"
}

damage() {
    for type in pair_query scene_query definition_query pair_result scene_result definition status; do
        "$tools/fake-peer" FMB_PAIR_QUERY $type
        "$tools/fake-peer" FMB_SCENE_QUERY $type
    done
}

load() {
    "$tools/soak-load" --seconds "$seconds" "$@"
}

# One datagram in a hundred is lost, one in a hundred overtaken: by the kernel, where it can.
lose_in_kernel() {
    tc qdisc add dev lo root netem delay 200us reorder 99% loss 1% 2> /dev/null
}

# lose_in_relay LOST OVERTAKEN: percent.
lose_in_relay() {
    start "$tools/soak-relay" 7667 7668 "$1" "$2"
    LCM_DEFAULT_URL='udpm://239.255.76.67:7668?ttl=0'
    export LCM_DEFAULT_URL
}

run_trial() {
    start_fmbd
    case $trial in
    rate) "$tools/soak-rate" "$rate" "$seconds" ;;
    pairs) load --clients 8 ;;
    scenes) load --clients 2 --pairs 900 ;;
    crowd) load --clients 16 --pairs 40 ;;
    killed) start every 1 restart; load --clients 4 --pairs 40 ;;
    crash-packets) start every 0.5 send_crash_packets; load --clients 4 --pairs 40 ;;
    hostile) damage >> "$log" 2>&1; start every 0 damage; load --clients 4 --pairs 40 ;;
    lossy) lose_in_kernel || lose_in_relay 1 1; load --clients 4 --pairs 40 ;;
    halved) lose_in_relay 30 0; load --clients 3 --pairs 500 --single 1 ;;
    ids) "$tools/soak-memory" ids "$fmbd" "$ids" ;;
    channels) "$tools/soak-memory" channels "$fmbd" "$channels" ;;
    fair) fair ;;
    floods) floods ;;
    ageing) ageing ;;
    esac
}

# Inside of a network of its own.
if [ -n "$trial" ]; then
    trap stop_all EXIT
    trap 'exit 1' HUP INT TERM
    bus=${LCM_DEFAULT_URL-} # a trial may lead its clients to a relay
    run_trial
    code=$?
    stop_all
    export LCM_DEFAULT_URL="$bus"
    "$build/fmb" status --json > "$out/$trial.status" 2> /dev/null
    # A service that restart() started is no child of this shell.
    fmbd=$(cat "$out/$trial.pid")
    kill "$fmbd"
    [ "$trial" = killed ] || wait "$fmbd" || code=1
    exit $code
fi

worst=0
for trial in $trials; do
    printf '%-9s ' "$trial"
    "$build/netns" "$0" "$build" "$seconds" "$trial" > "$out/$trial.json" 2> "$out/$trial.err"
    code=$?
    if [ $code = 0 ]; then
        cat "$out/$trial.json"
    else
        worst=1
        echo "FAILED: $(cat "$out/$trial.json" "$out/$trial.err")"
    fi
done
exit $worst
