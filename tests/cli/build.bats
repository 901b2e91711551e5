# What 'make' prints.

# make_arm OPTIONS: one program of one file, elsewhere, anew.
make_arm() {
    rm -rf "$BATS_TEST_TMPDIR"/[bo]
    run env -u MAKEFLAGS -u MAKELEVEL make O="$BATS_TEST_TMPDIR/o" B="$BATS_TEST_TMPDIR/b" "$@" "$BATS_TEST_TMPDIR/b/arm"
    [ "$status" = 0 ]
    [ -x "$BATS_TEST_TMPDIR/b/arm" ]
}

@test "make prints a line a file, with V=1 the commands, and with -s nothing" {
    make_arm
    [ "$output" = "  CC    clients/demo/arm.c"$'\n'"  LD    $BATS_TEST_TMPDIR/b/arm" ]
    make_arm V=1
    [[ ${lines[-2]} == *' -c clients/demo/arm.c '* && ${lines[-1]} == *" -o $BATS_TEST_TMPDIR/b/arm "* ]]
    [[ $output != *'  CC  '* ]]
    make_arm -s
    [ -z "$output" ]
}

@test "without lcm-gen, make says what to run" {
    make=$(command -v make)
    run env -u MAKEFLAGS -u MAKELEVEL PATH=/nonexistent "$make" GEN="$BATS_TEST_TMPDIR" "$BATS_TEST_TMPDIR/fmb_msgs_body_t.h"
    [ "$status" != 0 ]
    [[ $output == *"no lcm-gen here; 'make deps' installs"* ]]
}
