# fmb scene: arguments, output, exit codes. Geometry: tests/unit/test_urdf.c.

load ../ran

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    FMB=$(realpath "${FMB_BUILD:-build}")/fmb
    DEMO=$(realpath clients/demo/robot)
    cd "$BATS_TEST_TMPDIR" || return
    box='<collision><geometry><box size="1 2 3"/></geometry></collision>'
    limit='<limit lower="-1" upper="2"/>'
    # A base, an arm on it, and a tool at its end.
    robot "<link name='base'>$box</link><link name='arm'>$box</link><link name='tool'>$box</link>
        <joint name='turn' type='revolute'><origin xyz='0 0 4'/><parent link='base'/><child link='arm'/>
          <axis xyz='0 0 1'/>$limit</joint>
        <joint name='slide' type='prismatic'><parent link='arm'/><child link='tool'/>
          <axis xyz='0 3 0'/>$limit</joint>"
}

# robot ELEMENTS: writes robot.urdf.
robot() {
    printf '<?xml version="1.0"?>\n<robot name="r">\n%s\n</robot>\n' "$1" > robot.urdf
}

# link ELEMENTS: writes a robot of one link.
link() {
    robot "<link name='a'>$1</link>"
}

scene() {
    run --separate-stderr "$FMB" scene "$@"
}

# shows FILTER [OPTION...]: applies a jq filter to the scenes, a line each.
shows() {
    ended 0
    output=$(jq -c "${@:2}" "$1" <<< "$output")
}

# refused TEXT ARGUMENTS...: one line, which contains the text, and no scene.
refused() {
    local text=$1
    shift
    scene "$@"
    ended 2
    is ''
    [[ $stderr == "fmb: "*"$text"* && $stderr != *$'\n'* ]] || {
        echo "expected: $text"
        echo "found:    $stderr"
        return 1
    }
}

# says TEXT...: each is in a line of stderr; there are at most three.
says() {
    [ "$(grep -c '' <<< "$stderr")" -le 3 ] || { echo "$stderr"; return 1; }
    for text; do
        [[ $stderr == *"$text"* ]] || { echo "expected: $text"; echo "found:    $stderr"; return 1; }
    done
}

# triangle FILE: of STL, in ASCII.
triangle() {
    printf 'solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n' > "$1"
}

# ---- Bodies ----------------------------------------------------------------------------------

@test "a link is a body of its name, and neighbours are ignored" {
    scene robot.urdf
    said 'fmb: robot.urdf: links: 3, with a body: 3; size: 1 x 2 x 7
fmb: pairs tested: 1, ignored: 2: 2 neighbours'
    ended 0
    is '{"dim": 3, "duration": 0, "bodies": [{"id": 1, "name": "base", "shape": "box", "size": [1,2,3]}, {"id": 2, "name": "arm", "shape": "box", "size": [1,2,3], "position": [0,0,4]}, {"id": 3, "name": "tool", "shape": "box", "size": [1,2,3], "position": [0,0,4]}], "ignore": [[1, 2], [2, 3]]}'
    scene - < robot.urdf
    shows '.bodies | length'
    is 3
}

@test "links without collision elements have no body; the links beside them become neighbours" {
    joints=
    for i in 1 2 3 4 5 6 7 8 9; do
        joints+="<link name='l$i'/><joint name='j$i' type='continuous'><parent link='$([ $i = 1 ] && echo a || echo l$((i - 1)))'/><child link='l$i'/></joint>"
    done
    robot "<link name='a'>$box</link>$joints<link name='b'>$box</link>
        <joint name='last' type='fixed'><parent link='l9'/><child link='b'/></joint>"
    scene robot.urdf
    says 'links: 11, with a body: 2;'
    shows '[.bodies[].name, .ignore]'
    is '["a","b",[[1,2]]]'
    scene robot.urdf --verbose
    grep -qx "fmb: robot.urdf: link 'l9' has no <collision> and no body" <<< "$stderr"
    grep -qx 'fmb: ignored: 1 a and 2 b: neighbours' <<< "$stderr"
    refused '--joints: ' robot.urdf --joints none=1 # that line alone
}

@test "a box keeps its numbers; beside others, if rotated, it is a cuboid" {
    turned='<origin xyz="1 2 3" rpy="0 0 0.5"/><geometry><box size="1 2 3"/></geometry>'
    link "<collision>$turned</collision>"
    scene robot.urdf
    shows '.bodies[0] | [.shape, .size, .position, .orientation[1:3]]'
    is '["box",[1,2,3],[1,2,3],[0,0]]'
    link "<collision>$turned</collision>$box<collision><origin xyz='5 0 0'/><geometry><box size='1 1 1'/></geometry></collision>"
    scene robot.urdf
    shows '.bodies[0] | [has("position"), [.frames[] | .shape, .position]]'
    is '[false,["cuboid",null,"box",null,"box",[5,0,0]]]'
}

@test "cylinders become hulls, tight along the axes; how far these extend beyond them is reported" {
    link '<collision><geometry><cylinder radius="1" length="3"/></geometry></collision>'
    scene robot.urdf
    says '; hulls extend beyond what they enclose by at most 0.0195914'
    shows '.bodies[0] | [.shape, (.vertices | length, ([0, 1, 2][] as $axis | map(.[$axis]) | min, max))]'
    is '["hull",32,-1,1,-1,1,-1.5,1.5]'
    scene robot.urdf --sides 512
    says '; hulls extend beyond what they enclose by at most 1.88253e-05'
    shows '.bodies[0].vertices | length'
    is 1024
    link '<collision><geometry><cylinder radius="5e-324" length="0"/></geometry></collision>'
    scene robot.urdf --sides 4
    says '; hulls extend beyond what they enclose by at most 9.55672e-299'
    echo '{"dim": 3, "bodies": [{"id": 1, "shape": "cylinder", "radius": 1, "length": 3, "sides": 8}]}' > world.json
    link "$box"
    scene robot.urdf --with world.json
    says 'extend beyond what they enclose by at most 0.082393'
}

@test "spheres and capsules are exact" {
    ball='<geometry><sphere radius="0.1"/></geometry></collision>'
    capsule='<geometry><capsule radius="0.25" length="1.5"/></geometry></collision>'
    link "<collision><origin xyz='1 2 3'/>$ball"
    scene robot.urdf
    ended 0
    [ ! -s err ]
    shows '.bodies[0] | [.shape, .radius, .position]'
    is '["sphere",0.1,[1,2,3]]'
    link "<collision><origin xyz='1 2 3'/>$ball<collision>$capsule<collision><origin xyz='0 1 0' rpy='3.1415926535897931 0 0'/>$capsule"
    scene robot.urdf
    shows '.bodies[0].frames'
    is '[{"shape":"sphere","radius":0.1,"position":[1,2,3]},{"shape":"capsule","radius":0.25,"length":1.5},{"shape":"hull","radius":0.25,"vertices":[[0,1,0.75],[0,1,-0.75]]}]'
    # A ball of radius 1/4 on the floor, one that is turned, and capsules that stand and lie there.
    echo '{"dim": 3, "bodies": [{"id": 1, "name": "floor", "shape": "box", "size": [8,8,1], "position": [0,0,-0.75]}]}' > floor.json
    for element in "<collision><geometry><sphere radius='0.25'/></geometry></collision>" \
        "<collision><origin rpy='1 2 3'/><geometry><sphere radius='0.25'/></geometry></collision>" \
        "<collision><origin rpy='1.5707963267948966 0 0'/>$capsule" "<collision><origin xyz='0 0 0.75'/>$capsule"; do
        link "$element"
        "$FMB" scene robot.urdf --with floor.json | "$FMB" query --local --csv > answer.csv
        grep -q ',touching,' answer.csv
    done
}

@test "wheels and cylinders rest on the floor, beside other elements and turned by a quarter too" {
    echo '{"dim": 3, "bodies": [{"id": 1, "name": "floor", "shape": "box", "size": [8,8,1], "position": [0,0,-0.75]}]}' > floor.json
    wheel='<geometry><cylinder radius="0.25" length="0.125"/></geometry></collision>'
    for turn in 1.5707963267948966 -1.5707963267948966 3.1415926535897931; do
        link "<collision><origin xyz='0 0 $([ ${turn%.*} = 3 ] && echo -0.1875 || echo 0)' rpy='$turn 0 0'/>$wheel"
        "$FMB" scene robot.urdf --with floor.json | "$FMB" query --local --csv > answer.csv
        grep -q ',touching,' answer.csv
    done
    link "$box<collision><origin xyz='0 0 0.375'/><geometry><cylinder radius='0.25' length='1.25'/></geometry></collision>"
    sed -i 's/size="1 2 3"/size="0.1 0.1 0.1"/' robot.urdf
    "$FMB" scene robot.urdf --with floor.json | "$FMB" query --local --csv > answer.csv
    grep -q ',touching,' answer.csv
}

# ---- Meshes ----------------------------------------------------------------------------------

