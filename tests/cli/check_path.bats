# fmb-check-path: proofs of paths that are right, and faults of all kinds in files and in the program itself.

load ../ran

setup() {
    export PYTHONDONTWRITEBYTECODE=1
    python=/usr/bin/python3
    [ -x $python ] || skip "needs python3"
}

# -S: without the folders that packages are in.
@test "proofs of robots whose clearance is known, those of fmb path, and each fault in a file" {
    FMB=$FMB_BUILD/fmb $python -S tests/python/test_check_path.py -v
}

# wrong TEST OLD NEW: the test fails of a program in which a text, which is there once, is replaced.
wrong() {
    local program
    program=$(< clients/robot/fmb-check-path)
    [ "$(grep -cF -e "$2" <<< "$program")" = 1 ] || { echo "not once: $2"; return 1; }
    printf '%s\n' "${program/"$2"/"$3"}" > "$BATS_TEST_TMPDIR/program"
    ! FMB_SAMPLE=1 CHECK_PATH=$BATS_TEST_TMPDIR/program $python -S tests/python/test_check_path.py "$1" > "$BATS_TEST_TMPDIR/said" 2>&1 ||
        { echo "not found by $1: $2"; return 1; }
    grep -q '^FAILED (failures=[0-9]*)$' "$BATS_TEST_TMPDIR/said" # and not by an exception
}

@test "wrong bounds in the program are found" {
    poses=Random.test_no_interval_that_holds_is_contradicted_by_a_pose
    curves=Random.test_speed_and_curvature_are_within_the_bounds
    wrong Known.test_each_kind_of_interval_proves '>> 2 * depth + 3' '>> 2 * depth + 4'
    wrong $poses 'most + clearance' '0'
    wrong $poses 'for s in (0, END)' 'for s in (0, 0)'
    wrong $curves 'turning + 2 * spin' 'turning + spin'
    wrong $curves 'steps = [self' 'steps = [0 * self'
}
