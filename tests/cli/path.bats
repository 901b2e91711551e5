# fmb path: arguments, output, exit codes. What is proven: tests/unit/test_path.c.

load ../ran

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    FMB=$(realpath "${FMB_BUILD:-build}")/fmb
    DEMO=$(realpath clients/demo/robot)
    PATH=$(dirname "$FMB"):$PATH
    cd "$BATS_TEST_TMPDIR" || return
    # A cube of 1 that slides along x, then turns about z; a wall whose face is at x = 4.
    robot 'continuous'
    echo '{"dim": 3, "bodies": [{"id": 9, "name": "wall", "shape": "box", "size": [2,8,8], "position": [5,0,0]}]}' > world.json
}

# robot TYPE [ELEMENTS]
robot() {
    printf '<robot name="r"><link name="base"/><link name="slider"/><link name="cube"><collision><geometry>
        <box size="1 1 1"/></geometry></collision></link>
        <joint name="slide" type="prismatic"><parent link="base"/><child link="slider"/>
          <limit lower="-9" upper="9"/></joint>
        <joint name="turn" type="%s"><parent link="slider"/><child link="cube"/><axis xyz="0 0 1"/>
          <limit lower="-9" upper="9"/></joint>%s</robot>' "$1" "$2" > robot.urdf
}

# rows ROW...: with the columns slide and turn.
rows() {
    printf '%s\n' slide,turn "$@" > path.csv
}

path() {
    run --separate-stderr "$FMB" path robot.urdf --joints-csv path.csv --with world.json "$@"
}

# shows FILTER: applies a jq filter to the lines.
shows() {
    output=$(jq -c "$1" <<< "$output")
}

# refused TEXT ARGUMENTS...: one line, which contains the text, and no edge.
refused() {
    local text=$1
    shift
    path "$@"
    ended 2
    is ''
    [[ $(grep -c '' <<< "$stderr") = 1 && $stderr == "fmb: "*"$text"* ]] || { echo "found: $stderr"; return 1; }
}

@test "a free edge has a clearance, to a tenth or as much as is wanted" {
    rows 0,0 1,1 3,1
    path --json
    ended 0
    shows '[.edge, .path, .verdict, .edges, .pairs, .ignored]'
    is '[1,null,"free",null,null,null]
[2,null,"free",null,null,null]
[null,"free",null,2,1,0]'
    path --json
    shows 'select(.edge == 2) | .clearance > 0.9 * 0.309 and .clearance < 0.3092 and .closest > 0.309 and .clearance >= 0.9 * .closest and .names == ["cube","wall"] and [.a, .b] == [1, 9]'
    is true
    path --clearance 0.309
    ended 0
    [[ $output == "free: edges: 2, free: 2; clearance 0.309"*": it covers errors of up to "*" of all joints at once" ]]
}

@test "a nearer edge is near, by --clearance or by the margin of the world" {
    rows 0,0 1,0 3,0
    path --clearance 0.6 --json
    ended 3
    shows '[.verdict, .path, .at, (.clearance > 0.45)]'
    is '["free",null,null,true]
["near",null,[0.9990234375,0.9990234375],true]
[null,"near",null,true]' || true
    [[ $output == *'"near",null,[0.9'* && $output == *'[null,"near",null,true]' ]]
    sed -i 's/"dim": 3/"dim": 3, "margin": 0.6/' world.json
    path
    ended 3
    [[ $output == *"near: edges: 2, free: 1, near: 1; clearance 0.4"* ]]
    path --clearance 0.4
    ended 0
}

