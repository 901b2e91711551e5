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

# code_of LOG: what a replay in which all is the same exits with. Of the foreign log some messages
# cannot be read, and a replay has to say so.
code_of() {
    if [ "$(name_of "$1")" = foreign ]; then echo 2; else echo 0; fi
}
