# The libraries as their users meet them: installed, found by pkg-config, linked.

load service

setup() {
    root=$BATS_TEST_TMPDIR/root
    options=()
    case $FMB_BUILD in
    *asan*) options+=(MODE=asan) flags='-fsanitize=address,undefined' ;;
    *) flags= ;;
    esac
    case $FMB_BUILD in *-clang) options+=(CC=clang) ;; esac
    compiler=$(case $FMB_BUILD in *-clang) echo clang ;; *) echo gcc ;; esac)
    # What was built is installed as it is.
    make -s -o all "${options[@]}" install PREFIX="$root"
    export PKG_CONFIG_PATH=$root/lib/pkgconfig LD_LIBRARY_PATH=$root/lib
}

@test "the examples build against the installed library, and query scenes" {
    for example in scene robot; do
        $compiler -std=c99 -Wall -Wextra -Werror $flags clients/examples/$example.c \
            $(pkg-config --static --cflags --libs fmb-client) -lm -o "$BATS_TEST_TMPDIR/$example"
    done
    start_fmbd
    "$BATS_TEST_TMPDIR/scene" > "$BATS_TEST_TMPDIR/in_process"
    [ -s "$BATS_TEST_TMPDIR/in_process" ]
    "$BATS_TEST_TMPDIR/scene" --bus | cmp - "$BATS_TEST_TMPDIR/in_process"
    run "$BATS_TEST_TMPDIR/robot"
    [ "$status" = 0 ]
    [[ ${lines[-1]} == *', 11 bodies whole, '* ]]
    stop_fmbd
}

@test "a program that uses both libraries links them in either order, as C and as C++" {
    cat > "$BATS_TEST_TMPDIR/both.c" << 'END'
#include <fmb_client.h>
#include <string.h>
int main(void)
{
    struct fmb_body body;
    const double edges[] = {1, 0, 0, 1};
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client_options options;
    memset(&options, 0, sizeof options);
    options.prefix = "not a prefix";
    return fmb_body_make(2, FMB_CUBOID, edges, 4, &body) != FMB_OK ||
           fmb_client_open(&options, why, sizeof why) != NULL || strlen(why) == 0 ||
           strcmp(fmb_client_status_text(FMB_BUSY), fmb_status_text(FMB_BUSY)) != 0;
}
END
    for order in 'fmb fmb-client' 'fmb-client fmb'; do
        libraries=$(for name in $order; do pkg-config --static --libs $name; done)
        $compiler -std=c17 -Wall -Wextra -Werror $flags "$BATS_TEST_TMPDIR/both.c" \
            $(pkg-config --cflags fmb-client) $libraries -o "$BATS_TEST_TMPDIR/both"
        "$BATS_TEST_TMPDIR/both"
    done
    $compiler -x c++ -fsyntax-only -Wall -Wextra -Wshadow -Werror "$BATS_TEST_TMPDIR/both.c" \
        $(pkg-config --cflags fmb-client) || ! command -v g++
}

@test "the client library exports its own names only" {
    nm -g --defined-only "$root/lib/libfmb-client.a" | awk 'NF == 3 { print $3 }' > "$BATS_TEST_TMPDIR/names"
    grep -qx fmb_client_query "$BATS_TEST_TMPDIR/names"
    [ -z "$(grep -v '^fmb_client_\|asan' "$BATS_TEST_TMPDIR/names")" ]
}

@test "shared libraries have a soname, and export the names of their headers only" {
    for name in fmb fmb-client; do
        file=$root/lib/lib$name.so
        [ "$(readlink "$file")" = lib$name.so.0 ]
        objdump -p "$file" | grep -q "SONAME *lib$name.so.0\$"
        header=$root/include/${name/-/_}.h
        nm -D --defined-only "$file" | awk '$2 != "A" { print $3 }' > "$BATS_TEST_TMPDIR/names"
        grep -qx "${name/-/_}_status_text" "$BATS_TEST_TMPDIR/names"
        for shown in $(cat "$BATS_TEST_TMPDIR/names"); do grep -q "[ *]$shown(" "$header"; done
    done
}

@test "a program runs with the shared libraries, and a shared object holds the archives" {
    cat > "$BATS_TEST_TMPDIR/plugin.c" << 'END'
#include <fmb_client.h>
#include <string.h>
int plugin(void);
int plugin(void)
{
    struct fmb_body body;
    const double edges[] = {1, 0, 0, 1};
    return fmb_body_make(2, FMB_CUBOID, edges, 4, &body) == FMB_OK && fmb_client_prefix_ok("a");
}
END
    printf 'int plugin(void);\nint main(void) { return !plugin(); }\n' > "$BATS_TEST_TMPDIR/main.c"
    cd "$BATS_TEST_TMPDIR"
    $compiler $flags plugin.c main.c $(pkg-config --cflags --libs fmb fmb-client) -o with_shared
    ./with_shared
    for name in fmb fmb-client; do ldd with_shared | grep -q "lib$name.so.0 => $root/"; done
    $compiler $flags -shared -fPIC plugin.c $(pkg-config --cflags fmb-client) -o libplugin.so \
        "$root/lib/libfmb-client.a" "$root/lib/libfmb.a" -llcm -lglib-2.0 -lgmp -lm
    $compiler $flags main.c -L. -lplugin -o with_plugin
    rm "$root"/lib/libfmb*
    LD_LIBRARY_PATH=. ./with_plugin
}

# Options of make are those of setup().
@test "a prefix may contain a space, % and &, or be relative, and uninstall removes all files" {
    printf '#include <fmb_client.h>\nint main(void) { return !fmb_client_prefix_ok("a"); }\n' \
        > "$BATS_TEST_TMPDIR/small.c"
    for prefix in "$BATS_TEST_TMPDIR/a %n & prefix" "$(realpath --relative-to=. "$BATS_TEST_TMPDIR")/relative"; do
        make -s -o all "${options[@]}" install-strip PREFIX="$prefix" LIBDIR="$(realpath -m "$prefix")/lib64"
        PKG_CONFIG_PATH="$(realpath "$prefix")/lib64/pkgconfig"
        export LD_LIBRARY_PATH=$(realpath "$prefix")/lib64
        # systemd splits words at spaces, and takes % for a specifier.
        grep -qxF "ExecStart=\"$(realpath "$prefix" | sed 's/%/%%/g')/bin/fmbd\"" \
            "$prefix/lib/systemd/system/fmbd.service"
        cd "$BATS_TEST_TMPDIR"
        eval "$compiler $flags small.c $(pkg-config --static --cflags --libs fmb-client) -o small"
        ./small
        cd "$OLDPWD"
        [ -f "$prefix/share/doc/fmb/LICENSE" ]
        ! nm "$prefix/bin/fmb" 2> /dev/null | grep -q main || false
        make -s "${options[@]}" uninstall PREFIX="$prefix" LIBDIR="$(realpath -m "$prefix")/lib64"
        [ -z "$(find "$prefix" ! -type d)" ]
    done
}
