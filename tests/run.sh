#!/bin/sh
# Builds and runs the tests, side by side on all cores, and ends with one line:
#
#   N passed, N failed[, N skipped]
#
# A line before it gives the reasons of skipped tests. Exit code 0 only if none failed. With FMB_FAST
# set: only the release build, smaller samples, and without the suites that take long. Needs what
# 'make deps-test' installs. The output of each suite stays in build/tests.log/.
set -u
cd "$(dirname "$0")/.." || exit

self=tests/run.sh
log=build/tests.log
limit=600 # seconds a suite may take before it has failed

# Two builds. Release: every suite. Sanitizers, of clang: unit tests, fuzzers, the goldens, which another
# compiler must reproduce, and the suites that exercise the programs most; without the kernels of newer
# instruction sets, which are the same source and take long to compile.
release=build
asan=build/asan-clang-two
sanitized='system/service.bats system/daemon.bats system/record.bats system/replay_bus.bats'
sanitized="$sanitized system/soak.bats cli/query.bats cli/replay.bats cli/mesh.bats"

# The suites of the release build that wait more than they compute. They begin as soon as the programs are
# built, while unit tests and the other build are compiled.
waiting='cli/page.bats system/replay_bus.bats system/daemon.bats system/service.bats system/record.bats'
waiting="$waiting system/examples.bats"

# Those that take longest, which begin first; and what 'make test-fast' leaves out.
first='fuzz/fuzz.bats cli/campaign.bats cli/page.bats test_engine_small_world cli/build.bats test_client_query'
first="$first test_engine_round system/service.bats system/record.bats system/daemon.bats system/replay_bus.bats"
first="$first cli/scene.bats cli/check_path.bats cli/query.bats cli/replay.bats system/library.bats system/fairness.bats"
first="$first system/soak.bats test_engine_wants test_engine_hard test_answer_scene test_engine_work test_engine_hull"
first="$first cli/log_results.bats test_checked test_client_pace test_queue test_replay_run system/examples.bats"
first="$first test_server_turns test_engine_scene test_engine_batch test_page"
slow='system/soak.bats system/fairness.bats system/record.bats system/replay_bus.bats cli/replay.bats'
slow="$slow cli/mesh.bats cli/log.bats cli/log_cut.bats cli/log_scene.bats cli/log_results.bats system/examples.bats"
slow="$slow system/library.bats system/python.bats system/bus.bats cli/page.bats cli/campaign.bats cli/bench.bats"
slow="$slow cli/build.bats cli/check_path.bats"

# A suite writes TAP; 77 means that it cannot run here.
#   unit BUILD NAME | bats BUILD FILE | netns BUILD FILE
run_suite() {
    kind=$1 build=$2 what=$3
    export FMB_BUILD="$build" FMB_TOOLS="$release" CMOCKA_MESSAGE_OUTPUT=TAP
    # Samples that fit into the time of a run; a suite by itself draws all of its own. Sanitizers look
    # at paths, not at answers: fewer samples take them all.
    case $build in
    "$release") sample=${FMB_FAST:+1} sample=${sample:-0.5} ;;
    "$asan")
        # Longer allocation traces, and checks of strstr(), cost a tenth of the time.
        export FMB_FAST=1 ASAN_OPTIONS=malloc_context_size=3:intercept_strstr=0
        case $what in
        test_engine_gap | test_hull_*) sample=0.5 ;; # draw few
        test_*) sample=0.2 ;;
        # Unit tests look for leaks; that would double the time of a command.
        *) sample=1; ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 ;;
        esac
        ;;
    esac
    export FMB_SAMPLE="${FMB_SAMPLE-$sample}"
    # The tag 'release': other tests with sanitizers execute the same code.
    paths=
    [ "$build" = "$release" ] || paths="--filter-tags !release"
    # shellcheck disable=SC2086
    case $kind in
    unit) timeout "$limit" "$build/tests/$what" ;;
    bats) timeout "$limit" bats --tap $paths "tests/$what" ;;
    netns) timeout "$limit" "$build/netns" bats --tap $paths "tests/$what" ;;
    esac
}

# summarise OUT CODE BEGIN END: of one suite's TAP, in OUT.count "passed failed skipped", and a line with
# the times. A test that the plan promises and that does not report has failed; so has a suite that ends
# badly though all its tests passed. In OUT.times the last line is about processes that have ended.
summarise() {
    awk -v out="$1" -v code="$2" -v begin="$3" -v end="$4" -v build="${build##*/}" -v what="$what" '
        FNR == 1 { file++ }
        file == 2 { split($1, user, "m"); split($2, kernel, "m"); next }
        /^1\.\.[0-9]+/ { planned += substr($1, 4); plans++ }
        /^ok .*# *(skip|SKIP)/ || /^not ok .*# *SKIP/ { skipped++; next }
        /^ok [0-9]/ { passed++ }
        /^not ok [0-9]/ { failed++ }
        END {
            seen = passed + failed + skipped
            if (planned > seen) failed += planned - seen
            if (!failed && (code != 0 || !plans)) failed++
            print passed + 0, failed + 0, skipped + 0 > (out ".count")
            printf "%-14s %-32s %4d s, %4d of CPU %4d passed", build, what, end - begin + 0.5,
                60 * (user[1] + kernel[1]) + user[2] + kernel[2] + 0.5, passed
            if (failed) printf ", %d failed", failed
            print skipped ? ", " skipped " skipped" : ""
            exit failed > 0
        }' "$1.tap" "$1.times"
}

