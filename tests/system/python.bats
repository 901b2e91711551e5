# fmb.py, by Debian's Python: in process and on the bus, with numpy and without.

load service

setup() {
    export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=clients/python LD_LIBRARY_PATH=$FMB_BUILD FMB
    python=/usr/bin/python3
    [ -x $python ] || skip "needs python3"
}

@test "answers, arrays and refusals, in process and on the bus, with numpy" {
    $python -c 'import numpy' 2> /dev/null || skip "needs python3-numpy"
    start_fmbd
    BUS=1 $python tests/python/test_fmb.py
    [ "$(status_of malformed)" = 0 ]
    stop_fmbd
}

# -S: without the folders that packages are in.
@test "answers, arrays and refusals, in process and on the bus, without numpy" {
    start_fmbd
    BUS=1 $python -S tests/python/test_fmb.py
    stop_fmbd
}

@test "a library of another interface, or none, is an ImportError that says what to do" {
    sed 's/^_ABI = .*/_ABI = 0/' clients/python/fmb.py > "$BATS_TEST_TMPDIR/fmb.py"
    PYTHONPATH=$BATS_TEST_TMPDIR run $python -c 'import fmb'
    [ "$status" = 1 ]
    [[ ${lines[-1]} == 'ImportError: fmb: '*'needs 0: install both'* ]]
    # The library for robots is loaded when it is first used.
    mkdir "$BATS_TEST_TMPDIR/libraries"
    cp "$FMB_BUILD"/libfmb.so* "$FMB_BUILD"/libfmb-client.so* "$BATS_TEST_TMPDIR/libraries"
    LD_LIBRARY_PATH=$BATS_TEST_TMPDIR/libraries run $python -c 'import fmb; fmb.Scene([fmb.box([1, 1])]); fmb.Robot("r.urdf")'
    [ "$status" = 1 ]
    [[ ${lines[-1]} == 'ImportError: fmb: libfmb-robot.so: '*LD_LIBRARY_PATH ]] || skip "the library is installed here"
    LD_LIBRARY_PATH='' run $python -S -c 'import fmb'
    [ "$status" = 1 ] || skip "the library is installed here"
    [[ ${lines[-1]} == 'ImportError: fmb: '*LD_LIBRARY_PATH ]]
}

@test "the constants of fmb.py are those of the C headers" {
    for number in 'FMB_FLAT_ABI _ABI' 'FMB_CLIENT_WHY_MAX _WHY_MAX' 'FMB_CLIENT_NO_MEMORY _NO_MEMORY' \
        'FMB_CLIENT_NO_SERVICE _NO_SERVICE' 'FMB_HULL_VERTICES_MAX _HULL_VERTICES_MAX' \
        'FMB_WANT_BOX _WANT_BOX' 'FMB_WANT_TIMES _WANT_TIMES' 'FMB_WANT_GAP _WANT_GAP' \
        'FMB_WANT_POINT _WANT_POINT'; do
        echo "_Static_assert(${number% *} == $($python -c "import fmb; print(fmb.${number#* })"), \"$number\");"
    done > "$BATS_TEST_TMPDIR/numbers"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/numbers")" = 9 ]
    $python - >> "$BATS_TEST_TMPDIR/numbers" << 'END'
import ctypes, fmb
for struct in (fmb._BodyBegin, fmb._Placement, fmb._Placed, fmb._World, fmb._Options, fmb._Touch, fmb._Edge, fmb._ClientOptions):
    name = "struct " + struct.__name__
    for field, _ in struct._fields_:
        print(f'_Static_assert(offsetof({name}, {field}) == {getattr(struct, field).offset}, "{name} {field}");')
    if struct is not fmb._BodyBegin:
        print(f'_Static_assert(sizeof({name}) == {ctypes.sizeof(struct)}, "{name}");')
END
    grep -q 'sizeof(struct fmb_robot_options)' "$BATS_TEST_TMPDIR/numbers"
    ${CC:-gcc} -fsyntax-only -Iclients/lib -Iservice/fmb -Imsgs/codec -x c -include clients/python/fmb_flat.h -include clients/robot/fmb_robot.h \
        -include clients/lib/fmb_client.h "$BATS_TEST_TMPDIR/numbers"
}

@test "the Python example in the README prints what it says" {
    sed -n '/^import fmb$/,/^```$/p' README.md | grep -v '^```' > "$BATS_TEST_TMPDIR/readme.py"
    start_fmbd
    expected=$(sed -n 's/.*print(.*# //p' "$BATS_TEST_TMPDIR/readme.py")
    [ "$expected" ]
    [ "$($python "$BATS_TEST_TMPDIR/readme.py")" = "$expected" ]
    stop_fmbd
}
