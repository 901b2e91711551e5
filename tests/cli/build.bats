# What 'make' prints, what its targets need, and what they remove.

# Copies the tree into a folder whose path has a space. The part of the path before the space names another
# folder. All tools are one script, which records how it was called and makes its output: a copy of itself.
setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    export decoy=$BATS_FILE_TMPDIR/my tree="$BATS_FILE_TMPDIR/my tree" tool=$BATS_FILE_TMPDIR/tool
    export called=$BATS_FILE_TMPDIR/called known=$BATS_FILE_TMPDIR/known
    mkdir -p "$decoy/kept" "$tree"
    tar --exclude=./build --exclude=./.git -c . | tar -x -C "$tree"
    # The database of make. Nothing is made, since there is no such target.
    env -u MAKEFLAGS -u MAKELEVEL make -npq no-such-target > "$known" 2> /dev/null || true
    cat > "$tool" << END
#!/bin/sh
[ "\${0##*/}" != clang-format ] || set -- # it reads sources that nothing compiles
printf '%s\\n' "\${0##*/}" "\$@" >> "$called"
out=
case \${0##*/} in
*ar) out=\$2 ;;
chromium) for word in "\$@"; do case \$word in --screenshot=*) out=\${word#*=} ;; esac done ;;
clang-format) echo 'version 14.' ;;
afl-fuzz) for word in "\$@"; do [ ! -d "\$word" ] || { mkdir -p "\$word/default"; echo 'saved_crashes : 0' > "\$word/default/fuzzer_stats"; }; done ;;
*) for word in "\$@"; do [ "\$before" != -o ] || out=\$word; before=\$word; done ;;
esac
[ "\$out" ] && [ "\$out" != /dev/null ] || {
    echo ready >&2
    [ -z "\$CMOCKA_MESSAGE_OUTPUT" ] || printf '1..1\\nok 1 of no suite\\n'
    exit 0
}
case \$out in
*.[ao]) : > "\$out" ;;
*) cp "$tool" "\$out" ;;
esac
END
    chmod +x "$tool"
}

# brings PACKAGE: the programs of a package that the targets of the Makefile call. The other packages have
# headers and libraries, or programs that only tests call.
brings() {
    case $1 in
    gcc) echo gcc ar nm objcopy strip ;;
    afl++) echo afl-clang-fast afl-fuzz ;;
    build-essential) echo dpkg-buildpackage ;;
    debhelper) echo dh ;;
    default-jdk-headless) echo javac java ;;
    gcc-aarch64-linux-gnu) echo aarch64-linux-gnu-gcc aarch64-linux-gnu-ar aarch64-linux-gnu-objcopy ;;
    liblcm-bin) echo lcm-gen ;;
    qemu-user) echo qemu-aarch64 ;;
    lib* | *-dev | *-cross) ;;
    *) echo "$1" ;;
    esac
}

# The programs of a machine that has only git and make.
common='awk base64 basenc bash basename cat chmod cmp comm cp cut date diff dirname du env expr find git grep head id install ln ls
    make mkdir mktemp mv nice nproc paste printf readlink realpath rm sed sh sha256sum sort stat tail tar tee timeout touch tr true
    uname uniq wc xargs'

# listed DEPS: the targets that the table at the top of the Makefile lists for it, one a line.
listed() {
    sed -n '/^# Targets/,/^# Variables/{ s/([^)]*)//g; p; }' Makefile | awk -v deps="$1" '
        /^#   [a-z]/ { inside = ($2 == deps); $2 = "" }
        inside && !/^#$/ { text = text substr($0, 2) }
        END {
            parts = split(text, part, ";")
            for (i = 1; i <= parts; i++) {
                sub(/:.*/, "", part[i])
                gsub(/ /, "", part[i])
                gsub(/,/, "\n", part[i])
                print part[i]
            }
        }'
}

# packages_of DEPS: what 'make DEPS' installs.
packages_of() {
    sed -n "s/^packages_$1 := //p" "$known"
}

# make_there DEPS ARGUMENTS...: runs make in the copy, with the tools of these packages only.
make_there() {
    local tools=$BATS_TEST_TMPDIR/tools package name
    if [ ! -d "$tools" ]; then
        mkdir "$tools"
        # shellcheck disable=SC2046,SC2086
        ln -s $(type -P $common) "$tools"
        for package in $(packages_of "$1"); do
            for name in $(brings "$package"); do ln -sf "$tool" "$tools/$name"; done
        done
        printf '#!/bin/sh\n' > "$tools/sleep"
        chmod +x "$tools/sleep"
    fi
    shift
    run env -u MAKEFLAGS -u MAKELEVEL -u CMOCKA_MESSAGE_OUTPUT PATH="$tools" make -s -j2 -C "$tree" python=python3 DESTDIR="$tree/build/dest dir" "$@"
    # No path was split: no argument ends with its first part, or begins with the second.
    ! grep -n -e "$decoy\$" -e '^tree\(/\|$\)' "$called" || return
    [ -d "$decoy/kept" ]
}