@test "a mesh is the hull of its vertices, scaled, without those inside and repeated ones" {
    printf 'v %s\n' '0 0 0' '4 0 0' '0 4 0' '0 0 4' '1 1 1' '0 0 0' '9 9 9' > m.obj
    printf 'f %s\n' '1 2 3' '1 2 5' '6 4 2' >> m.obj
    mkdir folder
    mv m.obj folder
    link "<collision><origin xyz='1 0 0'/><geometry><mesh filename='folder/m.obj' scale='1 -1 0.5'/></geometry></collision>"
    scene robot.urdf
    shows '.bodies[0] | [.shape, .vertices, .position]'
    is '["hull",[[0,0,0],[4,0,0],[0,-4,0],[0,0,2]],[1,0,0]]'
    sed -i "s|<collision>|$box&|" robot.urdf
    scene robot.urdf
    shows '.bodies[0].frames[1].vertices'
    is '[[1,0,0],[5,0,0],[1,-4,0],[1,0,2]]'
    link "<collision><geometry><mesh filename='package://folder/m.obj'/></geometry></collision>"
    refused "robot.urdf: line 3: link 'a': package://folder/m.obj: not found: no folder above the robot is called folder, or has a package.xml with this name: give the folders that packages are in by --package-path" robot.urdf
    refused 'not found in --package-path /nowhere: ' robot.urdf --package-path /nowhere
    scene robot.urdf --package-path "/nowhere:$PWD"
    shows '.bodies[0].vertices | length'
    is 4
    link "<collision><geometry><mesh filename='file://$PWD/folder/m.obj'/></geometry></collision>"
    scene robot.urdf
    ended 0
}

@test "with --objects, an OBJ is a hull for each object" {
    for option in '' --objects; do
        scene "$DEMO/robot.urdf" $option
        shows '.bodies[] | select(.name == "hand") | .frames // [.] | map(.vertices | length)'
        [ "$output" = "$([ "$option" ] && echo '[8,8,8]' || echo '[12]')" ]
    done
}

# collada NODES [ASSET]: writes m.dae, whose geometry g is a tetrahedron of corners at 1 on the axes.
collada() {
    cat > m.dae << EOF
<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>${2-}<up_axis>Y_UP</up_axis></asset>
<library_nodes><node id="half"><scale>0.5 0.5 0.5</scale><instance_geometry url="#g"/></node></library_nodes>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/><p>0 0 1 0 2 0 0 0 1 0 3 0</p></triangles>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">$1</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
EOF
    link "<collision><geometry><mesh filename='m.dae' scale='1 1 2'/></geometry></collision>"
}

@test "the unit of COLLADA is applied and reported, its up axis is not applied" {
    collada '<node><instance_geometry url="#g"/></node>'
    scene robot.urdf
    [[ $stderr != *unit* ]]
    shows '.bodies[0].vertices'
    is '[[0,0,0],[1,0,0],[0,1,0],[0,0,2]]'
    collada '<node><translate>4 0 0</translate><instance_node url="#half"/></node>' '<unit meter="0.25" name="q"/>'
    scene robot.urdf
    says '; the <unit> of COLLADA is applied, as in RViz and Gazebo, but not in MoveIt: 0.25 m in m.dae, files: 1'
    shows '.bodies[0].vertices'
    is '[[1,0,0],[1.125,0,0],[1,0.125,0],[1,0,0.25]]'
    sed -i 's/<p>.*<\/p>/<p\/>/; s/ count="[21]"/ count="0"/; s/<vcount>4/<vcount>/' m.dae
    refused "line 3: link 'a': m.dae: the mesh has no faces" robot.urdf
}

# 256 MB suffice.
@test "objects without faces take no memory" {
    { for i in 1 2 3; do echo "v $i $((i * i)) 0"; done; head -n 50000 <(yes 'o x'); echo 'f 1 2 3'; } > m.obj
    link "<collision><geometry><mesh filename='m.obj'/></geometry></collision>"
    (ulimit -v 262144 && "$FMB" scene robot.urdf --objects) > output.txt
    output=$(< output.txt) status=0
    shows '.bodies[0].vertices | length'
    is 3
}

# sphere VERTICES: writes m.obj, of points at 1 or less from (1, 2, 3), all of them vertices of the hull, and a robot of it.
sphere() {
    awk -v n="$1" 'BEGIN {
        for (i = 0; i < n; i++) {
            z = 1 - (2 * i + 1) / n; r = sqrt(1 - z * z)
            printf "v %.9f %.9f %.9f\n", 1 + r * cos(2.399963 * i), 2 + r * sin(2.399963 * i), 3 + z
        }
        for (i = 3; i <= n; i++) print "f", i - 2, i - 1, i
    }' > m.obj
    link "<collision><geometry><mesh filename='m.obj'/></geometry></collision>"
}

@test "a hull of too many vertices gets fewer and a radius, which is reported" {
    sphere 3000
    scene robot.urdf
    says '; hulls extend beyond what they enclose by at most 0.0037'
    shows '.bodies[0] | (.vertices | length), .radius > 0.0037 and .radius < 0.0038'
    is $'1024\ntrue'
    # A mesh that is placed within its link, and a mesh of two objects.
    sed -i "s|<collision>|$box<collision><origin xyz='0 0 1' rpy='0 0 1'/>|" robot.urdf
    scene robot.urdf
    shows '.bodies[0].frames[1] | (.vertices | length), .radius > 0.0037 and .radius < 0.0038'
    is $'1024\ntrue'
    { grep -v f m.obj; echo 'o a'; grep '^f' m.obj; echo 'o b'; grep '^f' m.obj; } > n.obj
    mv n.obj m.obj
    scene robot.urdf --objects
    shows '.bodies[0].frames[1:][].vertices | length'
    is $'1024\n1024'
}

@test "hulls of a body that does not fit into a message get as many vertices as fit" {
    { for i in 1 2 3; do echo "o $i"; awk 'BEGIN { for (i = 0; i < 1000; i++) print "v", i, i * i, 0; for (i = 3; i <= 1000; i++) print "f -1000 -999 -" i - 2 }'; done; } > m.obj
    link "<collision><geometry><mesh filename='m.obj'/></geometry></collision>"
    scene robot.urdf --objects
    says '; hulls extend beyond what they enclose by at most '
    shows '.bodies[0].frames | map(.vertices | length), map(.radius > 0)'
    is $'[881,881,881]\n[true,true,true]'
    # 63,500 bytes are 4,884 objects of a vertex and a radius at least.
    { echo 'v 0 0 0'; echo 'v 1 0 0'; echo 'v 0 1 0'; for ((i = 0; i < 2000; i++)); do echo o; echo f 1 2 3; done; } > m.obj
    refused '2000 frames take ' robot.urdf --objects
    [[ $stderr == *' bytes in a message, which has space for 63500: simplify its meshes, or give fewer --sides' ]]
}

@test "--excess bounds how far a hull extends beyond its mesh, and saves vertices" {
    sphere 500
    scene robot.urdf
    [[ $stderr != *extend* ]]
    shows '.bodies[0] | (.vertices | length), .radius'
    is $'500\nnull'
    before=500
    for excess in 0.02 0.1 0.5; do
        scene robot.urdf --excess "$excess"
        shows ".bodies[0] | .radius > 0 and .radius <= $excess, (.vertices | length)"
        [ "${output%$'\n'*}" = true ] && [ "${output#*$'\n'}" -lt "$before" ]
        before=${output#*$'\n'}
    done
    scene robot.urdf --excess 5
    shows '.bodies[0].frames | map([.shape, .radius < 2])'
    is '[["sphere",true]]'
    # Where fewer vertices lose nothing, there is no radius.
    printf 'v %s\n' '0 0 0' '4 0 0' '0 4 0' '0 0 4' '1 1 1' '0 2 2' > m.obj
    printf 'f %s\n' '1 2 3' '4 5 6' >> m.obj
    scene robot.urdf --excess 0.001
    [[ $stderr != *extend* ]]
    shows '.bodies[0] | .vertices, .radius'
    is $'[[0,0,0],[4,0,0],[0,4,0],[0,0,4]]\nnull'
}

# Coordinates that span the doubles: most points need exact arithmetic.
@test "the progress of a hull is shown on a terminal only" {
    script -qfc true /dev/null < /dev/null > /dev/null 2>&1 3>&- || skip 'there is no pseudo-terminal'
    awk 'BEGIN {
        srand(1)
        for (i = 1; i <= 20000; i++) {
            printf "v"
            for (axis = 0; axis < 3; axis++) printf " %s%.9fe%d", rand() < 0.5 ? "-" : "", 1 + 9 * rand(), 600 * rand() - 300
            print ""
        }
        for (i = 3; i <= 20000; i++) print "f", i - 2, i - 1, i
    }' > m.obj
    link "<collision><geometry><mesh filename='m.obj'/></geometry></collision>"
    script -qfc "'$FMB' scene robot.urdf" screen < /dev/null > /dev/null 3>&- &
    script=$!
    wait_until grep -q 'fmb: [0-9,]* of 20,000 vertices of a hull' screen
    kill "$script" || true
    wait "$script" || true
    run --separate-stderr timeout 2 "$FMB" scene robot.urdf
    said ''
}

# ---- Poses -----------------------------------------------------------------------------------

