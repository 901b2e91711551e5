# The files that commands write: no input is overwritten; a log, or a file of another kind, only with
# --force; a command that fails leaves no file. Links, modes and signals: tests/unit/test_output.c.

load ../ran

setup() {
    local build
    build=$(cd "$BATS_TEST_DIRNAME/../.." && cd "${FMB_BUILD:-build}" && pwd)
    FMB=$build/fmb
    cd "$BATS_TEST_TMPDIR" || return
    cp "$BATS_TEST_DIRNAME/../logs/arm.log" a.log
    cp a.log b.log
    printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'f 1 2 3' > a.obj
    cp a.obj b.obj
    cat > scene.json <<< '{"dim": 2, "bodies": [{"id": 1, "shape": "box", "size": [1,1]}, {"id": 2, "shape": "box", "size": [2,2]}]}'
    mkdir kept
    cp -- *.* kept
}

# Each option that writes a file, in a command that reads these files.
commands=('query --local scene.json --html' 'mesh a.obj b.obj --html' 'replay a.log b.log --html'
    'replay a.log b.log --junit' 'replay a.log b.log --write-golden' 'log cut a.log b.log -o')

# unchanged: the files are those of the beginning.
unchanged() {
    diff -r --exclude kept --exclude 'separate-stderr-*' . kept
}

@test "no option overwrites a file that the command reads, not even with --force" {
    for command in "${commands[@]}"; do
        for file in $(grep -oE '[a-z]+\.(json|obj|log)' <<< "$command"); do
            ln -s "$file" link
            ln "$file" hard
            # All names of the first; of the others, that no command forgets a file.
            paths=$file
            [ "$file" != scene.json ] || paths="$file ./$file $PWD/$file link hard"
            for path in $paths; do
                # shellcheck disable=SC2086
                run --separate-stderr "$FMB" $command "$path" --force
                ended 2
                is ''
                said "fmb: $path: this command reads it: write to another file"
            done
            rm link hard
            unchanged
        done
    done
    run --separate-stderr "$FMB" query --local --html scene.json --force < scene.json
    ended 2
    said 'fmb: scene.json: this command reads it: write to another file'
    "$FMB" replay --write-golden golden a.log > text
    cp golden before
    for option in --write-golden --html --junit; do
        run --separate-stderr "$FMB" replay --golden golden a.log $option golden --force
        ended 2
        cmp golden before
    done
}

@test "a log, or a file of another kind, is overwritten only with --force" {
    for command in "${commands[@]}"; do
        for old in kept/b.log kept/scene.json; do
            cp "$old" out
            # shellcheck disable=SC2086
            run --separate-stderr "$FMB" $command out
            ended 2
            is ''
            [[ $stderr == 'fmb: out: '*xists*'; --force overwrites it' ]]
            cmp out "$old"
            # shellcheck disable=SC2086
            "$FMB" $command out --force > text || { echo "$command"; false; }
            ! cmp -s out "$old" || false
            rm out text
            unchanged
        done
    done
}

@test "any file replaces an empty one; pages and reports replace one of their kind" {
    for command in "${commands[@]}"; do
        : > out
        for time in 1 2; do
            if [[ $time == 2 && $command =~ golden|cut ]]; then break; fi
            # shellcheck disable=SC2086
            "$FMB" $command out > text || { echo "$command"; false; }
            [ -s out ]
        done
        rm out text
        unchanged
    done
}

@test "two outputs of a command never go to one file" {
    mkdir folder
    ln -s .. folder/up
    ln -s new dangling
    for command in 'replay a.log --html * --junit' \
        'replay a.log --html * --write-golden' 'replay a.log --write-golden * --junit'; do
        for other in new ./new "$PWD/new" folder/up/new dangling; do
            # shellcheck disable=SC2086
            run --separate-stderr "$FMB" ${command/'*'/new} "$other" --force
            ended 2
            is ''
            [[ $stderr == "fmb: "*": two outputs of this command: write to two files" ]]
            [ ! -e new ]
        done
        : > new
        ln new hard
        # shellcheck disable=SC2086
        run --separate-stderr "$FMB" ${command/'*'/new} hard
        ended 2
        rm new hard
    done
    for command in "${commands[@]}"; do
        # shellcheck disable=SC2086
        run --separate-stderr bash -c '"$0" "$@" > new' "$FMB" $command ./new --force
        ended 2
        [[ $stderr == "fmb: ./new: this command prints there too: write to another file" ]]
        [ ! -s new ]
        rm new
    done
    "$FMB" replay a.log --html /dev/null --junit /dev/null > said
}

@test "golden results are overwritten with --force" {
    "$FMB" replay --write-golden golden a.log > text
    cp golden before
    "$FMB" replay --write-golden golden --force a.log > text
    cmp golden before
}

@test "a command that fails leaves the old file, and no temporary one" {
    mkdir there
    cp a.log there/cut.log
    dd if=a.log of=short.log bs=1000 count=60 status=none
    # More than the 1 KiB that a file may have.
    run bash -c 'ulimit -f 1; "$0" log cut b.log -o there/cut.log --force' "$FMB"
    ended 2
    [[ $output == 'fmb: there/cut.log: File too large'* ]]
    run bash -c 'ulimit -f 1; "$0" replay b.log --write-golden there/cut.log --force' "$FMB"
    ended 2
    run bash -c 'ulimit -f 1; "$0" query --local scene.json --html there/cut.log --force' "$FMB"
    ended 1
    cmp there/cut.log a.log
    [ "$(ls -A there)" = cut.log ]
    # So does a replay of no query.
    run "$FMB" replay --prefix NONE b.log --write-golden there/cut.log --force
    ended 2
    cmp there/cut.log a.log
    # Input that is no scene leaves the page.
    "$FMB" query --local scene.json --html there/cut.log --force > text
    cp there/cut.log page
    run "$FMB" query --local --html there/cut.log <<< '{"dim": 4}'
    ended 2
    cmp there/cut.log page
    [ "$(ls -A there)" = cut.log ]
}

@test "standard output and pipes are written directly, after the answers" {
    "$FMB" query --local scene.json --json --html /dev/stdout > text
    head -n 1 text | jq -e .pairs > pairs
    sed -n 2p text | grep -qx '<!DOCTYPE html>'
    "$FMB" query --local scene.json --json --html /dev/stdout | cat | cmp - text
    "$FMB" replay --write-golden golden a.log > said
    mkfifo fifo
    "$FMB" replay --write-golden fifo a.log > said &
    cmp fifo golden
    wait $!
    [ -p fifo ]
    "$FMB" log cut a.log -o /dev/null > said
    [ -c /dev/null ]
}