@test "a contact is enclosed, and a command shows it" {
    rows 0,0 1,0 4,0
    path
    ended 3
    [[ $output == *"     2  contact    0.8333"*" to 0.8333"*"cube, wall"* ]]
    [[ $output == *"contact: edges: 2, free: 1, contact: 1"* ]]
    grep '^The first of them: fmb scene ' <<< "$output"
    run --separate-stderr bash -c "$(grep -o 'fmb scene.*' <<< "$output") --json"
    shows '.pairs[] | [.verdict, .names]'
    is '["overlapping",["cube","wall"]]'
    path --json
    shows 'select(.edge == 2) | .at[0] <= 5/6 and .at[1] >= 5/6 and .at[1] - .at[0] < 1e-4 and .joints.slide >= 3.5 and has("clearance") == false'
    is true
}

@test "an edge may begin in contact" {
    rows 3.75,0 3.75,1
    path --json
    ended 3
    shows '[.verdict, .at]'
    is '["contact",[0,0]]
[null,null]'
}

@test "a cube that slides along a face is undecided" {
    robot revolute
    sed -i 's/<joint name="slide" type="prismatic">/&<axis xyz="0 1 0"\/>/' robot.urdf
    sed -i 's/"position": \[5,0,0\]/"position": [1.5,0,0]/' world.json
    rows 0,0 1,0
    path --json
    ended 1
    shows '[.verdict // .path, (.at // [0,0] | .[1] - .[0] <= 1e-9)]'
    is '["undecided",true]
["undecided",true]'
}

@test "a path of one row is one pose" {
    rows 3,0.5
    path --json
    ended 0
    shows '[.verdict, .edges]'
    is '["free",null]
[null,1]'
}

@test "times and labels stand beside the edges" {
    printf '%s\n' time,label,turn,slide 1,up,0,0 3,down,0,4 > path.csv
    path --json
    ended 3
    shows '[.label, (.time // 0 | . * 10 | floor)]'
    is '["up (t = 1)",27]
[null,0]'
    path
    [[ $output == *"cube, wall  from up (t = 1)"* ]]
}

@test "pairs that do not move relative to each other are decided once" {
    robot continuous '<link name="foot"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
        <joint name="stand" type="fixed"><parent link="base"/><child link="foot"/><origin xyz="0 0 -5"/></joint>'
    echo '{"dim": 3, "bodies": [
        {"id": 8, "name": "floor", "shape": "box", "size": [9,9,1], "position": [0,0,-6]},
        {"id": 9, "name": "under", "shape": "box", "size": [9,9,1], "position": [0,0,-6]}]}' > world.json
    rows 0,0 1,0
    path
    ended 0
    [[ $output == "touching, at all times, as they do not move relative to each other: foot, floor"* ]]
    [[ $stderr == *"decided once, as they do not move relative to each other: 2"* ]]
    sed -i 's/-6\]/-5.5]/' world.json
    path
    ended 3
    [[ $output == "overlapping, at all times"* ]]
    path --json
    ended 3
    shows '[.rigid, .names, .path]' 
    [[ $output == '["overlapping",["foot","floor"],null]'* ]]
    path --ignore foot,floor --ignore foot,under
    ended 0
}

@test "a body that a link carries moves with it" {
    echo '{"dim": 3, "bodies": [{"id": 8, "name": "tool", "link": "cube", "shape": "box", "size": [6,1,1]},
        {"id": 9, "name": "wall", "shape": "box", "size": [2,8,8], "position": [5,0,0]}]}' > world.json
    rows 0,0 1.25,0
    path --json
    ended 3
    shows 'select(.edge) | [.verdict, .names]'
    is '["contact",["tool","wall"]]'
}

@test "paths that have no straight line, no row, or wrong numbers are refused" {
    rows 0,0 0,4
    refused "by more than pi: the straight line goes the long way round; unwrap the column"
    [[ $stderr == *"path.csv: line 3: joint 'turn' turns from 0 to 4"* ]]
    robot revolute # its limits may be that far apart
    path
    ended 0
    rows
    refused "expected a row of joint values, found none"
    rows 0,0 nan,0
    refused "expected a finite number, found 'nan'"
    rows 0,0 10,0
    refused "is outside its limits"
    printf '%s\n' slide 0 1 > path.csv
    refused "no column for joint 'turn'"
}

