# The packages that 'make deb' built, and the first command of the README, on a bare Debian of this machine's
# release.
# 'make deb-test' runs this; it needs root, and a mirror of Debian (MIRROR=).

setup_file() {
    [ "$(id -u)" = 0 ] && command -v debootstrap > /dev/null || return 0
    export root=$BATS_FILE_TMPDIR/root
    debootstrap --variant=minbase "$(. /etc/os-release; echo "$VERSION_CODENAME")" "$root" ${MIRROR-} > "$BATS_FILE_TMPDIR/debootstrap" 2>&1 ||
        { tail "$BATS_FILE_TMPDIR/debootstrap"; return 1; }
    mount -t proc proc "$root/proc"
    # Without its own files: build, and what git keeps.
    mkdir "$root/fmb"
    tar --exclude=./build --exclude=./.git -c . | tar -x -C "$root/fmb"
    cp build/deb/*.deb "$root/fmb"
    inside apt-get update -q
    # No systemd runs in the chroot: a stub of systemctl records its arguments. It reports an enabled unit as running.
    export enabled=/etc/systemd/system/multi-user.target.wants/fmbd.service
    mkdir -p "$root/run/systemd/system"
    printf '#!/bin/sh\necho "$*" >> /asked\n[ -L %s ] && echo enabled\n' $enabled > "$root/usr/bin/systemctl"
    chmod +x "$root/usr/bin/systemctl"
}

setup() {
    [ "${root-}" ] || skip "needs root, and debootstrap"
}

teardown_file() {
    [ -z "${root-}" ] || umount "$root/proc"
}

# inside COMMAND...: in the chroot.
inside() {
    chroot "$root" env LC_ALL=C DEBIAN_FRONTEND=noninteractive "$@"
}

get() {
    inside apt-get install -q -y --no-install-recommends "$@"
}

@test "the packages install, the programs answer, and the unit waits to be enabled" {
    get $(cd "$root" && printf './%s ' fmb/fmb_*.deb fmb/fmbd_*.deb)
    scene=clients/demo/table.json
    inside fmb query --local --box /fmb/$scene | cmp - <("$FMB_BUILD/fmb" query --local --box $scene)
    "$FMB_BUILD/netns" chroot "$root" sh -c "fmbd 2> log & until grep -q ready log; do sleep 0.1; done
        fmb query --box /fmb/$scene; kill \$!; wait" | cmp - <("$FMB_BUILD/fmb" query --local --box $scene)
    # Two examples of the package: a scene with a body that turns, and a path of a robot.
    examples=usr/share/doc/fmb/examples
    inside fmb query --local --box --point /$examples/turn.json | cmp - <("$FMB_BUILD/fmb" query --local --box --point clients/demo/turn.json)
    head -n 4 "$root/$examples/robot/path.csv" > "$root/start.csv"
    inside fmb path /$examples/robot/robot.urdf --joints-csv /start.csv --with /$examples/robot/world.json --ignore base,table --proof /proof |
        grep '^free: edges: 2, free: 2;'
    inside fmb-check-path /proof
    [ -f "$root/lib/systemd/system/fmbd.service" ]
    grep -q '^ExecStart="/usr/bin/fmbd"$' "$root/lib/systemd/system/fmbd.service"
    [ ! -L "$root$enabled" ]
    grep -q daemon-reload "$root/asked"
    [ -z "$(grep start "$root/asked")" ]
    for file in fmb/README.md fmb/CHANGELOG.md fmb/examples/table.json fmb/examples/robot/robot.urdf; do
        [ "$(find "$root/usr/share/doc/$file"* -type f)" ]
    done
    grep -q 'Copyright: .*FMB' "$root/usr/share/doc/fmb/copyright"
    for name in 'three.js authors' 'Troy D. Hanson' BSD-1-Clause; do grep -qF "$name" "$root/usr/share/doc/fmb/copyright"; done
    for file in man1/fmb-log-cut.1 man1/fmb-check-path.1 man8/fmbd.8; do [ -f "$root/usr/share/man/$file.gz" ]; done
    # Programs of the bus alone need LCM.
    ! inside dpkg-query -W 'libfmb[0-9]*'
}

@test "programs build against libfmb-dev, and run with the libraries alone" {
    get $(cd "$root" && printf './%s ' fmb/lib*.deb) gcc libc6-dev pkg-config
    inside sh -c 'gcc -std=c99 /fmb/clients/examples/scene.c $(pkg-config --cflags --libs fmb-client fmb) -o shared
        gcc -std=c99 /fmb/clients/examples/scene.c $(pkg-config --cflags fmb-client) -Wl,-Bstatic -lfmb-client -lfmb \
            -Wl,-Bdynamic -llcm -lglib-2.0 -lgmp -lm -o static'
    [ "$(inside /shared)" = "$(inside /static)" ]
    for file in msgs/README.md CHANGELOG.md examples/scene.c; do
        [ "$(find "$root/usr/share/doc/libfmb-dev/$file"* -type f)" ]
    done
    printf '#include <fmb_robot.h>\nint main(void) { struct fmb_robot *r; return fmb_robot_read("/fmb/clients/demo/robot/robot.urdf", 0, &r); }\n' > "$root/robot.c"
    inside sh -c 'gcc robot.c $(pkg-config --cflags --libs fmb-robot) -o robot && ./robot'
    inside apt-get purge -q -y libfmb-dev
    inside /shared
    ! inside dpkg -s liblcm-dev || inside apt-get autoremove -q -y
    inside /shared
}

@test "Python finds the module, and decides in process" {
    get $(cd "$root" && printf './%s ' fmb/python3-fmb_*.deb fmb/libfmb[0-9]*.deb fmb/libfmb-client[0-9]*.deb)
    [ "$(inside python3 -c 'import fmb; print(fmb.Scene([fmb.box([1, 1])] * 2).pair(0, 1, 0).verdict.name)')" = OVERLAPPING ]
}

@test "an earlier version is upgraded, and an enabled unit stays enabled and restarts" {
    # The same packages with a lower version, and with a file that the later version lacks.
    version=$(dpkg-deb -f build/deb/fmb_*.deb Version)
    mkdir "$root/fmb/old"
    for file in build/deb/*.deb; do
        old=$BATS_TEST_TMPDIR/$(basename "$file" .deb)
        dpkg-deb -R "$file" "$old"
        sed -i "/^\(Version\|Depends\|Recommends\): /s/\b${version//./\\.}/0.0.9/g" "$old/DEBIAN/control"
        mkdir -p "$old/usr/share/fmb-0.0.9"
        echo > "$old/usr/share/fmb-0.0.9/${file##*/}"
        dpkg-deb -b "$old" "$root/fmb/old" > /dev/null
    done
    get --allow-downgrades $(cd "$root" && printf './%s ' fmb/old/*.deb)
    [ "$(ls "$root/usr/share/fmb-0.0.9")" = "$(cd build/deb && ls *.deb)" ]
    [ "$(inside dpkg-query -W -f '${Version}\n' fmbd)" = 0.0.9 ]
    # As 'systemctl enable' does.
    mkdir -p "$root${enabled%/*}"
    ln -s /lib/systemd/system/fmbd.service "$root$enabled"
    get $(cd "$root" && printf './%s ' fmb/*.deb)
    [ ! -e "$root/usr/share/fmb-0.0.9" ]
    [ "$(inside dpkg-query -W -f '${Version}\n' fmb fmbd libfmb-dev 'libfmb*[0-9]' python3-fmb | sort -u)" = "$version" ]
    [ -L "$root$enabled" ]
    grep -q ' restart fmbd.service$' "$root/asked"
    inside fmb query --local --box /usr/share/doc/fmb/examples/table.json > /dev/null
    # Libraries of two minor versions have no file in common.
    for file in build/deb/libfmb*"${version%.*}"_*.deb; do
        [ -z "$(dpkg-deb -c "$file" | grep -v '/$' | grep -vF "${version%.*}")" ]
    done
}

@test "nothing remains when the packages are removed" {
    inside apt-get remove -q -y fmbd
    grep -q '^stop fmbd.service$' "$root/asked"
    inside apt-get purge -q -y fmb fmbd 'libfmb*' python3-fmb
    [ -z "$(find "$root" -xdev -path "$root/fmb" -prune -o -path "$root/proc" -prune -o -name '*fmb*' -print)" ]
}

@test "the packages have the same bytes in every folder, locale and time zone, at any time and for every umask" {
    mkdir "$BATS_TEST_TMPDIR/another folder"
    tar --exclude=./build --exclude=./.git -c . | tar -x -C "$BATS_TEST_TMPDIR/another folder"
    find "$BATS_TEST_TMPDIR/another folder" -exec touch -d 2001-01-01 {} +
    # In a tarball, the Makefile has the time of the commit.
    touch -d "@$(dpkg-parsechangelog -l build/deb/fmb-*/debian/changelog -S Timestamp)" "$BATS_TEST_TMPDIR/another folder/Makefile"
    (
        cd "$BATS_TEST_TMPDIR/another folder"
        umask 077
        # The times of files are not faked: make compares them.
        TZ=Asia/Kathmandu LC_ALL=C CCACHE_DISABLE=1 NO_FAKE_STAT=1 faketime -f +400d \
            env -u MAKEFLAGS -u MAKELEVEL make deb > log 2>&1 || { tail -n 40 log; return 1; }
    )
    for file in build/deb/*.deb; do cmp "$file" "$BATS_TEST_TMPDIR/another folder/$file"; done
}

@test "the first command of the README installs, builds and answers, for a user with sudo" {
    get git make sudo
    inside useradd -m user
    echo 'user ALL=(ALL) NOPASSWD: ALL' > "$root/etc/sudoers.d/user"
    inside chown -R user /fmb
    rm "$root"/fmb/*.deb
    command=$(sed -n '/^make deps demo/s/ *#.*//p' README.md)
    run inside su user -c "cd /fmb && $command"
    echo "$output" | tail -n 60
    [ "$status" = 0 ]
    [[ $output == *'make deps: installed '*'the page: build/demo/scene.html'* ]]
}
