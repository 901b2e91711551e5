#!/bin/sh
# readme.sh SUITE: follows the README on a bare Debian, bookworm or trixie, as a user with sudo: builds, installs
# below a prefix, and proves a path of another robot than the demo's. Run it by hand, as root; it needs debootstrap
# and a Debian mirror (MIRROR=). It makes the system in build/readme, and removes this folder at the end.
set -eu

case ${1-} in
bookworm | trixie) ;;
*) echo 'usage: readme.sh bookworm|trixie' >&2; exit 2 ;;
esac
cd "$(dirname "$0")/../.."
root=$PWD/build/readme/root
[ ! -e "$root" ] || { echo "readme.sh: $root exists already" >&2; exit 2; }

remove() {
    ! mountpoint -q "$root/proc" || umount "$root/proc"
    rm -rf --one-file-system build/readme
}
trap remove EXIT
trap 'exit 1' INT TERM HUP

inside() {
    chroot "$root" env -i LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

mkdir -p "$root"
debootstrap --variant=minbase "$1" "$root" ${MIRROR-} > build/readme/debootstrap || { tail build/readme/debootstrap; exit 1; }
mount -t proc proc "$root/proc"
inside sh -ec 'apt-get update -q; apt-get install -q -y --no-install-recommends git make sudo; useradd -m -s /bin/sh user'
echo 'user ALL=(ALL) NOPASSWD: ALL' > "$root/etc/sudoers.d/user"
mkdir "$root/home/user/fmb"
tar --exclude=./build --exclude=./.git -c . | tar -x -C "$root/home/user/fmb"

# A lift with a boom that swings, in a hall. One path passes over a pillar, the other one through it.
mkdir "$root/home/user/lift"
cat > "$root/home/user/lift/lift.urdf" << 'END'
<robot name="lift">
  <link name="foot"><collision><origin xyz="0 0 0.05"/><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="column"><collision><origin xyz="0 0 0.45"/><geometry><cylinder radius="0.06" length="0.7"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.6 0.08 0.06"/></geometry></collision></link>
  <link name="stick"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.06 0.05"/></geometry></collision></link>
  <link name="ball"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="mast" type="fixed"><parent link="foot"/><child link="column"/></joint>
  <joint name="raise" type="prismatic"><parent link="column"/><child link="boom"/><origin xyz="0.1 0 0.3"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.4" effort="1" velocity="1"/></joint>
  <joint name="swing" type="revolute"><parent link="boom"/><child link="stick"/><origin xyz="0.6 0 0.1"/>
    <axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="fixed"><parent link="stick"/><child link="ball"/><origin xyz="0.45 0 0"/></joint>
</robot>
END
cat > "$root/home/user/lift/hall.json" << 'END'
{"dim": 3, "bodies": [
    {"id": 1, "name": "floor", "shape": "box", "size": [4,4,0.1], "position": [0,0,-0.06], "group": 1},
    {"id": 2, "name": "pillar", "shape": "capsule", "radius": 0.05, "length": 0.4, "position": [0.9,0.3,0.25], "group": 1},
    {"id": 3, "name": "shelf", "shape": "box", "size": [0.5,0.1,0.02], "position": [0.7,-0.35,0.6], "group": 1}]}
END
printf '%s\n' raise,swing 0,-0.5 0.3,-0.2 0.3,0.9 > "$root/home/user/lift/over.csv"
printf '%s\n' raise,swing 0,-0.5 0,0.9 > "$root/home/user/lift/through.csv"

cat > "$root/home/user/follow.sh" << 'END'
set -eux
export HOME=/home/user
cd ~/fmb
eval "$(sed -n '/^make deps demo/s/ *#.*//p' README.md)"
make install PREFIX=$HOME/prefix > ~/installed
eval "$(sed '1,/^to find what is installed:$/d' ~/installed)"

# The scene of the README, and its program in C.
cd ~
sed -n '/^\$ cat clients\/demo\/table.json$/,/^\$ /p' fmb/README.md | grep -v '^\$' > table.json
fmb query --local table.json | grep -x '1 overlapping, 1 touching, 1 separated (1 near)'
gcc fmb/clients/examples/scene.c $(pkg-config --cflags --libs fmb-client fmb) -o scene
./scene

cd ~/lift
code=0
fmb path lift.urdf --joints-csv through.csv --with hall.json || code=$?
[ $code = 3 ]
fmb path lift.urdf --joints-csv over.csv --with hall.json --clearance 0.01 --proof over.proof
sudo apt-get install -q -y --no-install-recommends python3
fmb-check-path over.proof
END
inside chown -R user /home/user
inside su user -c 'sh ~/follow.sh'
echo "readme.sh: followed on $1"
