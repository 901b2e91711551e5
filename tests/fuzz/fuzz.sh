#!/bin/sh
# Fuzzing that takes longer than a test may:
#
#   fuzz.sh fuzz         all targets with libFuzzer, side by side on all cores: FUZZ_RUNS executions
#                        of each (10,000,000; of replay_log, each of which replays a log several
#                        times, a hundredth), a tenth of that guided by values too, and a hundredth
#                        with inputs of a datagram's size. Exit code 1 if anything was found
#   fuzz.sh fuzz-afl     the same with AFL++, FUZZ_SECONDS of each (60)
#   fuzz.sh fuzz-merge   rebuilds tests/fuzz/corpus: the files there with names of their own, and the
#                        fewest inputs that reach all other branches which the corpus and the inputs
#                        of earlier runs reach
#
# New inputs go to build/fuzz/corpus, with which the next run begins too; findings go to
# build/fuzz/findings. Needs what 'make deps-fuzz' installs.
set -u
cd "$(dirname "$0")/../.." || exit

self=tests/fuzz/fuzz.sh
out=build/fuzz
# Those that take longest first.
targets='replay_log answer scene_json robot_files event_log mesh scene_query scene_result definition pair_result
    pair_query definition_query status'
runs=${FUZZ_RUNS:-10000000}
seconds=${FUZZ_SECONDS:-60}
large=66000 # bytes: a little more than a datagram

# The longest input of a target, bytes, in the first two legs.
length_of() {
    case $1 in
    answer) echo 1280 ;; # the longest seed of a scene
    scene_json) echo 1024 ;;
    replay_log) echo 4096 ;;
    *) echo 2048 ;;
    esac
}

runs_of() {
    case $1 in
    replay_log) echo $((runs / 100)) ;;
    *) echo "$runs" ;;
    esac
}

# Where the whole engine is in the program, how often a branch was taken makes too many inputs new.
options_of() {
    case $1 in answer | scene_json | replay_log | robot_files) echo -entropic=0 -use_counters=0 ;; esac
    [ ! -f "tests/fuzz/$1.dict" ] || echo "-dict=tests/fuzz/$1.dict"
}

# libfuzzer TARGET OPTIONS... Stack traces of allocations are short, since long ones cost too much.
# Time limits only find inputs that hang, since a process may be stopped for minutes.
libfuzzer() {
    target=$1
    shift
    # shellcheck disable=SC2046
    ASAN_OPTIONS=malloc_context_size=3 nice "build/asan-clang/fuzz_$target" -timeout=1200 -report_slow_units=1200 \
        -rss_limit_mb=4096 -print_final_stats=1 \
        $(options_of "$target") "$@"
}

# The numbers after a word in the logs of a target: their sum, and the largest.
numbers_of() {
    sed -n "s/.*$2 *\([0-9][0-9]*\).*/\1/p" "$out/log/$1" "$out/log/$1".* 2> /dev/null
}

sum_of() {
    numbers_of "$@" | awk '{ sum += $1 } END { print sum + 0 }'
}

most_of() {
    numbers_of "$@" | sort -n | tail -n 1
}

grouped() {
    echo "$1" | sed -e :a -e 's/\([0-9]\)\([0-9]\{3\}\)\($\|,\)/\1,\2\3/;ta'
}

count_files() {
    find "$1" -type f -name "$2" 2> /dev/null | wc -l
}

say() {
    printf '%-13s %12s executions %6d s %4d findings %6d inputs %6d branches\n' "$@"
}

# leg TARGET LOG RUNS OPTIONS...
leg() {
    target=$1 log=$2 executions=$3
    shift 3
    libfuzzer "$target" -runs="$executions" -artifact_prefix="$out/findings/$target-" "$@" \
        "$out/corpus/$target" "tests/fuzz/corpus/$target" > "$out/log/$log" 2>&1
}

# The second leg is guided by compared values, which finds limits that are off by one.
fuzz_one() {
    mkdir -p "$out/corpus/$1"
    begun=$(date +%s)
    count=$(runs_of "$1")
    leg "$1" "$1" "$count" -max_len="$(length_of "$1")" &&
        leg "$1" "$1.values" $((count / 10)) -max_len="$(length_of "$1")" -use_value_profile=1 &&
        leg "$1" "$1.large" $((count / 100)) -max_len=$large -len_control=0
    failed=$?
    found=$(count_files "$out/findings" "$1-*")
    [ $failed = 0 ] || [ "$found" != 0 ] || found=1 # it could not even begin
    say "$1" "$(grouped "$(sum_of "$1" number_of_executed_units:)")" $(($(date +%s) - begun)) \
        "$found" "$(count_files "$out/corpus/$1" '*')" "$(most_of "$1" cov:)" > "$out/log/$1.said"
}

