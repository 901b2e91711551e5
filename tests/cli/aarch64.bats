# The regression set on AArch64: the same logs and the same results to the byte, from programs that
# 'make aarch64' cross-compiles and qemu emulates. Skipped where 'make deps-aarch64' was not run.

load ../logs/set

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    [ -x build/release-aarch64-linux-gnu-gcc/fmb ] || skip "'make deps-aarch64' was not run"
}

# emulate PROGRAM: writes a script of the program's name that runs it; sets EMULATED to its path.
emulate() {
    EMULATED=$BATS_TEST_TMPDIR/$(basename "$1")
    cat > "$EMULATED" << END
#!/bin/sh
exec qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=build/aarch64/usr/lib/aarch64-linux-gnu \\
    build/release-aarch64-linux-gnu-gcc/$1 "\$@"
END
    chmod +x "$EMULATED"
}

@test "AArch64 makes the same hard logs" {
    emulate logs/generate
    makes_the_hard_logs "$EMULATED"
}

@test "AArch64 gives the same results, and replays the logs" {
    emulate fmb
    replays_the_set "$EMULATED"
}
