# The options of fmb record.

load ../ran

setup() {
    FMB=${FMB_BUILD:-build}/fmb
    cd "$BATS_TEST_DIRNAME/../.." || return
    log=$BATS_TEST_TMPDIR/log
}

