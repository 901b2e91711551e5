# What 'make' prints, and what its targets need.

# A copy of the tree in a folder whose path has a space, beside one that has the part of this path before it.
# Its tools are one script, which writes down how it was called and makes what it is to make: a copy of itself.
setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    export decoy=$BATS_FILE_TMPDIR/my tree="$BATS_FILE_TMPDIR/my tree" tools=$BATS_FILE_TMPDIR/tools called=$BATS_FILE_TMPDIR/called
    mkdir -p "$decoy/kept" "$tree" "$tools"
    tar --exclude=./build --exclude=./.git -c . | tar -x -C "$tree"
    cat > "$tools/tool" << END
#!/bin/sh
printf '%s\\n' "\${0##*/}" "\$@" >> $called
case \${0##*/} in
ar) out=\$2 ;;
chromium) for out in "\$@"; do case \$out in --screenshot=*) out=\${out#*=}; break ;; esac done ;;
*)
    out=
    for word in "\$@"; do [ "\$before" != -o ] || out=\$word; before=\$word; done
    ;;
esac
if [ "\$out" ]; then
    [ -d "\${out%/*}" ] && cp $tools/tool "\$out"
else
    echo ready >&2
    [ -z "\$CMOCKA_MESSAGE_OUTPUT" ] || printf '1..1\\nok 1 of a stub\\n'
fi
END
    chmod +x "$tools/tool"
    for name in gcc clang g++ afl-clang-fast ar objcopy nm lcm-gen javac bats jq python3 chromium clang-format dh lintian \
        dpkg-buildpackage aarch64-linux-gnu-{gcc,ar,objcopy} qemu-aarch64; do
        ln -s tool "$tools/$name"
    done
    printf '#!/bin/sh\n' > "$tools/sleep"
    chmod +x "$tools/sleep"
}

# make_there ARGUMENTS...: in the copy, with these tools.
make_there() {
    : > "$called"
    run env -u MAKEFLAGS -u MAKELEVEL PATH="$tools:$PATH" make -C "$tree" python=python3 "$@"
    # Nobody took the path apart: no argument ends with the first part of it, or begins with the second.
    ! grep -n -e "$decoy\$" -e '^tree\(/\|$\)' "$called"
    [ -d "$decoy/kept" ]
}

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

@test "'make deb' removes nothing but its own folder, wherever the tree is" {
    mkdir -p "$tree/build/deb/old"
    make_there deb
    [ "$status" = 0 ]
    [ ! -e "$tree/build/deb/old" ]
    grep -qx dpkg-buildpackage "$called"
    [ -f "$tree/build/deb"/fmb-*/debian/changelog ]
}

@test "the sources are formatted" {
    run make -s format-check
    [ "$status" = 0 ]
    [ -z "$output" ] || skip "${output##*: }"
}
