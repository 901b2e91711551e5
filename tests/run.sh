#!/bin/sh
# Builds and runs the tests, side by side on all cores, and ends with one line:
#
#   N passed, N failed[, N skipped]
#
# Exit code 0 only if none failed. With FMB_FAST set: the release build alone, smaller samples, and
# without the suites that take long. Needs what 'make deps-test' installs. The output of each suite
# stays in build/tests.log/.
set -u
cd "$(dirname "$0")/.." || exit

self=tests/run.sh
log=build/tests.log
limit=600 # seconds a suite may take before it has failed

# Where sanitizers would find nothing that they do not find elsewhere: other languages, what is
# installed, what is measured, the command lines of what unit tests go through.
unsanitized='system/examples.bats system/library.bats system/bus.bats cli/report.bats cli/page.bats'
unsanitized="$unsanitized cli/mesh_page.bats cli/log.bats cli/log_cut.bats cli/log_scene.bats"
# Those that take long, and of them where one sanitizer is enough.
long='system/soak.bats system/fairness.bats system/record.bats'
long="$long system/replay_bus.bats cli/replay.bats cli/mesh.bats"
sanitized_once="$long system/service.bats"
slow="$long cli/log.bats cli/log_cut.bats cli/log_scene.bats system/examples.bats system/bus.bats"
slow="$slow cli/page.bats cli/mesh_page.bats"

# A suite writes TAP; 77 means that it cannot run here.
#   unit BUILD NAME | bats BUILD FILE | netns BUILD FILE | headers BUILD -
run_suite() {
    kind=$1 build=$2 what=$3
    export FMB_BUILD="$build" CMOCKA_MESSAGE_OUTPUT=TAP
    case $build in *asan*) export FMB_FAST=1 ;; esac
    case $kind in
    unit) timeout "$limit" "$build/tests/$what" ;;
    bats) timeout "$limit" bats --tap "tests/$what" ;;
    netns) timeout "$limit" "$build/netns" bats --tap "tests/$what" ;;
    esac
}

# Counts of one suite's TAP: "passed failed skipped". A test that the plan promises and nothing
# is heard of has failed; so has a suite that ends badly though all its tests passed.
count_suite() {
    awk -v code="$2" '
        /^1\.\.[0-9]+/ { planned += substr($1, 4); plans++ }
        /^ok .*# *(skip|SKIP)/ || /^not ok .*# *SKIP/ { skipped++; next }
        /^ok [0-9]/ { passed++ }
        /^not ok [0-9]/ { failed++ }
        END {
            seen = passed + failed + skipped
            if (planned > seen) failed += planned - seen
            if (!failed && (code != 0 || !plans)) failed++
            print passed + 0, failed + 0, skipped + 0
        }' "$1"
}

name_of() {
    echo "$1 $2 $3" | tr ' /' '._'
}

one() {
    kind=$1 build=$2 what=$3
    out=$log/$(name_of "$kind" "$build" "$what")
    begin=$(date +%s)
    run_suite "$kind" "$build" "$what" > "$out.tap" 2> "$out.err" < /dev/null
    code=$?
    if [ "$kind" = netns ] && [ $code = 77 ]; then
        counts="0 0 $(grep -c '^@test' "tests/$what")"
    else
        counts=$(count_suite "$out.tap" $code)
    fi
    echo "$counts" > "$out.count"
    # shellcheck disable=SC2086
    set -- $counts
    printf '%-12s %-34s %4d s %4d passed' "$(basename "$build")" "$what" $(($(date +%s) - begin)) "$1"
    [ "$2" = 0 ] || printf ', %d failed' "$2"
    [ "$3" = 0 ] || printf ', %d skipped' "$3"
    echo
    [ "$2" = 0 ] || {
        grep -A12 '^not ok' "$out.tap" | head -n 60
        tail -n 20 "$out.err"
    }
}

if [ "${1-}" = --suite ]; then
    # shellcheck disable=SC2086
    set -- $2
    one "$@"
    exit 0
fi

# build OPTIONS...: a build that fails is a failure to report, not a reason to be silent.
build() {
    make -s -j"$(nproc)" ${CI:+WERROR=1} "$@" > build/tests.build 2>&1 || {
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

# is_one_of FILE LIST
is_one_of() {
    case " $2 " in *" $1 "*) ;; *) return 1 ;; esac
}

# wants BUILD FILE: whether the suite runs on this build.
wants() {
    [ -n "${FMB_FAST-}" ] && is_one_of "$2" "$slow" && return 1
    case $1 in
    *asan-clang) ! is_one_of "$2" "$unsanitized $sanitized_once" ;;
    *asan) ! is_one_of "$2" "$unsanitized" ;;
    esac
}

# list_bats KIND BUILD FOLDER
list_bats() {
    for file in tests/"$3"/*.bats; do
        file=$3/$(basename "$file")
        if wants "$2" "$file"; then echo "$1 $2 $file"; fi
    done
}

# Of a build with threads only the one suite that uses them was built.
list() {
    for build in "$@"; do
        [ "$build" = "$threads" ] || list_bats netns "$build" system # they wait much: first
        list_units "$build"
        [ "$build" = "$threads" ] || list_bats bats "$build" cli
    done
}

rm -rf "$log"
mkdir -p "$log"
threads=build/release-openmp
rm -rf build/tests build/asan/tests build/asan-clang/tests $threads/tests
build format-check headers tests
builds=build
if [ -z "${FMB_FAST-}" ]; then
    build MODE=asan tests
    build MODE=asan CC=clang tests
    build OPENMP=1 $threads/tests/test_engine_batch
    build MODE=fuzz fuzzers
    builds="build build/asan build/asan-clang $threads"
fi
# Fuzzers have a suite of their own.
all() {
    list "$@"
    [ -n "${FMB_FAST-}" ] || echo "bats build/fuzz-clang fuzz/fuzz.bats"
}

# Until it has ended, a suite has failed.
# shellcheck disable=SC2086
all $builds | while read -r kind build what; do
    echo "0 1 0" > "$log/$(name_of "$kind" "$build" "$what").count"
done
# In a hurry one more than there are cores: suites that wait for a bus leave theirs to others.
jobs=$(nproc)
[ -z "${FMB_FAST-}" ] || jobs=$((jobs + 1))
# shellcheck disable=SC2086
all $builds | xargs -d '\n' -n 1 -P "$jobs" "$self" --suite

awk '{ p += $1; f += $2; s += $3 }
    END {
        printf "%d passed, %d failed", p, f
        if (s) printf ", %d skipped", s
        print ""
        exit f || !p
    }' "$log"/*.count