@test "joints move links" {
    scene robot.urdf --joints slide=2,turn=0.5
    shows '.bodies | [.[1].position, .[2].position, .[1].orientation, .[1].orientation == .[2].orientation] |
        flatten | map(if type == "number" then . * 1000 | round else . end)'
    is '[0,0,4000,-959,1755,4000,969,0,0,247,true]'
}

@test "a value beyond a limit, or for an unknown joint, is an error, and is not clamped" {
    strict() { refused "$@" --limit-slack 0; }
    strict "--joints: joint 'turn': 2.0000000000000004 is outside its limits, -1 to 2 radians" robot.urdf --joints turn=2.0000000000000004
    strict "--joints: joint 'slide': -1.5 is outside its limits, -1 to 2" robot.urdf --joints turn=2,slide=-1.5
    strict "--joints: 'elbow' is not a joint of robot.urdf" robot.urdf --joints elbow=1
    strict "--joints: joint 'turn' is given twice" robot.urdf --joints turn=1,turn=1
    strict "--joints: expected name=value,..., found 'turn'" robot.urdf --joints turn
    strict "expected name=value,..., found ''" robot.urdf --joints turn=1,
    strict "--joints: joint 'turn': expected a finite number, found '1e999'" robot.urdf --joints turn=1e999
    sed -i 's/lower="-1"/lower="0.5"/' robot.urdf
    scene robot.urdf --joints turn=2,slide=0.5
    ended 0
    sed -i "s/'revolute'/'continuous'/" robot.urdf
    scene robot.urdf --joints turn=1000000,slide=1
    says "fmb: joints: joint 'turn': 1000000 is more than a full turn: is it in degrees? Values are in radians"
    ended 0
    refused "is beyond 1048576 radians" robot.urdf --joints turn=-2000000,slide=1 --limit-slack inf
    sed -i "s/'continuous'/'fixed'/" robot.urdf
    refused "--joints: 'turn' is a fixed joint of robot.urdf" robot.urdf --joints turn=0
}

@test "values within --limit-slack are used as they are, and counted; beyond it, all joints are named" {
    scene robot.urdf --joints turn=2.0000026
    says "fmb: joints: values outside limits, within --limit-slack 0.001 or of mimic joints: 1, the farthest 2.0000026 of 'turn'"
    shows .bodies[1].orientation
    found=$output
    sed -i 's/upper="2"/upper="1000"/' robot.urdf
    scene robot.urdf --joints turn=2.0000026
    [[ $stderr != *joints* ]]
    shows .bodies[1].orientation
    is "$found"
    sed -i 's/upper="1000"/upper="2"/' robot.urdf
    printf '%s\n' turn,slide 2.0005,0 0,2.00025 2.0001,0 > t.csv
    scene robot.urdf --joints-csv t.csv
    says "fmb: t.csv: rows: 3, largest step 2.0005 of 'turn' to line 3; values outside limits, within --limit-slack 0.001 or of mimic joints: 3, the farthest 2.0005 of 'turn' in line 2"
    shows .dim
    is $'3\n3\n3'
    printf '%s\n' turn,slide 90,0 -180,2.25 2.0005,-1.5 > t.csv
    scene robot.urdf --joints-csv t.csv
    ended 2
    is ''
    said "fmb: t.csv: line 3: joint 'turn': -180 is outside its limits, -1 to 2 radians
fmb: t.csv: line 4: joint 'slide': -1.5 is outside its limits, -1 to 2
fmb: t.csv: line 3: joint 'turn': -180 is more than a full turn: is it in degrees? Values are in radians"
    scene robot.urdf --joints-csv t.csv --limit-slack inf
    says "; values outside limits, within --limit-slack inf or of mimic joints: 5, the farthest -180 of 'turn' in line 3"
    # So is a mimic joint, unless nothing is given of it.
    sed -i "s|child link='tool'/>|&<mimic joint='turn' multiplier='-2'/>|; s/lower=\"-1\"/lower=\"0.5\"/" robot.urdf
    scene robot.urdf --joints turn=0.49975 --limit-slack 1.5
    says "within --limit-slack 1.5 or of mimic joints: 2, the farthest -0.9995 of 'slide'"
    scene robot.urdf
    ended 0
    says "fmb: joints: in the middle of their limits, as 0 is outside: turn"
    scene robot.urdf --joints turn=1e308 --limit-slack inf
    ended 2
    said "fmb: --joints: joint 'turn': 1e+308 is beyond 1048576 radians
fmb: robot.urdf: joint 'slide' (a mimic of 'turn'): -inf is outside its limits, 0.5 to 2"
}

@test "a mimic joint follows another unless it is given" {
    sed -i "s|child link='tool'/>|&<mimic joint='turn' multiplier='-2' offset='0.25'/>|" robot.urdf
    # positions ARGUMENTS...: how far the tool is from the arm, by row.
    positions() {
        scene robot.urdf "$@"
        shows '(.bodies[2].position[1] | fabs) as $y | .bodies[2].position[0] as $x | $x * $x + $y * $y | sqrt * 1e9 | round / 1e9'
    }
    positions
    is 0.25
    positions --joints turn=-0.5
    is 1.25
    positions --joints turn=-0.5,slide=0.5
    is 0.5
    # A mimic joint may exceed its limits, unless its value is given.
    positions --joints turn=0.75
    is 1.25
    [[ $stderr == *"or of mimic joints: 1, the farthest -1.25 of 'slide'"* ]]
    refused "--joints: joint 'slide': -1.25 is outside its limits, -1 to 2" robot.urdf --joints turn=0.75,slide=-1.25
    printf 'turn\n-0.5\n0.5\n' > t.csv
    positions --joints-csv t.csv
    is '1.25
0.75'
    [[ $stderr == *"to line 3; not in it: slide" ]]
    printf 'turn,slide\n0.5,0.5\n' > t.csv
    positions --joints-csv - < t.csv
    is 0.5
    printf 'turn\n0\n0.75\n' > t.csv
    positions --joints-csv t.csv
    [[ $stderr == *"the farthest -1.25 of 'slide' in line 3"* ]]
}

@test "a table gives a scene for each row, with label and time" {
    printf '\xef\xbb\xbf \r\ntime, slide ,"label" \r\n0 ,1,\r\n\t\r\n0.25, "2" ,"a ""b"", c"\r\n1,-0.5, end ' > t.csv
    scene robot.urdf --joints turn=0 --joints-csv t.csv
    said "fmb: robot.urdf: links: 3, with a body: 3; size: 1 x 3 x 7 in the first pose
fmb: pairs tested: 1, ignored: 2: 2 neighbours
fmb: t.csv: rows: 3, largest step 2.5 of 'slide' to line 6; not in it: turn"
    shows '[.label, .duration, .bodies[2].position[1]]'
    is '["t = 0",0.25,1]
["a \"b\", c (t = 0.25)",0.75,2]
["end (t = 1)",0,-0.5]'
    printf 'turn,slide\n1,0\n' > t.csv
    scene robot.urdf --joints-csv t.csv
    shows '[has("label"), .duration]'
    is '[false,0]'
}

# The output is empty, so that fmb query after the pipe fails too.
@test "an error anywhere in a table prints no scene" {
    # bad TEXT LINE...: lines of the table.
    bad() {
        printf '%s\n' "${@:2}" > t.csv
        refused "$1" robot.urdf --joints-csv t.csv
    }
    bad "t.csv: line 3: joint 'turn': 3 is outside its limits, -1 to 2" turn,slide 1,1 3,1
    bad "t.csv: line 2: joint 'turn': expected a finite number, found 'x'" turn,slide x,1
    bad "t.csv: line 3: 1 columns, but the first line has 2" turn,slide 1,1 1
    bad "t.csv: line 2: 3 columns" turn,slide 1,1,1
    bad "t.csv: line 1: no column for joint 'slide': add one, or give its value by --joints" turn
    echo elbow > t.csv
    scene robot.urdf --joints-csv t.csv
    ended 2
    said "fmb: t.csv: line 1: no column for joint 'turn': add one, or give its value by --joints
fmb: t.csv: line 1: no column for joint 'slide': add one, or give its value by --joints"
    bad "t.csv: line 1: joint 'turn' is given twice" turn,slide,turn
    bad "t.csv: line 1: column 'time' appears twice" turn,time,slide,time
    bad "t.csv: line 3: column 'time': earlier than in the previous row, 2" turn,slide,time 1,1,2 1,1,1
    bad "t.csv: line 3: column 'time': more than doubles hold after the previous row, -1e+308" turn,slide,time 1,1,-1e308 1,1,1e308
    bad "t.csv: line 2: column 'time': expected a finite number" turn,slide,time 1,1,
    bad "t.csv: line 2: a quote is misplaced or missing" turn,slide '"1,1'
    bad "t.csv: line 2: the label, time included, has more than 64 bytes" turn,slide,label "1,1,$(printf '%065d' 0)"
    # No row is lost to line ends of another kind, nor behind a zero byte.
    printf 'turn,slide\r1,1\r' > t.csv
    refused 't.csv: line 1: a carriage return within the line' robot.urdf --joints-csv t.csv
    printf 'turn,slide\n1,1\r,9\n' > t.csv
    refused 't.csv: line 2: a carriage return within the line' robot.urdf --joints-csv t.csv
    printf 'turn,slide\n1,1\0002' > t.csv
    refused 't.csv: line 2: has a zero byte' robot.urdf --joints-csv t.csv
    printf 'turn,slide\n\0001,1' > t.csv
    refused 't.csv: line 2: has a zero byte' robot.urdf --joints-csv t.csv
    : > t.csv
    refused 't.csv: expected a line of joint names, found none' robot.urdf --joints-csv t.csv
    bad 't.csv: line 3: expected a row of joint values, found none' turn,slide ''
    refused 'none.csv: No such file' robot.urdf --joints-csv none.csv
    refused '/dev/null: expected a line of joint names' robot.urdf --joints-csv /dev/null
    refused '.: line 1: Is a directory' robot.urdf --joints-csv .
}