@test "worlds that move, and robots without joints, are refused" {
    rows 0,0 1,0
    sed -i 's/"shape"/"velocity": [0,1,0], &/' world.json
    refused "body 9, wall moves: on a path only the robot does"
    sed -i 's/"velocity": [[]0,1,0], /"end": {}, /' world.json
    refused "body 9, wall moves: on a path only the robot does"
    echo '{"dim": 3, "bodies": []}' > world.json
    echo '<robot name="r"><link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>' > robot.urdf
    refused "the robot has no joint that moves"
}

@test "wrong usage of fmb path is refused" {
    run "$FMB" path robot.urdf
    ended 2
    [[ $output == *"--joints-csv"* ]]
    rows 0,0
    run "$FMB" path robot.urdf --joints-csv path.csv --clearance -1
    ended 2
}

@test "a proof holds every pair of every free edge, and what it is about" {
    rows 0,0 1,1 3,1 4,1
    path --proof proof
    ended 3
    [ "$(head -c 2 proof | od -An -tx1)" = " 1f 8b" ]
    gunzip < proof > lines
    jq -e -s '.[0] == {"fmb-path": 1} and .[-1] == {"end": (length - 1)}' lines
    run jq -c 'select(.row or .edge or .pair or .ignored) | [.row, .edge, .to, .pair, .pairs]' lines
    is '["0x0p+0 0x0p+0",null,null,null,null]
["0x1p+0 0x1p+0",null,null,null,null]
["0x1.8p+1 0x1p+0",null,null,null,null]
["0x1p+2 0x1p+0",null,null,null,null]
[null,null,null,null,1]
[null,1,"0x1p+0",null,null]
[null,null,null,[0,1],null]
[null,2,"0x1p+0",null,null]
[null,null,null,[0,1],null]
[null,3,"0x1p-2",null,null]
[null,null,null,[0,1],null]'
    # The intervals of each pair follow each other from 0 to the end of what is proven.
    jq -e -s '[.[].proof // empty | map(.[1] | -. | exp2) | add == 1] == [true, true, false]' lines
    cp proof first
    path --proof proof
    cmp first proof
    echo mine > other
    run "$FMB" path robot.urdf --joints-csv path.csv --proof other
    ended 2
    [ "$(cat other)" = mine ]
}

@test "a proof has the numbers of each shape without rounding" {
    echo '{"dim": 3, "bodies": [{"id": 9, "frames": [
        {"shape": "box", "size": [0.3,0.1,0.7], "position": [0.1,0.2,0.3]}, {"shape": "sphere", "radius": 0.1},
        {"shape": "cuboid", "origin": [0.1,0,0], "components": [[0.3,1,0],[0,1,0],[0,0,1]]},
        {"shape": "face", "origin": [0.1,0,0], "components": [[1,0,0],[0,1,0]], "radius": 0.5},
        {"shape": "hull", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,0.7]]}], "position": [5,0,0]}]}' > world.json
    rows 0,0 1,0
    path --proof proof
    ended 0
    run --separate-stderr bash -c "gunzip < proof | jq -c 'select(.link == -1) | .frames[]'"
    is '{"box":["0x1.999999999999ap-4 0x1.999999999999ap-3 0x1.3333333333333p-2","0x1.3333333333333p-2 0x1.999999999999ap-4 0x1.6666666666666p-1"]}
{"hull":["0x0p+0 0x0p+0 0x0p+0"],"radius":"0x1.999999999999ap-4"}
{"cuboid":["0x1.999999999999ap-4 0x0p+0 0x0p+0","0x1.3333333333333p-2 0x1p+0 0x0p+0","0x0p+0 0x1p+0 0x0p+0","0x0p+0 0x0p+0 0x1p+0"]}
{"simplex":["0x1.999999999999ap-4 0x0p+0 0x0p+0","0x1p+0 0x0p+0 0x0p+0","0x0p+0 0x1p+0 0x0p+0"],"radius":"0x1p-1"}
{"hull":["0x0p+0 0x0p+0 0x0p+0","0x1p+0 0x0p+0 0x0p+0","0x0p+0 0x1p+0 0x0p+0","0x0p+0 0x0p+0 0x1.6666666666666p-1"]}'
    run /usr/bin/python3 -S "$DEMO/../../robot/fmb-check-path" proof
    ended 0
}

