# The libraries as their users meet them: installed, found by pkg-config, linked.

load service

# Installs the build unchanged, as a user whose own files no other user can read.
setup_file() {
    case $FMB_BUILD in *asan*) return ;; esac
    options_of_build
    (umask 077 && make -s -o all "${options[@]}" install PREFIX="$BATS_FILE_TMPDIR/root")
}

options_of_build() {
    options=()
    case $FMB_BUILD in *-clang) options+=(CC=clang) ;; *-two) options+=(INSTRUCTIONS=two) ;; esac
    compiler=$(case $FMB_BUILD in *-clang) echo clang ;; *) echo gcc ;; esac)
}

setup() {
    case $FMB_BUILD in *asan*) skip "libraries with sanitizers are not installed" ;; esac
    options_of_build
    root=$BATS_FILE_TMPDIR/root
    version=$("$FMB_BUILD/fmb" --version | cut -d ' ' -f 2)
    so=so.${version%.*}
    export PKG_CONFIG_PATH=$root/lib/pkgconfig LD_LIBRARY_PATH=$root/lib
}

@test "what is installed is there for all users, whatever the umask" {
    [ "$(stat -c %a "$root")" = 755 ]
    [ -z "$(find "$root" ! -type l ! -perm -444 -o -type d ! -perm -755)" ]
    [ "$(find "$root" -type f -perm /111 -printf '%f %m\n' | sort | xargs)" = 'fmb 755 fmb-check-path 755 fmbd 755' ]
    cp "$FMB_BUILD"/man/*.[18] msgs/*.lcm "$BATS_TEST_TMPDIR"
    (cd "$BATS_TEST_TMPDIR" && for name in *.*; do echo "$name"; done
    for name in LICENSE fmb fmb fmb-check-path fmb-client.pc fmb-config-version.cmake fmb-config.cmake fmb-robot.pc fmb.h fmb.pc \
        fmb.py fmb_batch.h fmb_client.h fmb_flat.h fmb_robot.h fmbd fmbd fmbd.service libfmb-client.a \
        libfmb-client.so libfmb-client.$so libfmb-robot.a libfmb-robot.so libfmb-robot.$so \
        libfmb.a libfmb.so libfmb.$so; do echo $name; done) |
        sort | diff - <(find "$root" ! -type d -printf '%f\n' | sort)
}

@test "the example builds against the installed library, and queries a scene" {
    $compiler -std=c99 -Wall -Wextra -Werror clients/examples/scene.c \
        $(pkg-config --static --cflags --libs fmb-client) -o "$BATS_TEST_TMPDIR/scene"
    start_fmbd
    "$BATS_TEST_TMPDIR/scene" > "$BATS_TEST_TMPDIR/in_process"
    [ -s "$BATS_TEST_TMPDIR/in_process" ]
    "$BATS_TEST_TMPDIR/scene" --bus | cmp - "$BATS_TEST_TMPDIR/in_process"
    stop_fmbd
}

# uses_both FILE: writes a program that uses both libraries.
uses_both() {
    cat > "$1" << 'END'
#include <fmb_batch.h>
#include <fmb_client.h>
#include <string.h>
int plugin(void);
int plugin(void)
{
    struct fmb_body body;
    const double edges[] = {1, 0, 0, 1};
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client_options options;
    struct fmb_placement placement;
    struct fmb_prepared frame;
    memset(&options, 0, sizeof options);
    options.prefix = "not a prefix";
    memset(&placement, 0, sizeof placement);
    placement.body = &body;
    return fmb_body_make(2, FMB_CUBOID, edges, 4, &body) == FMB_OK &&
           fmb_prepare(&placement, 0, 1, &frame) == FMB_OK &&
           fmb_client_open(&options, why, sizeof why) == NULL && strlen(why) > 0 &&
           strcmp(fmb_client_status_text(FMB_BUSY), fmb_status_text(FMB_BUSY)) == 0;
}
#ifndef PLUGIN
int main(void) { return !plugin(); }
#endif
END
}

@test "a program that uses both libraries links them in either order, as C and as C++" {
    cd "$BATS_TEST_TMPDIR"
    uses_both both.c
    warnings='-Wall -Wextra -Wshadow -Wconversion -Werror'
    for order in 'fmb fmb-client' 'fmb-client fmb'; do
        libraries=$(for name in $order; do pkg-config --static --libs $name; done)
        for language in 'c -std=c99' 'c++ -std=c++11' 'c++ -std=c++20'; do
            $compiler -x $language $warnings both.c -x none $(pkg-config --cflags fmb-client) \
                $libraries -o both
            ./both
        done
    done
}

# robot_program FILE: writes a program that prints a robot's joints, links and a point of its tool, in
# a scene of its own and among others, from each of two threads; then what is wrong with a file.
robot_program() {
    cat > "$1" << 'END'
#include <fmb_robot.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
static struct fmb_robot *robot;
static void *pose(void *out)
{
    static const double size[3] = {1, 1, 1};
    static const char *const links[2] = {NULL, "tool"};
    static const char *const ignore[1][2] = {{"base", "tool"}};
    struct fmb_body cube;
    struct fmb_placement bodies[2];
    struct fmb_scene world;
    struct fmb_robot_world around;
    struct fmb_robot_scene *scene;
    double q[2] = {0, 0.5};
    int step;
    fmb_body_make(3, FMB_BOX, size, 3, &cube);
    memset(bodies, 0, sizeof bodies);
    memset(&world, 0, sizeof world);
    bodies[0].body = bodies[1].body = &cube;
    bodies[0].id = 7;
    bodies[1].id = 1;
    bodies[0].position[0] = bodies[1].position[2] = 8;
    world.placements = bodies;
    world.placement_count = 2;
    around.scene = &world;
    around.links = links;
    if (fmb_robot_scene(robot, &around, 1, ignore, 1, &scene) != 0)
        return NULL;
    for (step = 0; step < 1000; step++) {
        q[1] = step / 1000.0;
        if (fmb_robot_place(scene, q) != 0)
            return NULL;
    }
    memcpy(out, fmb_robot_scene_get(scene)->placements, 5 * sizeof(struct fmb_placement));
    q[0] = 1e300;
    if (fmb_robot_place(scene, q) == 0)
        return NULL;
    printf("%zu moved, %zu ignored, %s\n", fmb_robot_moved(scene),
           fmb_robot_scene_get(scene)->ignored_count, fmb_robot_scene_why(scene));
    fmb_robot_scene_free(scene);
    return out;
}
int main(void)
{
    struct fmb_placement placed[2][5];
    pthread_t thread[2];
    void *done[2];
    const char *const *joints;
    const char *const *links;
    double lower[2], upper[2], home[2];
    int i;
    if (fmb_robot_read("r.urdf", NULL, &robot) != 0 || *fmb_robot_why(robot))
        return 1;
    if (fmb_robot_joints(robot, &joints) != 2 || fmb_robot_links(robot, &links) != 3)
        return 2;
    fmb_robot_limits(robot, lower, upper);
    fmb_robot_home(robot, home);
    printf("%s %g %g %g, %s %g %g %g, %s %s %s, %d %d %d, %g\n", joints[0], lower[0], upper[0], home[0],
           joints[1], lower[1], upper[1], home[1], links[0], links[1], links[2],
           fmb_robot_ignores(robot, 0, 1), fmb_robot_ignores(robot, 2, 1), fmb_robot_ignores(robot, 0, 2),
           fmb_robot_excess(robot));
    for (i = 0; i < 2; i++)
        pthread_create(&thread[i], NULL, pose, placed[i]);
    for (i = 0; i < 2; i++)
        pthread_join(thread[i], &done[i]);
    if (!done[0] || !done[1])
        return 3;
    for (i = 0; i < 2; i++)
        printf("%s %g %g, carried %g %g, %s %g\n", placed[i][2].name, placed[i][2].position[1], placed[i][2].position[2],
               placed[i][3].position[1], placed[i][3].position[2], placed[i][4].id == 7 ? "cube" : "?",
               placed[i][4].position[0]);
    fmb_robot_free(robot);
    i = fmb_robot_read("none.urdf", NULL, &robot);
    printf("%d %s\n", i, fmb_robot_why(robot));
    fmb_robot_free(robot);
    return 0;
}
END
}

@test "a program poses a robot in two threads, with the shared and the static library" {
    cd "$BATS_TEST_TMPDIR"
    robot_program robot.c
    box='<collision><geometry><box size="1 1 1"/></geometry></collision>'
    cat > r.urdf << END
<robot name="r"><link name="base">$box</link><link name="arm">$box</link><link name="tool">$box</link>
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
<joint name="slide" type="prismatic"><origin xyz="0 0 2"/><parent link="arm"/><child link="tool"/><axis xyz="0 1 0"/>
<limit lower="0.5" upper="1"/></joint></robot>
END
    for kind in '' --static; do
        $compiler -std=c99 -Wall -Wextra -Wshadow -Wconversion -Werror -pthread robot.c \
            $(pkg-config $kind --cflags --libs fmb-robot) -o robot
        run ./robot
        [ "$status" = 0 ]
        why="its value is beyond 1048576 radians"
        [ "$output" = "turn -inf inf 0, slide 0.5 1 0.75, base arm tool, 1 1 0, 0
4 moved, 4 ignored, joint 'turn': $why
4 moved, 4 ignored, joint 'turn': $why
tool 0.999 2, carried 0.999 10, cube 8
tool 0.999 2, carried 0.999 10, cube 8
-1 none.urdf: No such file or directory" ]
    done
    echo '#include <fmb_robot.h>
        int main() { return fmb_robot_joints(0, 0) != 0; }' > robot.cc
    g++ -std=c++11 -Wall -Wextra -Werror -c robot.cc $(pkg-config --cflags fmb-robot)
}

@test "a project of CMake finds the libraries, shared and static, in a version that will do" {
    cd "$BATS_TEST_TMPDIR"
    uses_both both.c
    printf '#include <fmb_robot.h>\nint main(void) { struct fmb_robot *r; return fmb_robot_read("none", 0, &r) != -1; }\n' > robot.c
    cat > CMakeLists.txt << 'END'
cmake_minimum_required(VERSION 3.13)
project(both C)
find_package(fmb ${wanted} REQUIRED)
find_package(fmb)
foreach(kind "" "-static")
    add_executable(both${kind} both.c)
    target_link_libraries(both${kind} fmb::fmb-client${kind} fmb::fmb${kind})
    add_executable(robot${kind} robot.c)
    target_link_libraries(robot${kind} fmb::fmb-robot${kind})
endforeach()
END
    configure="cmake -S . -B out -DCMAKE_PREFIX_PATH=$root -DCMAKE_C_COMPILER=$compiler"
    for wanted in '' "${version%.*}" "$version"; do
        $configure -Dwanted=$wanted
    done
    cmake --build out
    out/both
    out/robot
    out/robot-static
    mv "$root/lib" "$root/elsewhere"
    run out/both-static
    mv "$root/elsewhere" "$root/lib"
    [ "$status" = 0 ]
    # Staged by DESTDIR: the headers and libraries of the staged tree, not those of the prefix.
    mv "$root" "$root.staged"
    run env LD_LIBRARY_PATH="$root.staged/lib" sh -c "cmake -S . -B staged -DCMAKE_C_COMPILER=$compiler \
        -DCMAKE_PREFIX_PATH=$root.staged && cmake --build staged && staged/both"
    mv "$root.staged" "$root"
    [ "$status" = 0 ]
    # Another minor version, earlier or later, has another ABI.
    for wanted in 0.0.1 "${version%.*}.99" 0.99 1.0; do
        run $configure -Dwanted=$wanted
        [ "$status" != 0 ]
        [[ $output == *"requested version \"$wanted\""* ]]
    done
}

@test "the client and robot libraries export their own names only, and robots need no LCM" {
    for name in client robot; do
        nm -g --defined-only "$root/lib/libfmb-$name.a" | awk 'NF == 3 { print $3 }' > "$BATS_TEST_TMPDIR/names"
        grep -qx 'fmb_client_query\|fmb_robot_read' "$BATS_TEST_TMPDIR/names"
        [ -z "$(grep -v "^fmb_${name}_\|^fmb_flat_" "$BATS_TEST_TMPDIR/names")" ]
    done
    [ -z "$(grep -v '^fmb_robot_' "$BATS_TEST_TMPDIR/names")" ]
    ! ldd "$root/lib/libfmb-robot.so" | grep -i lcm
}

@test "shared libraries have a soname, and export the names of their headers only" {
    for name in fmb fmb-client fmb-robot; do
        file=$root/lib/lib$name.so
        [ "$(readlink "$file")" = lib$name.$so ]
        grep -q "SONAME *lib$name.$so\$" <<< "$(objdump -p "$file")"
        case $name in
        fmb) headers="$root/include/fmb.h $root/include/fmb_batch.h" ;;
        fmb-client) headers="$root/include/fmb_client.h $root/include/fmb_flat.h" ;;
        fmb-robot) headers=$root/include/fmb_robot.h ;;
        esac
        nm -D --defined-only "$file" | awk '$2 != "A" { print $3 }' > "$BATS_TEST_TMPDIR/names"
        grep -qx "${name/-/_}_\(status_text\|read\)" "$BATS_TEST_TMPDIR/names"
        for shown in $(cat "$BATS_TEST_TMPDIR/names"); do grep -q "[ *]$shown(" $headers; done
    done
}

@test "one edit of fmb.h sets the version of everything that is built and installed" {
    cd "$BATS_TEST_TMPDIR"
    cp -r "$OLDPWD"/{Makefile,service,clients,msgs,.debian} .
    mkdir tests
    cp "$OLDPWD/tests/tests.mk" tests
    sed -i -E '/define FMB_VERSION_/ { s/(MAJOR) .*/\1 7/; s/(MINOR) .*/\1 8/; s/(PATCH) .*/\1 9/ }' service/fmb/fmb.h
    make -n "${options[@]}" V=1 all install deb > commands
    for named in -soname,libfmb.so.7.8 -soname,libfmb-client.so.7.8 -soname,libfmb-robot.so.7.8 '|@VERSION@|7.8.9|' \
        '|@SOVERSION@|7.8|' '.so.7.8"' '.debian/build.sh 7.8.9 7.8'; do grep -qF -e "$named" commands; done
    [ -z "$(grep -F -e "so.${version%.*}" -e "$version" commands)" ]
    # Neither the version nor a soname stands elsewhere.
    [ -z "$(grep -rE "libfmb(-[a-z]+)?(\.so\.)?[0-9]|\b${version//./\\.}\b" Makefile .debian service clients msgs)" ]
}

@test "a release is the tarball of the last commit, its packages, and their checksums" {
    cd "$BATS_TEST_TMPDIR"
    mkdir -p tree/.github tree/service/fmb tree/.debian tree/tests
    cp "$OLDPWD/Makefile" tree
    cp "$OLDPWD/tests/tests.mk" tree/tests
    cp "$OLDPWD/service/fmb/fmb.h" tree/service/fmb
    # Replaces the script for Debian: makes a package of the committed file.
    printf '#!/bin/sh\nmkdir -p build/deb\ncp content build/deb/fmb_$1.deb\n' > tree/.debian/build.sh
    chmod +x tree/.debian/build.sh
    echo "## $version (not released yet)" > tree/.github/CHANGELOG.md
    echo build > tree/.gitignore
    echo committed > tree/content
    cd tree
    git init -q
    commit() { git add -A && git -c user.name=a -c user.email=a@b commit -q -m "$1"; }
    commit first
    run make release
    [ "$status" != 0 ]
    [[ $output == *"has no section \"## $version (DATE)\""* ]]
    echo "## $version (2030-01-31)" > .github/CHANGELOG.md
    run make release
    [ "$status" != 0 ]
    [[ $output == *"uncommitted"* ]]
    commit second
    echo other > untracked
    make release
    cd build/release
    [ "$(echo *)" = "SHA256SUMS fmb-$version.tar.gz fmb_$version.deb" ]
    sha256sum -c SHA256SUMS
    [ "$(wc -l < SHA256SUMS)" = 2 ]
    [ "$(cat "fmb_$version.deb")" = committed ]
    [ "$(tar -tzf "fmb-$version.tar.gz" | grep -c 'content$\|untracked$')" = 1 ]
}

@test "a machine of 32 bits is refused with a sentence" {
    run $compiler -m32 -ffreestanding -fsyntax-only -x c service/fmb/fmb.h
    [ "$status" != 0 ]
    [[ $output == *'"libfmb needs a 64-bit machine: '* ]]
}

@test "the names, layouts and numbers that programs depend on are those of abi.txt" {
    CC=$compiler tests/system/abi.sh "$FMB_BUILD" > "$BATS_TEST_TMPDIR/abi"
    diff tests/system/abi.txt "$BATS_TEST_TMPDIR/abi" || {
        echo "the ABI changed: where that is meant, see .github/CHANGELOG.md, then 'make abi'"
        false
    }
}

@test "what abi.txt lists differs if members, enumerators or types are exchanged" {
    build=$(realpath "$FMB_BUILD") abi=$PWD/tests/system/abi
    cp --parents -r service/fmb clients/lib clients/robot clients/python "$BATS_TEST_TMPDIR"
    cd "$BATS_TEST_TMPDIR"
    # What a sed script changes in fmb.h, and a line that must then be there.
    while IFS='|' read -r change line; do
        cp service/fmb/fmb.h kept.h
        sed -i "$change" service/fmb/fmb.h
        grep "^$line" <<< "$(CC=$compiler "$abi.sh" "$build" | diff --new-line-format=%L --unchanged-line-format= "$abi.txt" -)"
        mv kept.h service/fmb/fmb.h
    done << 'END'
s/double position\[/double hold[/; s/double velocity\[/double position[/; s/double hold\[/double velocity[/|struct fmb_placement: 24 bytes at 8: velocity
s/FMB_TETRAHEDRON = 2, FMB_FACE = 3/FMB_TETRAHEDRON = 3, FMB_FACE = 2/|FMB_FACE = 2
s/X(BUSY, 2,/X(BUSY, 3,/; s/X(OVER_LIMIT, 3,/X(OVER_LIMIT, 2,/|FMB_BUSY = 3
s/double duration; /float duration;/|struct fmb_scene: 4 bytes at 16: duration, float
s/bool \*by_vertices,/int *by_vertices,/|libfmb fmb_frame_numbers .* int \*, double \*, size_t
END
}

@test "a program runs with the shared libraries, and a plugin holds the archives" {
    cd "$BATS_TEST_TMPDIR"
    uses_both both.c
    $compiler both.c $(pkg-config --cflags --libs fmb fmb-client) -o with_shared
    ./with_shared
    for name in fmb fmb-client; do grep -q "lib$name.$so => $root/" <<< "$(ldd with_shared)"; done
    $compiler -shared -fPIC -DPLUGIN both.c $(pkg-config --cflags fmb-client) -o plugin.so \
        "$root/lib/libfmb-client.a" "$root/lib/libfmb.a" -llcm -lglib-2.0 -lgmp -lm
    cat > main.c << 'END'
#include <dlfcn.h>
int main(void)
{
    void *library = dlopen("./plugin.so", RTLD_NOW);
    int (*plugin)(void);
    *(void **) &plugin = library ? dlsym(library, "plugin") : 0;
    return !plugin || !plugin() || dlclose(library) != 0;
}
END
    $compiler main.c -o main -ldl
    mv "$root/lib" "$root/elsewhere"
    run ./main
    mv "$root/elsewhere" "$root/lib"
    [ "$status" = 0 ]
}

@test "Python finds the module in the folder of its version, and runs with the shared libraries" {
    [ -x /usr/bin/python3 ] || skip "needs python3"
    folder=$root/lib/$(/usr/bin/python3 -c 'import sys; print("python%d.%d" % sys.version_info[:2])')/dist-packages
    [ "$(PYTHONPATH=$folder /usr/bin/python3 -c 'import fmb; print(fmb.version(), fmb.__file__)')" = \
        "$version $folder/fmb.py" ]
    [ "$(grep -c 'SONAME = "libfmb-[a-z]*\.so\.[0-9.]*"$' "$folder/fmb.py")" = 2 ]
}

# Options of make are those of options_of_build().
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
        eval "$compiler small.c $(pkg-config --static --cflags --libs fmb-client) -o small"
        ./small
        cd "$OLDPWD"
        [ -f "$prefix/share/doc/fmb/LICENSE" ]
        [[ $(nm "$prefix/bin/fmb" 2>&1) != *main* ]]
        make -s "${options[@]}" uninstall PREFIX="$prefix" LIBDIR="$(realpath -m "$prefix")/lib64"
        [ -z "$(find "$prefix" ! -type d)" ]
    done
}

@test "make install ends with the settings that a prefix needs, and with no others" {
    [ -x /usr/bin/python3 ] || skip "needs python3"
    unset PKG_CONFIG_PATH LD_LIBRARY_PATH
    prefix="$BATS_TEST_TMPDIR/a & b"
    install=(env -u MAKEFLAGS -u MAKELEVEL make -o all "${options[@]}" install PREFIX="$prefix")
    printf '#include <fmb_client.h>\nint main(void) { return !fmb_client_prefix_ok("a"); }\n' > "$BATS_TEST_TMPDIR/small.c"
    (
        eval "$("${install[@]}" | tee "$BATS_TEST_TMPDIR/said" | sed '1,/^to find what is installed:$/d')"
        cd "$BATS_TEST_TMPDIR"
        [ "$(sed -n '/^to find/,$p' said | wc -l)" = 6 ]
        [ "$(command -v fmbd)" = "$prefix/bin/fmbd" ]
        eval "$compiler small.c $(pkg-config --cflags --libs fmb-client) -o small"
        ./small
        /usr/bin/python3 -c 'import fmb; fmb.version()'
        [[ $CMAKE_PREFIX_PATH == "$prefix"* ]]
        # Nothing is left to set, except for another library folder, which the loader would not search.
        cd "$OLDPWD"
        ! "${install[@]}" | grep -A 9 '^to find' || false
        [ "$("${install[@]}" LIBDIR="$prefix/other" | sed '1,/^to find/d' | cut -d = -f 1 | xargs)" = 'export LD_LIBRARY_PATH export PKG_CONFIG_PATH' ]
    )
    ! "${install[@]}" DESTDIR="$BATS_TEST_TMPDIR/staged" | grep '^to find' || false
    [ -z "$("${install[@]}" -s)" ]
}

@test "a robot is the same in a program whose locale has decimal commas" {
    cd "$BATS_TEST_TMPDIR"
    printf '%s\n' LC_NUMERIC 'decimal_point ","' 'thousands_sep ""' 'grouping -1' 'END LC_NUMERIC' > comma
    localedef -c -i comma -f ANSI_X3.4-1968 "$PWD/locale" 2> /dev/null || [ -f locale/LC_NUMERIC ] || skip "localedef makes no locale"
    printf '%s\n' 'v 0.5 0 0' 'v 0 1.5 0' 'v 0 0 2.5' 'f 1 2 3' > m.obj
    cat > robot.urdf << 'END'
<robot name="r"><link name="a"><collision><geometry><box size="0.5 1.5 2.5"/></geometry></collision>
<collision><geometry><mesh filename="m.obj"/></geometry></collision></link></robot>
END
    echo '{"dim": 3, "bodies": [{"id": 1, "shape": "sphere", "radius": 0.5, "position": [0.5,1.5e0,0]}]}' > s.json
    cat > comma.c << 'END'
#include <fmb_robot.h>
#include <locale.h>
#include <stdio.h>
int main(void)
{
    struct fmb_robot *robot;
    struct fmb_robot_scene *scene;
    struct fmb_robot_json *json;
    char text[8];
    if (!setlocale(LC_NUMERIC, "locale") || fmb_robot_read("robot.urdf", NULL, &robot) != 0) {
        puts(fmb_robot_why(robot));
        return 1;
    }
    snprintf(text, sizeof text, "%.1f", 0.5); /* the program's own locale holds after the call */
    if (fmb_robot_json_read("s.json", &json) != 0 ||
        fmb_robot_json_get(json)->scene->placements[0].position[1] != 1.5)
        return 2;
    fmb_robot_scene(robot, NULL, 0, NULL, 0, &scene);
    const struct fmb_body *body = fmb_robot_scene_get(scene)->placements[0].body;
    return text[1] != ',' || body->frames[0].component[1][1] != 1.5 || body->frame_count != 2;
}
END
    $compiler -Wall -Werror comma.c $(pkg-config --cflags --libs fmb-robot) -o comma.out
    LOCPATH=$PWD ./comma.out
}