# included: the system's headers that the compiled sources include, directly or through other headers.
included() {
    grep -x '[^/].*\.\(c\|cc\)' "$called" | sort -u > "$BATS_TEST_TMPDIR/sources"
    (cd "$tree" && grep -roE --include='*.[ch]' --include='*.cc' --include='*.hpp' '^ *# *include [<"][^>"]*' service msgs clients tests) |
        awk -F: -v sources="$BATS_TEST_TMPDIR/sources" '
            {
                text = $2
                sub(/.*include /, "", text)
                includes[$1] = includes[$1] " " text
                name = $1
                sub(/.*\//, "", name)
                if (!(($1) in known)) files[name] = files[name] " " $1
                known[$1] = 1
            }
            function visit(file,   count, word, i, name, j, found, path) {
                if (seen[file]++) return
                count = split(includes[file], word, " ")
                for (i = 1; i <= count; i++) {
                    name = substr(word[i], 2)
                    if (word[i] ~ /^</) { print name; continue }
                    sub(/.*\//, "", name)
                    for (j = split(files[name], path, " "); j > 0; j--) visit(path[j])
                }
            }
            END { while ((getline file < sources) > 0) visit(file) }' | sort -u
}

# suffices DEPS: makes each target that is listed after it. Of several targets that run one script, it makes one.
# It makes no release, which needs a dated section in the change log (system/library.bats) and builds what 'deb' builds.
suffices() {
    local machine folder header
    [ "$(packages_of "$1")" ]
    [ "$1" = deps-bench ] || export PEERS=none # which may be installed here
    # What earlier targets leave, and 'make deps-aarch64'.
    mkdir -p "$tree/build"
    touch "$tree/build/accuracy.json"
    [ "$1" != deps-aarch64 ] || mkdir -p "$tree/build/aarch64/usr/lib/aarch64-linux-gnu"
    : > "$called"
    # One after another, by one process: each would read the whole tree.
    # shellcheck disable=SC2046
    make_there "$1" -j1 $(listed "$1" | grep -vx -e clean -e check -e test-fast -e release)
    [ "$status" = 0 ] || { echo "$output"; false; }
    # Each header belongs to the compiler, to the C library, or to one of the packages. Debian 13 has a part of
    # libglib2.0-dev in libgio-2.0-dev.
    command -v dpkg > /dev/null || return 0
    machine=$(gcc -dumpmachine)
    included | while read -r header; do
        for folder in /usr/include{,"/$machine",/glib-2.0}; do
            if [ -e "$folder/$header" ]; then echo "$folder/$header"; break; fi
        done
    done | xargs dpkg -S | sed 's/: .*//; s/:[a-z0-9]*//g' | sort -u | grep -vxF -e libc6-dev -e linux-libc-dev -e libgio-2.0-dev |
        grep -vxFf <(packages_of "$1" | tr ' ' '\n') && return 1 || true
    rm -rf "$tree/build"
}

@test "the table of the Makefile has each target once" {
    for deps in $(sed -n 's/^deps := //p' "$known"); do listed "$deps"; done | sort > "$BATS_TEST_TMPDIR/listed"
    sed -n 's/^\.PHONY: //p' "$known" | tr ' ' '\n' | grep -v -e '^deps' -e '^FORCE$' | sort | diff - "$BATS_TEST_TMPDIR/listed"
}

@test "deps suffices for its targets, wherever the tree is" {
    suffices deps
}

@test "deps-test suffices for its targets, wherever the tree is" {
    suffices deps-test
}

@test "deps-bench suffices for its targets, wherever the tree is" {
    suffices deps-bench
}

@test "deps-fuzz suffices for its targets, wherever the tree is" {
    suffices deps-fuzz
}

@test "deps-deb suffices for its targets, wherever the tree is" {
    suffices deps-deb
}

@test "deps-aarch64 suffices for its targets, wherever the tree is" {
    suffices deps-aarch64
}

@test "with BUILD, programs are built in that folder, and nothing is written into the tree" {
    touch "$BATS_TEST_TMPDIR/before"
    make_there deps BUILD="$BATS_TEST_TMPDIR/elsewhere" programs manual
    [ "$status" = 0 ]
    for file in fmb fmbd libfmb.a page/page.html man/fmb.1; do [ -e "$BATS_TEST_TMPDIR/elsewhere/$file" ]; done
    [ -z "$(find "$tree" -newer "$BATS_TEST_TMPDIR/before")" ]
}

@test "'make deb' removes nothing but its own folder, wherever the tree is" {
    mkdir -p "$tree/build/deb/old"
    make_there deps-deb deb
    [ "$status" = 0 ]
    [ ! -e "$tree/build/deb/old" ]
    grep -qx dpkg-buildpackage "$called"
    [ -f "$tree/build/deb"/fmb-*/debian/changelog ]
}

# make_netns OPTIONS: one program of one file, elsewhere, anew.
make_netns() {
    rm -rf "$BATS_TEST_TMPDIR"/[bo]
    run env -u MAKEFLAGS -u MAKELEVEL make O="$BATS_TEST_TMPDIR/o" B="$BATS_TEST_TMPDIR/b" "$@" "$BATS_TEST_TMPDIR/b/netns"
    [ "$status" = 0 ]
    [ -x "$BATS_TEST_TMPDIR/b/netns" ]
}

@test "linked files have the same bytes in every folder, locale and time zone, and for every umask" {
    # A program of one file, and a shared object with and without link-time optimisation.
    local number=0 folder
    for folder in short "a longer & path"; do
        mkdir "$BATS_TEST_TMPDIR/$folder"
        cp -r Makefile tests service msgs clients "$BATS_TEST_TMPDIR/$folder"
        (
            cd "$BATS_TEST_TMPDIR/$folder"
            umask $((number * 77))
            TZ=UTC$number LC_ALL=$([ $number = 0 ] && echo C || echo C.UTF-8) CCACHE_DISABLE=1 \
                env -u MAKEFLAGS -u MAKELEVEL make -s O=o B=b GEN=msgs \
                --eval=$'b/whole.so b/parts.so: o/service/answer/cache.o\n\t$(link)' \
                --eval='b/whole.so: linking = $(filter-out -pie,$(link_whole)) -shared' \
                --eval='b/parts.so: linking = $(filter-out -pie,$(link_flags)) -shared' b/whole.so b/parts.so b/netns
        )
        number=$((number + 1))
    done
    for file in netns whole.so parts.so; do cmp "$BATS_TEST_TMPDIR"/{short,a*}/b/$file; done
}

@test "make prints a line a file, with V=1 the commands, and with -s nothing" {
    make_netns
    [ "$output" = "  CC    clients/demo/netns.c"$'\n'"  LD    $BATS_TEST_TMPDIR/b/netns" ]
    make_netns V=1
    [[ ${lines[-2]} == *' -c clients/demo/netns.c '* && ${lines[-1]} == *" -o $BATS_TEST_TMPDIR/b/netns "* ]]
    [[ $output != *'  CC  '* ]]
    make_netns -s
    [ -z "$output" ]
}

@test "a user's flags come last, and those that change numbers are left out, with a warning" {
    make_netns V=1 CC='gcc -Ofast' CPPFLAGS=-DX=1 CFLAGS='-O0 -funsafe-math-optimizations -ffp-contract=fast -Wno-shadow' \
        LDFLAGS='-ffast-math -Wl,-O1'
    [[ ${lines[0]} == *': left out, as answers would change: -Ofast -ffast-math -ffp-contract=fast -funsafe-math-optimizations' ]]
    [[ ${lines[-2]} == 'gcc -std='*' -O2 '*' -DX=1 -O0 -Wno-shadow '* && ${lines[-1]} == 'gcc '*' -Wl,-O1 '* ]]
    [[ ${lines[*]:1} != *-math* && ${lines[*]:1} != *-contract=fast* && ${lines[*]:1} != *-Ofast* ]]
    # What flushes subnormals at the start of a program.
    ! grep -q set_fast_math "$BATS_TEST_TMPDIR/b/netns" || false
    make_netns CFLAGS='-ffp-contract=off -O1'
    [[ $output != *'left out'* ]]
    # What a file cannot do without follows, with its own contraction.
    kernel=$BATS_TEST_TMPDIR/o/service/fmb/filter/verdicts_avx2.o
    run env -u MAKEFLAGS -u MAKELEVEL make -n O="$BATS_TEST_TMPDIR/o" B="$BATS_TEST_TMPDIR/b" CFLAGS='-O1 -flto -mno-avx2' "$kernel"
    [[ $(uname -m) != x86_64 || $output == *' -ffp-contract=fast '*' -O1 -flto -mno-avx2 '*' -mavx2 '*' -fno-lto '*" -o $kernel "* ]]
}

@test "a compiler that rounds otherwise than the bounds assume is refused" {
    for compiler in gcc clang; do
        refused=(-ffast-math -Ofast -ffinite-math-only)
        [[ $compiler = clang || $(uname -m) != x86_64 ]] || refused+=(-fassociative-math\ -fno-signed-zeros\ -fno-trapping-math -mfpmath=387)
        for flags in '' "${refused[@]}"; do
            # shellcheck disable=SC2086
            run $compiler -std=c17 -O2 $flags -Iservice/fmb -fsyntax-only -x c service/fmb/number/integer.h
            if [ "$flags" ]; then [[ $output == *'answers would be wrong'* ]]; else [ "$status" = 0 ]; fi
        done
    done
}

@test "without lcm-gen, make says what to run" {
    make=$(command -v make)
    run env -u MAKEFLAGS -u MAKELEVEL PATH=/nonexistent "$make" GEN="$BATS_TEST_TMPDIR" "$BATS_TEST_TMPDIR/fmb_msgs_body_t.h"
    [ "$status" != 0 ]
    [[ $output == *"no lcm-gen here; 'make deps' installs"* ]]
}

@test "the sources are formatted" {
    run make -s format-check
    [ "$status" = 0 ]
    [ -z "$output" ] || skip "${output##*: }"
}