# The executions so far of a running target.
so_far() {
    case $verb in
    --afl) afl_stat "$1" execs_done ;;
    *) sed -n 's/^#\([0-9]*\).*/\1/p' "$out/log/$1" | tail -n 1 ;;
    esac
}

# Reports the progress of all targets while process PID runs.
progress() {
    while kill -0 "$1" 2> /dev/null; do
        sleep 10
        for target in $targets; do
            [ -f "$out/log/$target" ] && [ ! -f "$out/log/$target.said" ] &&
                printf ' %s %s' "$target" "$(grouped "$(so_far "$target")")"
        done | sed "s/^/so far:/;s/\$/$([ -t 2 ] && printf '\\x1b[K\\r')/" >&2
        [ -t 2 ] || echo >&2
    done
}

# each VERB: runs all targets side by side, then prints their reports; exit code 1 if anything was
# found.
each() {
    verb=$1
    rm -rf "$out/log" "$out/findings"
    mkdir -p "$out/log" "$out/findings"
    echo "$targets" | tr ' ' '\n' | xargs -n 1 -P "$(nproc)" "$self" "$verb" &
    pid=$!
    trap 'kill $pid 2> /dev/null; exit 130' INT TERM
    progress $pid
    wait
    found=0
    for target in $targets; do
        cat "$out/log/$target.said" || found=1
        grep -q ' 0 findings' "$out/log/$target.said" || found=1
    done
    [ $found = 0 ] || echo "what was found is in $out/findings; $out/log says more" >&2
    exit $found
}

build_with() {
    # shellcheck disable=SC2086
    make -s -j"$(nproc)" MODE=asan CC="$1" $2 || exit
}

# ---- AFL++ ----

afl=build/asan-afl-clang-fast

afl_stat() {
    sed -n "s/^$2 *: *\([0-9]*\).*/\1/p" "$out/afl/$1/default/fuzzer_stats" 2> /dev/null
}

afl_one() {
    target=$1
    dictionary=
    [ ! -f "tests/fuzz/$1.dict" ] || dictionary="-x tests/fuzz/$1.dict"
    rm -rf "$out/afl/$target"
    mkdir -p "$out/afl/$target"
    begun=$(date +%s)
    # shellcheck disable=SC2086
    AFL_NO_UI=1 AFL_SKIP_CPUFREQ=1 AFL_NO_AFFINITY=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 \
        nice afl-fuzz -V "$seconds" -m none -t 5000 $dictionary -i "tests/fuzz/corpus/$target" \
        -o "$out/afl/$target" "$afl/fuzz_$target" > "$out/log/$target" 2>&1
    crashes=$(afl_stat "$target" saved_crashes) hangs=$(afl_stat "$target" saved_hangs)
    for found in "$out/afl/$target"/default/crashes/id* "$out/afl/$target"/default/hangs/id*; do
        [ -f "$found" ] && cp "$found" "$out/findings/$target-${found##*/}"
    done
    say "$target" "$(grouped "$(afl_stat "$target" execs_done)")" $(($(date +%s) - begun)) \
        $((${crashes:-1} + ${hangs:-0})) "$(afl_stat "$target" corpus_count)" \
        "$(afl_stat "$target" edges_found)" \
        > "$out/log/$target.said"
}

# ---- The corpus ----

# Only branches count, not how often each is taken: that would keep hundreds of files.
merge_one() {
    target=$1 corpus=tests/fuzz/corpus/$1 old=$out/merged/$1
    rm -rf "$old"
    mkdir -p "$out/merged" "$corpus" "$out/corpus/$target" "$out/afl/$target/default/queue"
    cp -r "$corpus" "$old"
    find "$corpus" -type f | grep -E '/[0-9a-f]{40}$' | xargs -r rm
    [ "$target" != scene_json ] || cp clients/demo/cube.json tests/cases/*.json "$corpus"
    libfuzzer "$target" -merge=1 -use_counters=0 -max_len=$large "$corpus" "$old" \
        "$out/corpus/$target" "$out/afl/$target/default/queue" > "$out/merged/$target.log" 2>&1 || {
        tail -n 20 "$out/merged/$target.log"
        exit 1
    }
    echo "$target: $(count_files "$corpus" '*') files, $(du -bs "$corpus" | cut -f 1) bytes"
}

case ${1-} in
fuzz) build_with clang fuzzers && each --fuzz ;;
fuzz-afl)
    build_with afl-clang-fast "$(for t in $targets; do echo "$afl/fuzz_$t"; done)" && each --afl
    ;;
fuzz-merge)
    build_with clang fuzzers
    for target in $targets; do merge_one "$target"; done
    ;;
--fuzz) fuzz_one "$2" ;;
--afl) afl_one "$2" ;;
*)
    sed -n '2,/^set/s/^# \{0,1\}//p' "$self" >&2
    exit 2
    ;;
esac