@test "fmb-check-path accepts proofs, but not those of bounds that are halved" {
    check="/usr/bin/python3 -S $(dirname "$DEMO")/../robot/fmb-check-path"
    # A ball at a distance of 1 from a joint, and a wall that it comes near in the middle.
    echo '<robot name="r"><link name="base"/><link name="ball"><collision><origin xyz="1 0 0"/><geometry>
        <sphere radius="0.125"/></geometry></collision></link><joint name="turn" type="continuous">
        <parent link="base"/><child link="ball"/><axis xyz="0 0 1"/></joint></robot>' > robot.urdf
    echo '{"dim": 3, "bodies": [{"id": 9, "shape": "box", "size": [1,4,4], "position": [1.75,0,0]}]}' > world.json
    sed 's/1.75/1.628/' world.json > near.json
    printf '%s\n' turn -0.25 0.25 -0.125 > beside.csv
    printf '%s\n' turn 1.2 0.7 > towards.csv
    planted() { # FACTOR WHAT TABLE WORLD OPTION...
        "$TOOLS/path-planted" "$1" "$2" robot.urdf --joints-csv "$3" --with "$4" --proof proof --force "${@:5}" 2> /dev/null || true
        run $check proof
    }
    planted 1 curve beside.csv near.json
    ended 0
    planted 0.5 curve beside.csv near.json
    ended 1
    planted 1 speed towards.csv world.json --clearance 0.38
    ended 0
    planted 0.5 speed towards.csv world.json --clearance 0.38
    ended 1
    # Without any pair.
    echo '{"dim": 3, "bodies": []}' > none.json
    planted 1 speed beside.csv none.json
    ended 0
    # And those of a robot with all kinds of intervals.
    cd "$DEMO" || return
    run "$FMB" path robot.urdf --joints-csv path.csv --with world.json --clearance 0 --proof "$BATS_TEST_TMPDIR/demo"
    ended 3
    run $check "$BATS_TEST_TMPDIR/demo"
    ended 3
}

@test "--check compares the robot, the bodies and the pairs of a proof" {
    check() {
        run --separate-stderr "$FMB" path --check "${1:-proof}" robot.urdf --with world.json "${@:2}"
    }
    rows 0,0 1,1
    path --proof proof
    ended 0
    check
    ended 0
    [[ $output == "proof is about this robot among these bodies, and a path of 2 rows"* ]]
    head -c 300 proof > cut
    head -c -30 proof > end
    for file in cut end world.json missing; do
        check "$file"
        ended 2
        [[ $stderr == "fmb: $file: "* ]]
    done
    check proof --ignore cube,wall
    ended 1
    [[ $stderr == *"other pairs are tested"* ]]
    sed -i 's/"size": \[2/"size": [2.5/' world.json
    check
    ended 1
    [[ $stderr == *"a body differs"* ]]
    sed -i 's/xyz="0 0 1"/xyz="0 1 1"/' robot.urdf
    check
    ended 1
    [[ $stderr == *"the robot differs"* ]]
}

@test "the demo's path meets where its poses do" {
    cd "$DEMO" || return
    run --separate-stderr "$FMB" path robot.urdf --joints-csv path.csv --with world.json --json
    ended 3
    shows 'select(.verdict == "contact") | [.edge, .names]'
    is '[3,["hand","post"]]
[4,["forearm","post"]]
[8,["hand","cube"]]'
}