# reasons FILE...: reads TAP; prints the reasons of skipped tests in one line. A test that was skipped
# without a reason is named.
reasons() {
    cat "$@" | sed -nE '/^(not )?ok .*# *(skip|SKIP)/ {
        s/.*# *(skip|SKIP) +(.*[^ ]) *$/\2/; t print
        s/^(not )?ok [0-9]+ *-? *//; s/ *# *(skip|SKIP).*//
        : print
        p
    }' | sort | uniq -c | sort -k1,1nr -k2 | awk '
        { count = $1; sub(/^ *[0-9]+ */, ""); printf "%s%d %s", (NR > 1 ? "; " : "skipped: "), count, $0 }
        END { if (NR) print "" }'
}

# out_of KIND BUILD WHAT: where its output goes, in $out.
out_of() {
    out=$1.$2.$3
    while [ "$out" != "${out#*/}" ]; do out=${out%%/*}_${out#*/}; done
    out=$log/$out
}

# one KIND BUILD WHAT: starts few processes besides those of the suite, as many suites are short.
one() {
    kind=$1 build=$2 what=$3
    out_of "$@"
    read -r begin _ < /proc/uptime
    run_suite "$kind" "$build" "$what" > "$out.tap" 2> "$out.err" < /dev/null
    code=$?
    times > "$out.times"
    read -r end _ < /proc/uptime
    if [ "$kind" = netns ] && [ $code = 77 ]; then
        sed -n 's/^@test.*/ok # skip needs a network namespace, or a route for multicast/p' "tests/$what" > "$out.tap"
        echo "1..$(wc -l < "$out.tap")" >> "$out.tap"
        code=0
    fi
    summarise "$out" $code "$begin" "$end" || {
        grep -A12 '^not ok' "$out.tap" | head -n 60
        tail -n 20 "$out.err"
    }
}

if [ "${1-}" = --reasons ]; then
    shift
    reasons "$@"
    exit 0
fi
if [ "${1-}" = --suite ]; then
    # shellcheck disable=SC2086
    set -- $2
    one "$@"
    exit 0
fi

beside= # the process that runs suites beside a build

# build OPTIONS...: a build that fails is a failure to report, not a reason to be silent.
build() {
    make -s -j"$(nproc)" ${CI:+WERROR=1} "$@" > build/tests.build 2>&1 || {
        [ -z "$beside" ] || { kill "$beside"; wait "$beside"; }
        cat build/tests.build
        echo "make $*: the build failed"
        echo "0 passed, 1 failed"
        exit 1
    }
}

list_units() {
    for test in "$1"/tests/test_*; do
        [ -x "$test" ] && echo "unit $1 $(basename "$test")"
    done
}

# list_bats BUILD FILE...: system suites have a network of their own.
list_bats() {
    build=$1
    shift
    for file in "$@"; do
        case $file in
        system/*) echo "netns $build $file" ;;
        *) echo "bats $build $file" ;;
        esac
    done
}

list_release() {
    for file in tests/system/*.bats tests/cli/*.bats; do
        file=${file#tests/}
        case "${FMB_FAST:+ $slow }" in *" $file "*) continue ;; esac
        list_bats $release "$file"
    done
    list_units $release
}

list_all() {
    list_release
    [ -z "${FMB_FAST-}" ] || return 0
    # shellcheck disable=SC2086
    list_bats $asan $sanitized fuzz/fuzz.bats cli/replay_set.bats
    list_units $asan
}

# run_suites LIST PROCESSES: in a process of its own, which a signal ends. Until it has ended, a suite has failed.
run_suites() {
    while read -r kind build what; do
        out_of "$kind" "$build" "$what"
        echo "0 1 0" > "$out.count"
    done < "$1"
    exec xargs -d '\n' -n 1 -P "$2" "$self" --suite < "$1"
}

rm -rf "$log"
mkdir -p "$log"
rm -rf $release/tests $asan/tests
if [ -z "${FMB_FAST-}" ]; then
    build PEERS=none tested-programs examples
    list_release | awk -v those=" $waiting " 'index(those, " " $3 " ")' > "$log/waiting"
    run_suites "$log/waiting" 1 &
    beside=$!
fi
build PEERS=none headers layers ${FMB_FAST:+fast-}tests
if [ -z "${FMB_FAST-}" ]; then
    build MODE=asan INSTRUCTIONS=two programs unit-tests fuzzers replay-set
    [ ! -d build/aarch64/usr ] || build aarch64
fi
touch "$log/waiting"
list_all | grep -vxFf "$log/waiting" | awk -v first="$first" 'BEGIN { count = split(first, name) }
    { line[NR] = $0; what[NR] = $3 }
    END {
        for (i = 1; i <= count; i++)
            for (k = 1; k <= NR; k++)
                if (what[k] == name[i]) { print line[k]; delete line[k] }
        for (k = 1; k <= NR; k++)
            if (k in line) print line[k]
    }' > "$log/list"

# One more than there are cores: suites that wait for a bus leave theirs to others.
(run_suites "$log/list" $(($(nproc) + 1)))
[ -z "$beside" ] || wait "$beside"

cat "$log"/netns.*.count | awk '$1 + $2 { ran = 1 } END { exit !ran }' ||
    echo "no test of the bus ran: no network namespace, and no route for multicast"

reasons "$log"/*.tap
awk '{ p += $1; f += $2; s += $3 }
    END {
        printf "%d passed, %d failed", p, f
        if (s) printf ", %d skipped", s
        print ""
        exit f || !p
    }' "$log"/*.count