# Within 5 s and 256 MB. The limit of a line includes its line feed.
@test "a table whose line has no end is refused, from a file, a device and a pipe" {
    limited() {
        # shellcheck disable=SC2016
        run --separate-stderr timeout 5 bash -c 'ulimit -v 262144; exec "$0" "$@"' "$FMB" "$1" robot.urdf --joints-csv "$2"
        ended 2
        is ''
        said "fmb: $3: has a zero byte (save the table as UTF-8), or more than 1048575 bytes (give fewer columns)"
    }
    rows() {
        printf '%s\n' turn,slide 0,0 0.5,0
    }
    for command in scene path; do
        limited $command /dev/zero '/dev/zero: line 1'
        rows > t.csv
        truncate -s 3G t.csv
        limited $command t.csv 't.csv: line 4'
        limited $command - 'standard input: line 4' < <(rows && tr '\0' 1 < /dev/zero)
        mkfifo pipe
        (rows && tr '\0' 1 < /dev/zero) > pipe 2> /dev/null &
        limited $command pipe 'pipe: line 4'
        rm pipe
    done
    for zeros in 1048570 1048571; do
        { rows && printf "%0${zeros}d,0.5" 0 && echo; } > t.csv
        if [ $zeros = 1048570 ]; then
            scene robot.urdf --joints-csv t.csv
            ended 0
        else
            limited scene t.csv 't.csv: line 4'
        fi
    done
}

# ---- The world -------------------------------------------------------------------------------

@test "a world adds its bodies, ignored pairs, duration and margin; clashing ids change, which --verbose reports" {
    cube='"shape": "box", "size": [1,1,1]'
    echo "{\"dim\": 3, \"duration\": 2, \"margin\": 0.5, \"bodies\": [{\"id\": 3, \"name\": \"x\", $cube},
        {\"id\": 7, $cube, \"group\": 4}, {\"id\": 1, $cube, \"velocity\": [1,0,0]}], \"ignore\": [[1,7]]}" > world.json
    scene robot.urdf --with world.json
    says 'pairs tested: 12, ignored: 3: 2 neighbours, 1 by scenes'
    shows '[.duration, .margin, [.bodies[].id], .bodies[3].name, .bodies[4].group, .ignore]'
    is '[2,0.5,[1,2,3,4,7,5],"x",4,[[1,2],[2,3],[7,5]]]'
    scene robot.urdf --with world.json --verbose
    grep -qx 'fmb: ids of links (1 to 3) or of others: 2 bodies get the lowest free ids, in order' <<< "$stderr"
    # With times, its bodies move on from row to row.
    printf 'turn,slide,time\n0,0,-10.5\n0,0,-10\n' > t.csv
    scene robot.urdf --with world.json --joints-csv t.csv --margin 0
    shows '[.duration, has("margin"), .bodies[5].position]'
    is '[0.5,false,null]
[0,false,[0.5,0,0]]'
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 9, $cube, \"velocity\": [1e308,0,0]}]}" > world.json
    printf 'turn,slide,time\n0,0,0\n0,0,2\n' > t.csv
    refused 't.csv: line 3: body 9: not a finite number' robot.urdf --with world.json --joints-csv t.csv
}

@test "a world keeps the ends of its bodies, in its own window" {
    body='{"id": 9, "shape": "box", "size": [1,1,1], "orientation": [1,0,0,0], "end": {"position": [0,0,1], "orientation": [1,0,0,0.5]}}'
    echo "{\"dim\": 3, \"duration\": 2, \"bodies\": [$body]}" > world.json
    scene robot.urdf --with world.json
    ended 0
    shows '[.duration, (.bodies[-1] | .orientation, .end)]'
    is '[2,[1,0,0,0],{"position":[0,0,1],"orientation":[1,0,0,0.5]}]'
    printf 'turn,slide\n0,0\n0.5,0\n' > t.csv
    scene robot.urdf --with world.json --joints-csv t.csv
    shows '[.duration, .bodies[-1].end.position[2]]'
    is $'[2,1]\n[2,1]'
    printf 'turn,slide,time\n0,0,0\n0,0,2\n' > t.csv
    refused 't.csv: it has times, but body 9 has an "end" of one window' robot.urdf --with world.json --joints-csv t.csv
    echo '{"dim": 3, "duration": 3, "bodies": []}' > longer.json
    refused 'world.json: body 9: its "end" is for a window of another "duration"' robot.urdf --with world.json --with longer.json
    sed -i 's/"shape"/"link": "arm", &/' world.json
    refused 'world.json: body 9: a body that a link carries has no velocity or end of its own' robot.urdf --with world.json
}

@test "a world that is not one scene in 3D of all pairs is refused" {
    cube='"shape": "box", "size": [1,1,1]'
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 3, $cube}, {\"id\": 4, $cube}], \"pairs\": [[3,4]]}" > world.json
    refused 'world.json: "pairs" would leave out the robot' robot.urdf --with world.json
    echo '{"dim": 2, "bodies": [{"id": 1, "shape": "box", "size": [1,1]}]}' > world.json
    refused 'world.json: expected a scene in 3D' robot.urdf --with world.json
    echo '{"dim": 3, "bodies": []} {"dim": 3, "bodies": []}' > world.json
    refused 'world.json: expected one scene, found a second one' robot.urdf --with world.json
    echo '{"dim": 3, "bodies": [{"id": 0}]}' > world.json
    refused 'world.json: bodies[0]' robot.urdf --with world.json
    refused 'none.json: No such file' robot.urdf --with none.json
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 9, $cube}], \"ignore\": [[1,9]]}" > world.json
    refused 'world.json: ignore[0][0]: no body has the id 1 (--ignore takes names of links)' robot.urdf --with world.json
}

