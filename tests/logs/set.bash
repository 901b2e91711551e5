# For the tests of the regression set: the logs, and the programs capped at each instruction set.

: "${FMB_BUILD:=build}"
LOGS=$BATS_TEST_DIRNAME/../logs

# Those that this machine has; the others' programs would be the same as one of these.
has_set() {
    "$FMB_BUILD/logs/generate" --instructions | grep -qx "$1"
}

need_set() {
    has_set "$1" || skip "this machine has no $1"
}

# name_of LOG: of tests/logs/arm.log: arm.
name_of() {
    basename "$1" .log
}