@test "--ignore names pairs of links and of bodies of the world" {
    cube='"shape": "box", "size": [1,1,1]'
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 8, \"name\": \"x\", $cube}, {\"id\": 9, \"name\": \"y\", $cube},
        {\"id\": 10, \"name\": \"twice\", $cube}, {\"id\": 11, \"name\": \"twice\", $cube}], \"ignore\": [[9,10]]}" > world.json
    scene robot.urdf --with world.json --ignore tool,base --ignore base,y --ignore=arm,base
    shows .ignore
    is '[[1,2],[1,3],[1,9],[2,3],[9,10]]'
    scene robot.urdf --ignore base,tool
    shows .ignore
    is '[[1,2],[1,3],[2,3]]'
    robot "<link name='a'>$box</link><link name='empty'/><link name='void'/>
        <joint name='j' type='fixed'><parent link='a'/><child link='empty'/></joint>
        <joint name='k' type='fixed'><parent link='a'/><child link='void'/></joint>"
    scene robot.urdf --with world.json --ignore a,x --ignore empty,void --ignore y,empty
    shows .ignore
    is '[[1,8],[9,10]]'
    refused "ignore: 'void,void': a body is no pair with itself" robot.urdf --ignore void,void
    refused "ignore: no body has the name 'z'" robot.urdf --ignore void,z
    setup
    refused "ignore: no body has the name 'z'" robot.urdf --with world.json --ignore base,z
    refused "ignore: no body has the name 'tool,x'" robot.urdf --with world.json --ignore base,tool,x
    refused "ignore: several bodies have the name 'twice'" robot.urdf --with world.json --ignore base,twice
    refused "ignore: 'arm,arm': a body is no pair with itself" robot.urdf --ignore arm,arm
    wrong scene robot.urdf --ignore arm
}

@test "--with takes scenes and robots; links of robots are obstacles of one group, in their home pose" {
    cube='"shape": "box", "size": [1,1,1]'
    echo "{\"dim\": 3, \"duration\": 2, \"margin\": 0.5, \"bodies\": [{\"id\": 9, \"name\": \"x\", $cube, \"group\": 5}]}" > a.json
    echo "{\"dim\": 3, \"duration\": 1, \"margin\": 0.75, \"bodies\": [{\"id\": 9, \"name\": \"y\", $cube, \"velocity\": [1,0,0]}], \"ignore\": []}" > b.json
    cp robot.urdf arm.urdf
    robot "<link name='shelf'>$box</link><link name='door'>$box</link>
        <joint name='hinge' type='revolute'><origin xyz='0 0 8'/><parent link='shelf'/><child link='door'/><limit lower='0.5' upper='1.5'/></joint>"
    mv robot.urdf shelf
    scene arm.urdf --with a.json --with shelf --with b.json
    says 'pairs tested: 18, ignored: 3: 2 neighbours, 1 within groups'
    shows '[.duration, .margin, [.bodies[] | [.id, .name, .group]], .ignore, .bodies[5].position, .bodies[5].orientation[0] > 0.87]'
    is '[2,0.75,[[1,"base",null],[2,"arm",null],[3,"tool",null],[9,"x",5],[4,"shelf",6],[5,"door",6],[6,"y",null]],[[1,2],[2,3]],[0,0,8],true]'
    # Two of them are of one group, and are not tested against each other.
    scene arm.urdf --with shelf --with shelf
    says 'pairs tested: 13, ignored: 8: 2 neighbours, 6 within groups'
    echo '<robot name="r"><link name="a"/></robot>' > empty.urdf
    refused 'empty.urdf: no link has a <collision>' arm.urdf --with empty.urdf
    echo '<robot name="r"><joint name="j" type="floating"><parent link="b"/><child link="a"/></joint></robot>' > bad.urdf
    scene arm.urdf --with bad.urdf --with none.json
    ended 2
    [ "$(wc -l <<< "$stderr")" = 3 ]
    for text in "bad.urdf: line 1: joint 'j': its type" 'bad.urdf: line 1: <robot> has no <link>' 'none.json: No such file'; do
        grep -qF "$text" <<< "$stderr"
    done
}

@test "a body with a link is carried: its pose is in the link, it is not tested against it, and it comes after the links" {
    cube='"shape": "box", "size": [1,1,1]'
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 7, \"name\": \"table\", $cube, \"position\": [9,0,0]},
        {\"id\": 8, \"name\": \"cup\", $cube, \"position\": [0,0,2], \"orientation\": [1,0,0,1], \"link\": \"tool\"},
        {\"id\": 9, \"name\": \"pen\", $cube, \"link\": \"tool\"}], \"ignore\": [[\"table\",\"pen\"]]}" > world.json
    scene robot.urdf --with world.json --joints slide=2 --ignore cup,pen
    says 'ignored: 6: 2 neighbours, 2 carried, 1 by scenes, 1 by --ignore'
    shows '[[.bodies[].name], .ignore, .bodies[3].position, .bodies[3].orientation, .bodies[4].position]'
    is '[["base","arm","tool","cup","pen","table"],[[1,2],[2,3],[3,8],[3,9],[8,9],[9,7]],[0,2,6],[1,0,0,1],[0,2,4]]'
    printf '%s\n' turn,slide,time 0,0,0 3.1415926535897931,1,1 0,0,2 > t.csv
    sed -i 's/upper="2"/upper="4"/' robot.urdf
    scene robot.urdf --with world.json --joints-csv t.csv
    shows '.bodies[3].position | map(. * 1e6 | round / 1e6)'
    is $'[0,0,6]\n[0,-1,6]\n[0,0,6]'
    # A link without a body may carry one.
    sed -i "s|<link name='tool'>.*</link>|<link name='tool'/>|" robot.urdf
    scene robot.urdf --with world.json
    ended 0
    shows .ignore
    is '[[1,2],[9,7]]'
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 7, \"name\": \"a\", $cube, \"link\": \"hand\"}, {\"id\": 8, $cube, \"link\": \"\"},
        {\"id\": 9, \"name\": \"c\", $cube, \"link\": \"arm\", \"velocity\": [0,0,1]}]}" > bad.json
    scene robot.urdf --with bad.json
    ended 2
    said "fmb: bad.json: body 7, a: the robot has no link 'hand'
fmb: bad.json: body 8: the robot has no link ''
fmb: bad.json: body 9, c: a body that a link carries has no velocity or end of its own"
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 7, $cube, \"link\": \"arm\"}, {\"id\": 7, $cube, \"link\": \"base\"}]}" > bad.json
    refused 'bad.json: bodies[1].id: 7 is the id of bodies[0] already' robot.urdf --with bad.json
    echo "{\"dim\": 3, \"bodies\": [{\"id\": 7, $cube, \"link\": 3}]}" > bad.json
    refused 'bad.json: bodies[0].link: expected a string' robot.urdf --with bad.json
    run --separate-stderr "$FMB" query --local world.json
    ended 2
    said 'fmb: world.json: bodies[1].link: only bodies that are added to a robot may have it (fmb scene --with)'
}

@test "--base places the robot as an origin of its root would" {
    robot "<link name='world'/><joint name='mount' type='fixed'><origin xyz='1 2 3' rpy='0.1 0.2 0.3'/><parent link='world'/><child link='base'/></joint>
        $(sed '1,2d;$d' robot.urdf)"
    scene robot.urdf --joints turn=1,slide=0.5
    shows .bodies
    mounted=$output
    setup
    scene robot.urdf --joints turn=1,slide=0.5 --base 1,2,3,0.1,0.2,0.3
    shows .bodies
    is "$mounted"
    scene robot.urdf --base=-1,2,1e1
    shows '[.bodies[] | [.position, .orientation]]'
    is '[[[-1,2,10],null],[[-1,2,14],null],[[-1,2,14],null]]'
    refused 'base: expected finite numbers, angles up to 1048576 radians' robot.urdf --base 0,0,0,1e9,0,0
}

# ---- Ignored pairs -----------------------------------------------------------------------------

# A palm with a sensor that is screwed on, below an empty frame, two fingers, and a body in the world's group -1.
hand() {
    robot "<link name='palm'>$box</link><link name='frame'/><link name='sensor'>$box</link><link name='lens'>$box</link>
        <link name='left'>$box</link><link name='right'>$box</link><link name='tip'>$box</link>
        $(while read -r name type parent child; do
            echo "<joint name='$name' type='$type'><parent link='$parent'/><child link='$child'/></joint>"
        done <<< 'a fixed palm frame
b fixed frame sensor
c fixed sensor lens
d continuous palm left
e continuous palm right
f fixed left tip')"
}

@test "links that fixed joints alone connect have one group, which no body of the world has" {
    hand
    scene robot.urdf
    says 'pairs tested: 9, ignored: 6: 2 neighbours, 4 joined rigidly'
    shows '[[.bodies[] | [.name, .group]], .ignore]'
    is '[[["palm",-1],["sensor",-1],["lens",-1],["left",-2],["right",null],["tip",-2]],[[1,4],[1,5]]]'
    echo '{"dim": 3, "bodies": [{"id": 7, "shape": "sphere", "radius": 1, "group": -1}]}' > world.json
    scene robot.urdf --with world.json --verbose
    grep -qx 'fmb: joined rigidly: palm and lens' <<< "$stderr"
    shows '[.bodies[] | .group]'
    is '[-2,-2,-2,-3,null,-3,-1]'
}

@test "--srdf replaces neighbours and rigid bodies by the pairs that it disables" {
    hand
    # srdf ELEMENTS: writes robot.srdf.
    srdf() {
        echo "<robot name='r'>$1</robot>" > robot.srdf
    }
    # disable A B: an element.
    disable() { echo "<disable_collisions link1='$1' link2='$2' reason='Adjacent'/>"; }
    srdf "<group name='g'><link name='palm'/></group><group_state name='s'/><virtual_joint/>
        $(disable palm left)$(disable lens sensor)$(disable right tip)$(disable tip right)$(disable frame right)"
    scene robot.urdf --srdf robot.srdf
    # Of the neighbours palm-sensor, sensor-lens, palm-left, palm-right and left-tip it has two.
    says 'pairs tested: 12, ignored: 3: 3 by the SRDF; tested neighbours that the SRDF does not list: 3'
    shows '[.ignore, [.bodies[].group]]'
    is '[[[1,4],[2,3],[5,6]],[null,null,null,null,null,null]]'
    # A link that is not tested unless a pair is enabled; disabled pairs come first, and --ignore adds to them.
    echo '{"dim": 3, "bodies": [{"id": 7, "name": "ball", "shape": "sphere", "radius": 1}, {"id": 8, "name": "cup", "shape": "sphere", "radius": 1, "link": "left"}]}' > world.json
    srdf "<disable_default_collisions link='right'/><disable_default_collisions link='frame'/>
        <enable_collisions link1='palm' link2='right'/><enable_collisions link1='tip' link2='right'/>$(disable right tip)"
    scene robot.urdf --srdf robot.srdf --with world.json --ignore palm,ball
    says 'ignored: 8: 1 by the SRDF, 5 by its defaults, 1 carried, 1 by --ignore; tested neighbours that the SRDF does not list: 5'
    shows '.ignore'
    is '[[1,7],[2,5],[3,5],[4,5],[4,8],[5,6],[5,8],[5,7]]'
    # Links that the robot does not have.
    srdf "$(disable palm thumb)$(disable thumb wrist)$(disable left palm)<disable_default_collisions link='x&#10;y'/>"
    scene robot.urdf --srdf robot.srdf
    says 'links of the SRDF that the robot does not have: 3 (thumb, wrist, x\x0ay)'
    scene robot.urdf --srdf robot.srdf --verbose
    grep -qx 'fmb: the robot has no link: wrist' <<< "$stderr"
    srdf "$(for i in 0 1 2 3 4 5 6 7 8; do disable "l$i" palm; done)"
    scene robot.urdf --srdf robot.srdf
    says '9 (l0, l1, l2, l3, l4, l5, l6, l7, ...)'
    # A file without pairs is valid.
    srdf ''
    scene robot.urdf --srdf robot.srdf
    says 'pairs tested: 15, ignored: 0; tested neighbours that the SRDF does not list: 5'
}

@test "an SRDF file of another robot, of another kind or that is broken is refused" {
    hand
    of() {
        echo "$1" > robot.srdf
        refused "robot.srdf: $2" robot.urdf --srdf robot.srdf
    }
    of "<robot><disable_collisions link1='a' link2='b'/></robot>" 'no link that it names is one of robot.urdf: is it of another robot?'
    of "<robot><disable_collisions link1='palm'/></robot>" 'line 1: <disable_collisions> has no link2'
    of "<robot><disable_default_collisions link=''/></robot>" 'line 1: <disable_default_collisions>: link is empty'
    of "<robot><link name='palm'/></robot>" 'line 1: <link>: this is URDF: --srdf takes a file of SRDF'
    of '<sdf/>' 'line 1: expected <robot>, found <sdf>: give a file of SRDF'
    of '<robot>' 'line 2: XML: no element found: the file ends too early'
    of '<!DOCTYPE robot [<!ENTITY e "palm">]><robot><disable_collisions link1="&e;" link2="left"/></robot>' 'line 1: <!DOCTYPE>: document types and entities are not supported: remove the declaration'
    refused 'none.srdf: No such file' robot.urdf --srdf none.srdf
    # Together with the errors of the robot itself.
    echo "<robot><disable_collisions link1='palm'/></robot>" > robot.srdf
    sed -i "s/name='e' type='continuous'/name='e' type='floating'/; s/parent link='left'/parent link='thumb'/" robot.urdf
    scene robot.urdf --srdf robot.srdf
    ended 2
    [ "$(cut -d : -f 2-5 <<< "$stderr")" = " robot.urdf: line 9: joint 'e': its type is 'floating', expected revolute, continuous, prismatic or fixed (in place of planar or floating
 robot.urdf: line 10: joint 'f': its parent 'thumb' is not a link of the file
 robot.srdf: line 1: <disable_collisions> has no link2" ]
}

# ---- Robots as people have them ----------------------------------------------------------------

@test "quat_xyzw of an origin is used as it is" {
    robot "<link name='a'>$box</link><link name='b'><collision><origin xyz='1 0 0' quat_xyzw='0 0 2 2'/><geometry><box size='1 1 1'/></geometry></collision></link>
        <joint name='j' type='fixed'><origin xyz='0 0 1' quat_xyzw='0.5 0 0 0.5'/><parent link='a'/><child link='b'/></joint>"
    scene robot.urdf
    shows '.bodies[1] | [.position, .orientation]'
    is '[[1,0,1],[1,1,-1,1]]'
    # However long.
    for q in '1 2 3 4' '1e100 2e100 3e100 4e100' '1e-100 2e-100 3e-100 4e-100' '1e-300 2e-300 3e-300 4e-300'; do
        link "<collision><origin quat_xyzw='$q'/><geometry><box size='1 1 1'/></geometry></collision>"
        scene robot.urdf
        shows '.bodies[0].orientation | map(. / $o[1] * 1e9 | round / 1e9)' --argjson o "$(jq -c '.bodies[0].orientation' <<< "$output")"
        is '[4,1,2,3]'
    done
    # Many of them neither overflow nor underflow.
    chain="<link name='l0'>$box</link>" turn=('-3e-3 -4e-3 0 0' '3e9 4e9 0 0')
    for ((i = 1; i < 600; i++)); do
        chain+="<link name='l$i'>$box</link><joint name='j$i' type='fixed'><origin quat_xyzw='${turn[i % 2]}'/><parent link='l$((i - 1))'/><child link='l$i'/></joint>"
    done
    robot "$chain"
    scene robot.urdf
    ended 0
    shows '.bodies[598] | .position, (.orientation | .[0] as $w | map(. / $w | fabs < 1e-12))'
    is $'null\n[false,true,true,true]'
}

@test "columns of fixed joints or of unknown names are ignored and counted; a column of a mimic joint is used, and the largest difference reported" {
    sed -i "s|child link='tool'/>|&<mimic joint='turn' multiplier='2'/>|; s|</robot>|<link name='end'/><joint name='weld' type='fixed'><parent link='tool'/><child link='end'/></joint></robot>|" robot.urdf
    printf '%s\n' 'weld,time,turn,slide,effort,mode' 'x,0,0.25,0.5,NaN,a' ',1,0.5,1.25,,b' '0,2,0.5,0.875,1,c' > t.csv
    scene robot.urdf --joints-csv t.csv
    says "fmb: t.csv: rows: 3, largest step 0.75 of 'slide' to line 3; ignored: columns of fixed joints: 1; ignored: columns of no joint: 2 ('effort'); mimic 'slide' differs from what it follows by up to 0.25 (line 3)"
    shows '.bodies[2].position | .[0] * .[0] + .[1] * .[1] | . * 1e9 | round / 1e9'
    is $'0.25\n1.5625\n0.765625'
    scene robot.urdf --joints turn=0.5,slide=1.125
    says "fmb: joints: mimic 'slide' differs from what it follows by up to 0.125"
}

@test "a package is the nearest folder above the robot that has its name, or whose package.xml has that name" {
    mkdir -p ws/arm/robots ws/arm/arm/meshes ws/arm/meshes other/meshes
    printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' > ws/arm/meshes/m.obj
    echo 'f 1 2 3' >> ws/arm/meshes/m.obj
    sed 's/v 1/v 2/' ws/arm/meshes/m.obj > other/meshes/m.obj
    link "<collision><geometry><mesh filename='package://arm/meshes/m.obj'/></geometry></collision>"
    mv robot.urdf ws/arm/robots
    width='.bodies[0].vertices | map(.[0]) | max'
    scene ws/arm/robots/robot.urdf
    shows "$width"
    is 1
    cd ws/arm/robots
    scene - < robot.urdf
    shows "$width"
    is 1
    cd ../../..
    # The name in package.xml decides, not a name in a comment. The nearest folder is used.
    mv ws/arm ws/src
    refused 'package://arm/meshes/m.obj: not found: no folder above the robot is called arm, or has a package.xml with this name' ws/src/robots/robot.urdf
    for xml in '<package><!-- <name>no</name> --><name> arm </name></package>' $'<package format="2">\n<name>arm</name>'; do
        echo "$xml" > ws/src/package.xml
        scene ws/src/robots/robot.urdf
        shows "$width"
        is 1
    done
    for xml in '<package><!-- <name>arm</name> --><name>no</name></package>' '<name>arms</name>' '<name>ar</name>' '<name>' '<!--' ''; do
        echo "$xml" > ws/src/package.xml
        refused 'package://arm/meshes/m.obj: not found' ws/src/robots/robot.urdf
    done
    # Folders of --package-path come first.
    ln -s ../other ws/arm
    echo '<name>arm</name>' > ws/src/package.xml
    scene ws/src/robots/robot.urdf --package-path ws
    shows "$width"
    is 2
    scene ws/src/robots/robot.urdf --package-path /nowhere
    shows "$width"
    is 1
}

@test "all errors of a robot are reported at once, at most 100" {
    robot "<link name='a'>$box<collision><geometry><cone/></geometry></collision><collision/>
<collision><geometry><mesh filename='none.stl'/></geometry></collision></link>
<link name='a'/><link/>
<link name='b'><collision><origin xyz='1 2'/><geometry><box size='-1 1 1'/></geometry></collision></link>
<joint name='j' type='planar'><parent link='a'/><child link='b'/></joint>
<joint name='k' type='revolute'><parent link='b'/><child link='c'/><limit lower='nan' upper='1'/></joint>
<joint name='l' type='fixed'><parent link='a'/><child link='z'/></joint>"
    scene robot.urdf
    ended 2
    is ''
    [ "$(grep -o 'line [0-9]*: .*' <<< "$stderr" | cut -c 1-32)" = "line 3: link 'a': <cone>: expect
line 3: link 'a': <collision> ha
line 5: there is already a link 
line 5: <link> has no name
line 6: link 'b': <origin>: xyz 
line 7: joint 'j': its type is '
line 8: joint 'k': <limit>: lowe
line 8: joint 'k': its child 'c'
line 9: joint 'l': its child 'z'
line 4: link 'a': none.stl: No s" ]
    robot "$(for ((i = 0; i < 250; i++)); do echo "<link name='l$i'><collision/></link>"; done)"
    scene robot.urdf
    ended 2
    [ "$(wc -l <<< "$stderr")" = 101 ]
    [[ $stderr == *$'\nfmb: robot.urdf: and 150 more errors' ]]
}

@test "a robot without joints, or with joints and bodies in one link only, is a scene" {
    link "$box"
    scene robot.urdf
    ended 0
    said 'fmb: robot.urdf: links: 1, with a body: 1; size: 1 x 2 x 3
fmb: pairs tested: 0, ignored: 0'
    echo time > t.csv
    echo 1 >> t.csv
    scene robot.urdf --joints-csv t.csv
    says 'fmb: t.csv: rows: 1'
    ended 0
}

# ---- Bad robots ------------------------------------------------------------------------------

@test "a line end in a name leaves an error one line" {
    echo '<robot name="r"><link name="a&#10;b"/></robot>' > robot.urdf
    refused "robot.urdf: line 1: <link>: the name 'a\x0ab'" robot.urdf
    echo '<robot name="r"><link name="a"/><joint name="j" type="fixed"><parent link="x&#10;y"/><child link="a"/></joint></robot>' > robot.urdf
    refused "robot.urdf: line 1: joint 'j': <parent>: the link 'x\x0ay' has control characters" robot.urdf
    # Nor can a name forge another line.
    robot "<link name='a'/><link name='b'/><joint name='j' type='prismatic'><parent link='a'/><child link='b'/>
$limit<mimic joint='q&#10;fmb: all is well'/></joint>"
    refused "robot.urdf: line 3: joint 'j': <mimic>: 'q\x0afmb: all is well' is not a joint of the file" robot.urdf
}

@test "links and joints that are not a tree are refused" {
    # joined PARENT CHILD...: three links, and joints.
    joined() {
        local text="<link name='a'/>
<link name='b'/>
<link name='c'>$box</link>"
        while [ $# != 0 ]; do
            text+="
<joint name='$1$2' type='fixed'><parent link='$1'/><child link='$2'/></joint>"
            shift 2
        done
        robot "$text"
    }
    joined a b b c c b
    refused "robot.urdf: line 8: joint 'cb': its child 'b' is already the child of joint 'ab'" robot.urdf
    joined b c c b
    refused "robot.urdf: line 6: joint 'bc': the joints from 'c' lead back to it: expected a tree" robot.urdf
    joined a b b c c a
    refused "lead back to it" robot.urdf
    joined a a b c
    refused "line 6: joint 'aa': the joints from 'a' lead back to it" robot.urdf
    joined b a
    refused "robot.urdf: line 5: link 'c' has no parent, and neither has link 'b': expected one root" robot.urdf
    joined a b
    refused "robot.urdf: line 5: link 'c' has no parent, and neither has link 'a': expected one root: connect them by a fixed joint" robot.urdf
    joined a b a d
    refused "robot.urdf: line 7: joint 'ad': its child 'd' is not a link of the file" robot.urdf
    joined a b d c
    refused "joint 'dc': its parent 'd' is not a link of the file" robot.urdf
    joined a b d c e a
    scene robot.urdf
    ended 2
    said "fmb: robot.urdf: line 7: joint 'dc': its parent 'd' is not a link of the file
fmb: robot.urdf: line 8: joint 'ea': its parent 'e' is not a link of the file"
}

@test "elements that are missing, repeated or wrong are refused with line and element" {
    shape() {
        link "
<collision>$1</collision>"
        refused "robot.urdf: line 4: link 'a': $2" robot.urdf
    }
    shape '' '<collision> has no <geometry> with a shape'
    shape '<geometry/>' '<collision> has no <geometry> with a shape'
    shape '<geometry><box/></geometry>' '<box> has no size'
    shape '<geometry><box size="1 2"/></geometry>' "<box>: size is '1 2', expected 3 finite numbers, separated by spaces"
    shape '<geometry><box size="1,5 2 3"/></geometry>' "<box>: size is '1,5 2 3', expected 3 finite numbers, separated by spaces"
    shape '<geometry><box size="1 2 3 4"/></geometry>' "<box>: size is '1 2 3 4', expected 3 finite numbers"
    shape '<geometry><box size="1 2 nan"/></geometry>' "<box>: size is '1 2 nan', expected 3 finite numbers"
    shape '<geometry><box size="1 -2 3"/></geometry>' '<box>: size is negative'
    shape '<geometry><box size="1 ${w} 3"/></geometry>' "<box>: size is '1 \${w} 3': expand the file with xacro first"
    shape '<geometry><mesh filename="$(find pkg)/a.stl"/></geometry>' "<mesh>: filename is '\$(find pkg)/a.stl': expand the file with xacro first"
    shape '<geometry><capsule radius="1"/></geometry>' '<capsule> has no length'
    shape '<geometry><capsule radius="-1" length="1"/></geometry>' '<capsule>: radius is negative'
    shape '<geometry><cone/></geometry>' '<cone>: expected a box, cylinder, sphere, capsule or mesh'
    shape '<geometry><sphere radius="1"/><sphere radius="1"/></geometry>' '<sphere>: there is already a shape'
    # Elements of other namespaces may stand beside a shape, but are not shapes.
    foreign='<drake:declare_convex/>'
    for shapes in "$foreign<sphere radius='1'/>" "<sphere radius='1'/>$foreign<drake:a/>" "$foreign<sphere radius='1'/>$foreign"; do
        robot "<link xmlns:drake='urn:drake' name='a'><collision><geometry>$shapes</geometry></collision></link>"
        scene robot.urdf
        ended 0
    done
    shape "<geometry xmlns:drake='urn:drake'>$foreign<sphere radius='1'/>$foreign<box size='1 1 1'/></geometry>" '<box>: there is already a shape'
    shape "<geometry xmlns:drake='urn:drake'>$foreign</geometry>" '<drake:declare_convex>: expected a box, cylinder, sphere, capsule or mesh'
    shape '<geometry><cylinder radius="1"/></geometry>' '<cylinder> has no length'
    shape '<geometry><sphere radius="inf"/></geometry>' "<sphere>: radius is 'inf', expected 1 finite number"
    shape '<geometry><cylinder radius="1.79e308" length="1"/></geometry>' 'not a finite number'
    shape '<origin rpy="1e9 0 0"/><geometry><sphere radius="1"/></geometry>' '<origin>: rpy is beyond 1048576 radians'
    shape '<geometry><mesh/></geometry>' '<mesh> has no filename'
    shape '<geometry><mesh filename=""/></geometry>' '<mesh>: filename is empty'
    shape '<origin quat_xyzw="0 0 1 1" rpy="0 0 0"/><geometry><sphere radius="1"/></geometry>' '<origin> has both rpy and quat_xyzw'
    shape '<origin quat_xyzw="0 0 0 0"/><geometry><sphere radius="1"/></geometry>' '<origin>: quat_xyzw is 0, which is no rotation'
    shape '<origin quat_xyzw="0 0 1 nan"/><geometry><sphere radius="1"/></geometry>' "<origin>: quat_xyzw is '0 0 1 nan', expected 4 finite numbers"
    shape '<origin quat="0 0 1 0"/><geometry><sphere radius="1"/></geometry>' '<origin>: quat is not supported: give xyz, and rpy or quat_xyzw'
    shape '<origin xyz=""/><geometry><sphere radius="1"/></geometry>' '<origin>: xyz is empty'
    joint() {
        robot "<link name='a'>$box</link><link name='b'/>
<joint name='j' type='$1'>$2</joint>"
        refused "robot.urdf: line 4: $3" robot.urdf
    }
    ends='<parent link="a"/><child link="b"/>'
    joint floating "$ends" "joint 'j': its type is 'floating', expected revolute, continuous, prismatic or fixed"
    joint planar "$ends" "joint 'j': its type is 'planar', expected revolute, continuous, prismatic or fixed (in place of planar or floating: a chain of these)"
    joint fixed '<parent link="a"/>' "joint 'j': there is no <child>"
    joint fixed '<child link="a"/>' "joint 'j': there is no <parent>"
    joint fixed "$ends<parent link='a'/>" "joint 'j': there is a second <parent>"
    joint revolute "$ends" "joint 'j': there is no <limit>, which a joint of this type needs"
    joint revolute "$ends<limit lower='2' upper='1'/>" "joint 'j': <limit>: lower is above upper: exchange them, or make a joint without limits continuous"
    joint revolute "$ends<limit lower='' upper='1'/>" "joint 'j': <limit>: lower is empty"
    joint prismatic "$ends<axis xyz='0 0 0'/>$limit" "joint 'j': <axis>: xyz is 0"
    joint revolute "$ends$limit<mimic/>" "joint 'j': <mimic> has no joint"
    joint revolute "$ends$limit<mimic joint='k' multiplier='x'/>" "joint 'j': <mimic>: multiplier"
    joint revolute "$ends$limit<mimic joint='k'/>" "joint 'j': <mimic>: 'k' is not a joint of the file"
    joint revolute "$ends$limit<mimic joint='j'/>" "joint 'j': <mimic>: 'j' is itself a mimic joint"
    # A fixed joint has no value: it follows none, and none follows it.
    links="<link name='a'>$box</link><link name='b'/><link name='c'/>
<joint name='f' type='fixed'>$ends<mimic joint='k'/></joint>
<joint name='j' type='revolute'><parent link='b'/><child link='c'/>$limit"
    robot "$links</joint>"
    scene robot.urdf
    ended 0
    robot "$links<mimic joint='f'/></joint>"
    refused "robot.urdf: line 5: joint 'j': <mimic>: 'f' is a fixed joint" robot.urdf
    robot "<link name='a'/>
<link name='a'/>"
    refused "robot.urdf: line 4: there is already a link 'a', in line 3" robot.urdf
    robot "<link name='$(printf '%065d' 0)'/>"
    refused 'has more than 64 bytes' robot.urdf
    robot '<link/>'
    refused 'robot.urdf: line 3: <link> has no name' robot.urdf
    robot ''
    refused 'robot.urdf: line 2: <robot> has no <link>' robot.urdf
    robot '<link name="a"><visual/></link>'
    refused 'robot.urdf: no link has a <collision> (<visual> is not read)' robot.urdf
    refused 'none.urdf: No such file' none.urdf
}

@test "a missing or broken mesh is refused" {
    mesh() {
        link "<collision><geometry><mesh filename='$1'/></geometry></collision>"
        refused "robot.urdf: line 3: link 'a': $2" robot.urdf
    }
    mesh none.stl 'none.stl: No such file'
    mesh 'package:\\pkg\m.stl' "package:\\\\pkg\\m.stl: expected a path with '/', file://PATH or package://NAME/PATH"
    mesh model://m.stl "model://m.stl: expected a path with '/', file://PATH or package://NAME/PATH"
    for path in package:// package://.. package://. package://m.obj package://m/ package:///m.obj package://../m.obj; do
        mesh "$path" "$path: expected a path with '/', file://PATH or package://NAME/PATH"
    done
    robot "<link name='a'><collision><geometry><mesh filename='a.stl'/></geometry></collision>
<collision><geometry><mesh filename='b.stl'/></geometry></collision></link>
<link name='b'><collision><geometry><mesh filename='c.dae'/></geometry></collision></link>
<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
    scene robot.urdf
    ended 2
    is ''
    said "fmb: robot.urdf: line 3: link 'a': a.stl: No such file or directory
fmb: robot.urdf: line 4: link 'a': b.stl: No such file or directory
fmb: robot.urdf: line 5: link 'b': c.dae: No such file or directory"
    printf 'v 0 0 0\nv 1 0 x\n' > m.obj
    mesh m.obj "m.obj: line 2: 'x' is not a number"
    printf 'v 0 0 0\nv 1 0 0\n' > m.obj
    mesh m.obj 'm.obj: the mesh has no faces'
    triangle m.stl
    link "<collision><geometry><mesh filename='m.stl' scale='1e308 1e308 1'/></geometry></collision>"
    scene robot.urdf
    ended 0
}

@test "other formats and wrong XML are refused" {
    for text in '<sdf version="1.6"/>|line 1: expected <robot>, found <sdf>: SDF and others are not supported: give the robot as URDF' \
        '<robot><link name="a"/><group name="g"/></robot>|line 1: <group>: this is SRDF: give it by --srdf' \
        '<robot><disable_collisions/></robot>|line 1: <disable_collisions>: this is SRDF: give it by --srdf, and the robot as URDF' \
        '<robot xmlns:xacro="x"><xacro:macro name="m"/></robot>|line 1: <xacro:macro>: expand the file with xacro first' \
        '<html/>|line 1: expected <robot>, found <html>' \
        '<robot>|line 2: XML: no element found: the file ends too early' \
        '<!-- > ---><robot>|line 2: XML: no element found: the file ends too early' \
        '<robot><!-- a|line 1: XML: unclosed token' \
        '<?xml verison="1.0"?>|line 1: XML: XML declaration not well-formed: write <?xml version="1.0"?>' \
        '<?xml version="1.0" encoding="gb2312"?>|line 1: XML: unknown encoding: save the file as UTF-8' \
        '<robot name="a & b"/>|line 1: XML: not well-formed (invalid token): a stray < or &, no space before an attribute, or text that is not UTF-8' \
        '<robot name="a"version="1"/>|line 1: XML: not well-formed (invalid token): a stray < or &, no space before an attribute' \
        '<robot></link></robot>|line 1: XML: mismatched tag' \
        '<robot name="a" name="b"/>|line 1: XML: duplicate attribute' \
        '|line 2: XML: no element found'; do
        echo "${text%|*}" > robot.urdf
        refused "robot.urdf: ${text##*|}" robot.urdf
    done
    head -c 9000000 /dev/zero | tr '\0' ' ' > robot.urdf
    refused 'robot.urdf: more than 8 MB' robot.urdf
}

@test "comments contain any bytes, and precede <?xml ?>" {
    scene robot.urdf
    plain=$output
    printf '\n<!-- \xe9 ------>\n<?xml version="1.0"?>\n<!---->\n<robot name="r"><gazebo><![CDATA[<!--]]></gazebo>\n' > said.urdf
    sed '1,2d; $d' robot.urdf | sed 's/<joint/<!-- -- <link> & --><joint/' >> said.urdf
    cp said.urdf bad.urdf
    echo '</robot><!-- --- -->' >> said.urdf
    scene said.urdf
    ended 0
    is "$plain"
    echo '<joint/></robot>' >> bad.urdf
    refused "bad.urdf: line $(grep -c '' bad.urdf): <joint> has no name" bad.urdf
}

# Within 1 s and 256 MB.
@test "entities neither expand nor name files" {
    limited() {
        # shellcheck disable=SC2016
        run --separate-stderr timeout 5 bash -c 'ulimit -v 262144; exec "$0" scene robot.urdf' "$FMB"
        ended 2
        is ''
        said 'fmb: robot.urdf: line 1: <!DOCTYPE>: document types and entities are not supported: remove the declaration'
    }
    {
        echo '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaaaaaaaaaaaa">'
        for pair in ba cb dc ed fe gf hg ih ji; do
            printf '<!ENTITY %s "%s">\n' "${pair:0:1}" "$(printf "&${pair:1};%.0s" 1 2 3 4 5 6 7 8 9 10)"
        done
        echo ']><robot name="&j;"><link name="a">&j;</link></robot>'
    } > robot.urdf
    limited
    echo '<!DOCTYPE robot [<!ENTITY f SYSTEM "/etc/passwd">]><robot><link name="&f;"/></robot>' > robot.urdf
    limited
    echo '<!DOCTYPE robot SYSTEM "http://127.0.0.1/x.dtd"><robot><link name="a&f;"/></robot>' > robot.urdf
    limited
}

@test "COLLADA files cannot repeat nodes without limit, or take a gigabyte" {
    # limited TEXT: m.dae is refused, within 5 s and 512 MB.
    limited() {
        # shellcheck disable=SC2016
        run --separate-stderr timeout 5 bash -c 'ulimit -v 524288; exec "$0" scene robot.urdf' "$FMB"
        ended 2
        is ''
        said "fmb: robot.urdf: line 3: link 'a': m.dae: $1"
    }
    nodes='<node id="none"/>' last=none
    for n in n2 n3 n4 n5 n6 n7 n8 n9; do
        nodes+="<node id='$n'>$(printf "<instance_node url='#$last'/>%.0s" 1 2 3 4 5 6 7 8 9 10)</node>"
        last=$n
    done
    collada "$nodes<node><instance_node url='#n9'/></node>"
    limited 'line 12: more than 512 MB, with all instances'
    truncate -s 1G m.dae
    limited 'there is no memory for its 1073741824 bytes'
    truncate -s 257M m.dae
    limited 'line 1: more than 256 MB: give the mesh as binary STL'
}

# ---- The command -----------------------------------------------------------------------------

@test "wrong usage is refused" {
    wrong scene
    wrong scene a b
    wrong scene a --sides 3
    wrong scene a --sides 18
    wrong scene a --sides 516
    wrong scene a --margin -1
    wrong scene a --excess -1
    wrong scene a --limit-slack -0.1
    wrong scene a --limit-slack nan
    wrong scene a --srdf a.srdf --srdf b.srdf # not only the pairs of one of them
    for base in '' 1,2 1,2,3,4 1,2,3,4,5 1,2,3,4,5,6,7 1,2,3, 1,2,nan 1,2,x '1 2 3'; do wrong scene a --base "$base"; done
    wrong scene a --joints a=1 --joints b=1
    wrong scene a --joints-csv a.csv --joints-csv b.csv
}

@test "a planned path is checked" {
    cd "$DEMO" || return
    check() {
        "$FMB" scene robot.urdf --joints-csv path.csv --with world.json "$@" 2> /dev/null |
            "$FMB" query --local --csv --contacts --fail-if overlapping
    }
    run check
    ended 3
    [ "$(grep -c overlapping <<< "$output")" = 3 ]
    # Between the fingers, if the hand is not one hull.
    run check --objects
    ended 3
    grep overlapping <<< "$output" | sed 's/,overlapping.*//' > "$BATS_TEST_TMPDIR/found"
    run cat "$BATS_TEST_TMPDIR/found"
    is ',4,"swing (t = 1.5)",4,102,"forearm","post"
,4,"swing (t = 1.5)",5,102,"hand","post"'
}
