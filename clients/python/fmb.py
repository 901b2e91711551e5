"""Exact collision queries of rigid bodies: which overlap, touch or are separated, when, in which
box, and how far apart they are. Decided in process, or by the service fmbd on an LCM bus.

    import fmb

    table = fmb.box([2, 1, 0.25])
    cube = fmb.box([0.25, 0.25, 0.25])
    scene = fmb.Scene([table, cube], names=["table", "cube"])
    scene.place(positions=[[0, 0, 0.125], [0.5, 0, 0.375]])
    for answer in scene.decide(duration=0):
        print(answer.names, answer.verdict)    # ('table', 'cube') touching

Bodies are made by box(), cuboid(), tetrahedron(), face(), hull(), sphere(), capsule(), cylinder() and
compound(), and queried by the methods of Scene. Robot poses robots of URDF. "pydoc3 fmb.hull" or
"pydoc3 fmb.Scene" describes one of them.

fmb.h of libfmb defines shapes, verdicts, and the accuracy of numbers. Lengths may have any unit;
times are in seconds, velocities per second; orientations are quaternions (w, x, y, z), in 2D (w, z),
of any length except 0. Every window is [0, duration].

Arguments that are arrays may be nested sequences, numpy arrays, tables of pandas, or other buffers,
of numbers of at most 64 bits; float64 and int64 in C order are not copied. Arrays that are returned
are numpy arrays if numpy is installed, else memoryviews, or Rows, of the same shape and type.

Refused input raises an exception whose text begins with the name of the argument: TypeError,
ValueError, or Error, a ValueError with a status of fmb.h. If the bus fails, or no
service answers, BusError is raised. A pair that the service could not decide has a status other
than 0, and no verdict.

Threads may share a scene or a client, and take turns. A child process may use scenes, but not clients.
A scene that another thread was using during the fork raises Error in the child.
"""

from __future__ import annotations

import contextlib
import ctypes
import enum
import functools
import itertools
import math
import operator
import os
import struct
import threading
from array import array
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment]
if TYPE_CHECKING:
    Array = Union["numpy.ndarray", memoryview, Sequence[Any]]

__all__ = ["Answer", "Answers", "Body", "BusError", "Client", "Edge", "Error", "OVERLAPPING", "Path",
           "SEPARATED", "Robot", "Rows", "Scene", "TOUCHING", "Verdict", "box", "capsule", "compound", "cuboid",
           "cylinder", "face", "hull", "normalized", "sphere", "status_text", "tetrahedron", "version"]

# ---- The libraries: fmb_flat.h, fmb_robot.h, and structs of fmb.h ----

_ABI = 4
# The installed module names the libraries of its version.
_SONAME = "libfmb-client.so"
_ROBOT_SONAME = "libfmb-robot.so"
_WHY_MAX = 512
_INT, _UNSIGNED, _SIZE, _LONG, _REAL, _TEXT, _POINTER = (
    ctypes.c_int, ctypes.c_uint, ctypes.c_size_t, ctypes.c_int64, ctypes.c_double, ctypes.c_char_p, ctypes.c_void_p)


def _struct(name: str, *fields: tuple[str, Any]) -> Any:
    return type(name, (ctypes.Structure,), {"_fields_": fields})


_BodyBegin = _struct("fmb_body", ("reach", _REAL), ("box", _REAL * 6), ("dim", _INT))
_Placement = _struct(
    "fmb_placement", ("body", ctypes.POINTER(_BodyBegin)), ("position", _REAL * 3), ("velocity", _REAL * 3),
    ("orientation", _REAL * 4), ("orientation_count", _INT), ("end_position", _REAL * 3),
    ("end_orientation", _REAL * 4), ("end_count", _INT), ("group", _LONG), ("id", _LONG), ("name", _TEXT))
_Placed = _struct(
    "fmb_scene", ("placements", ctypes.POINTER(_Placement)), ("placement_count", _SIZE), ("duration", _REAL),
    ("instant", ctypes.c_bool), ("method", _POINTER), ("want", _UNSIGNED), ("margin", _REAL), ("which", _INT),
    ("split", _SIZE), ("pairs", _POINTER), ("pair_count", _SIZE), ("ignored", ctypes.POINTER(_UNSIGNED)),
    ("ignored_count", _SIZE), ("first_pair", ctypes.c_ulonglong), ("label", _TEXT))
_World = _struct("fmb_robot_world", ("scene", ctypes.POINTER(_Placed)), ("links", ctypes.POINTER(_TEXT)), ("name", _TEXT))
_Options = _struct("fmb_robot_options", ("srdf", _TEXT), ("package_path", _TEXT), ("base", _REAL * 6), ("sides", _INT),
                   ("excess", _REAL), ("objects", _INT), ("bus", _INT))

_Touch = _struct("fmb_robot_touch", ("a", _UNSIGNED), ("b", _UNSIGNED), ("verdict", _INT))
_Edge = _struct("fmb_robot_edge", ("verdict", _INT), ("at", _REAL * 2), ("clearance", _REAL), ("closest", _REAL),
                ("has_pair", ctypes.c_bool), ("a", _SIZE), ("b", _SIZE))

_ClientOptions = _struct("fmb_client_options", ("url", _TEXT), ("prefix", _TEXT), ("timeout", _REAL), ("tries", _INT),
                         ("within", _REAL))


def _load(soname: str, abi: str, *functions: Any) -> ctypes.CDLL:
    """Loads a library and declares functions: name, result and arguments. abi: of its interface number, or ""."""
    try:
        library = ctypes.CDLL(soname)
    except OSError as error:
        raise ImportError(f"fmb: {error}: install it, or add its folder to LD_LIBRARY_PATH") from None
    found = getattr(library, abi, int)() if abi else _ABI
    if found != _ABI:
        raise ImportError(f"fmb: {soname} has interface {found}, fmb.py needs {_ABI}: install both from one version")
    for name, result, *arguments in functions:
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


@functools.lru_cache(maxsize=None)
def _robots() -> ctypes.CDLL:
    """The library for robots. It is loaded when it is needed."""
    return _load(
        _ROBOT_SONAME, "",
        ("fmb_robot_read", _INT, _TEXT, _POINTER, _POINTER),
        ("fmb_robot_free", None, _POINTER),
        ("fmb_robot_why", _TEXT, _POINTER),
        ("fmb_robot_joints", _SIZE, _POINTER, _POINTER),
        ("fmb_robot_links", _SIZE, _POINTER, _POINTER),
        ("fmb_robot_limits", None, _POINTER, _POINTER, _POINTER),
        ("fmb_robot_home", None, _POINTER, _POINTER),
        ("fmb_robot_excess", _REAL, _POINTER),
        ("fmb_robot_json_read", _INT, _TEXT, _POINTER),
        ("fmb_robot_json_free", None, _POINTER),
        ("fmb_robot_json_why", _TEXT, _POINTER),
        ("fmb_robot_json_get", ctypes.POINTER(_World), _POINTER),
        ("fmb_robot_scene", _INT, _POINTER, _POINTER, _SIZE, _POINTER, _SIZE, _POINTER),
        ("fmb_robot_scene_free", None, _POINTER),
        ("fmb_robot_scene_why", _TEXT, _POINTER),
        ("fmb_robot_scene_get", ctypes.POINTER(_Placed), _POINTER),
        ("fmb_robot_moved", _SIZE, _POINTER),
        ("fmb_robot_place", _INT, _POINTER, _POINTER),
        ("fmb_robot_path_begin", _INT, _POINTER, _REAL, _POINTER),
        ("fmb_robot_path_free", None, _POINTER),
        ("fmb_robot_path_why", _TEXT, _POINTER),
        ("fmb_robot_path_pairs", _SIZE, _POINTER),
        ("fmb_robot_path_touches", _SIZE, _POINTER, _POINTER),
        ("fmb_robot_path_edge", _INT, _POINTER, _POINTER, _POINTER),
        ("fmb_robot_path_lever", _REAL, _POINTER),
        ("fmb_robot_path_step", _INT, _POINTER, _POINTER))


_lib = _load(
    _SONAME, "fmb_flat_abi",
    ("fmb_version", _TEXT),
    ("fmb_client_status_text", _TEXT, _INT),
    ("fmb_client_open", _POINTER, _POINTER, _TEXT, _SIZE),
    ("fmb_client_close", None, _POINTER),
    ("fmb_flat_body_make", _INT, _INT, _INT, _POINTER, _SIZE, _POINTER),
    ("fmb_flat_body_join", _INT, _POINTER, _SIZE, _POINTER),
    ("fmb_flat_body_free", None, _POINTER),
    ("fmb_flat_cylinder", _REAL, _REAL, _REAL, _INT, _POINTER),
    ("fmb_flat_scene_make", _INT, _SIZE, *5 * (_POINTER,), _SIZE, _POINTER),
    ("fmb_flat_scene_free", None, _POINTER),
    ("fmb_flat_placements", ctypes.POINTER(_Placement), _POINTER),
    ("fmb_flat_take", None, _POINTER, _POINTER, _SIZE),
    ("fmb_flat_why", _TEXT, _POINTER),
    ("fmb_flat_place", _INT, _POINTER, _SIZE, _SIZE, *5 * (_POINTER,)),
    ("fmb_flat_pair", _INT, _POINTER, _POINTER, _LONG, _LONG, _REAL, _INT),
    ("fmb_flat_decide", _INT, _POINTER, _POINTER, _REAL, _INT, _INT, _REAL, _LONG, _POINTER, _SIZE, _POINTER, _SIZE,
     _TEXT),
    ("fmb_flat_decide_all", _LONG, _POINTER, _REAL, _INT, _INT, _REAL),
    ("fmb_flat_count", _SIZE, _POINTER),
    ("fmb_flat_pack", None, _POINTER, _POINTER))
_WANT_BOX, _WANT_TIMES, _WANT_GAP, _WANT_POINT = 1, 4, 8, 16
_NO_SERVICE, _NO_MEMORY = -2, -4
_HULL_VERTICES_MAX = 1024


class Error(ValueError):
    """Input was refused. status: of enum fmb_status in fmb.h."""

    def __init__(self, message: str, status: int = 0) -> None:
        super().__init__(message)
        self.status = status


class BusError(ConnectionError):
    """The bus failed, or a pair got no answer. status: of enum fmb_client_status in fmb_client.h; 0 for
    a client that cannot be opened or is closed."""

    def __init__(self, message: str, status: int = 0) -> None:
        super().__init__(message)
        self.status = status


def version() -> str:
    """The version of the library, "major.minor.patch"."""
    return _lib.fmb_version().decode()


def status_text(status: int) -> str:
    """A human-readable text for a status."""
    return _lib.fmb_client_status_text(status).decode()


def _error(status: int, message: str) -> Exception:
    if status == _NO_MEMORY:
        return MemoryError(message)
    return (BusError if status < 0 else Error)(message, status)


_OF_SCENES = "Scene() takes poses, velocities, ends, names, groups and ids; place() and move() change poses"


class _Handle:
    """Owner of an object of the library."""

    _handle: Optional[int] = None
    _free: Any = None

    def __del__(self) -> None:
        if self._handle:
            self._free(self._handle)

    def __setattr__(self, name: str, value: Any) -> None:
        if self._handle and name[0] != "_":
            raise AttributeError(f"{name}: cannot be set: {_OF_SCENES}")
        super().__setattr__(name, value)

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError(f"fmb: a {type(self).__name__} cannot be copied")


class _Shared(_Handle):
    """An object that one thread at a time uses."""

    _kind: Any = Error  # of an exception
    _name = "scene"

    def __init__(self) -> None:
        self._locks = {os.getpid(): threading.Lock()}  # by process

    @property
    def _lock(self) -> threading.Lock:
        """The lock of this process. A lock that another thread held during a fork stays held in the child, and the
        state of the object is unknown there: raises an exception."""
        process = os.getpid()
        lock = self._locks.get(process)
        if lock is None:
            if any(other.locked() for owner, other in list(self._locks.items()) if owner != process):
                raise self._kind(f"{self._name}: another thread was using it during the fork: make one in this "
                                 "process, or fork while no thread uses it")
            lock = self._locks.setdefault(process, threading.Lock())  # of several threads, one adds its lock
        return lock


# ---- Arguments ----

# Expected elements of an array; formats that are used without a copy; all formats that are accepted.
_TYPES = {"d": ("numbers of at most 64 bits", "d", "bBhHiIlLqQefd"),
          "q": ("integers of at most 64 bits", "ql", "bBhHiIlLqQ")}


def _float(name: str, value: Any) -> float:
    try:
        return value if value.__class__ is float else ctypes.c_double(value).value  # float() also takes text
    except TypeError:
        raise TypeError(f"{name}: expected a number, found {value!r:.40}") from None
    except OverflowError:
        raise ValueError(f"{name}: out of range") from None


def _int(name: str, value: Any) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: expected an integer, found {value!r:.40}") from None
    if not -2**63 <= number < 2**63:
        raise ValueError(f"{name}: {number} is out of range")
    return number


def _text(name: str, value: Optional[str]) -> Optional[bytes]:
    if value is None:
        return None
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected a str, found {value!r:.40}")
    if "\0" in value:
        raise ValueError(f"{name}: contains a NUL")
    return value.encode("utf-8", "surrogatepass")  # surrogates are refused by the library


def _flat(name: str, value: Any, code: str, shape: tuple) -> tuple[memoryview, tuple]:
    """Returns an array as a buffer, and its shape. shape: as expected; a str stands for any length."""
    expected, same, copied = _TYPES[code]
    if value.__class__ is Rows:
        value = value.view
    if numpy is not None and hasattr(value, "__array__"):
        if isinstance(value, numpy.ma.MaskedArray):
            raise TypeError(f"{name}: masked arrays are refused: pass the result of filled()")
        value = numpy.asarray(value)
        if value.dtype.char in copied:
            value = numpy.asarray(value, code, "C")
    try:
        view = memoryview(value)
    except (TypeError, ValueError):
        view = None
    if view is not None and view.format.lstrip("<") not in copied:
        raise TypeError(f"{name}: expected {expected}, found {getattr(value, 'dtype', view.format)}")
    usable = view is not None and view.format in same and view.c_contiguous
    view, found = (view, view.shape) if usable else _from_sequence(name, value, code, shape)
    if len(found) != len(shape) or any(s != f for s, f in zip(shape, found) if s.__class__ is int):
        raise ValueError(f"{name}: expected shape {_shape_text(shape)}, found {_shape_text(found)}")
    return view, found


def _from_sequence(name: str, value: Any, code: str, shape: tuple) -> tuple[memoryview, tuple]:
    value = _rows(value)
    rows = _iterate(name, value, shape)
    out = array(code)
    try:
        if len(shape) == 1:
            out.extend(rows)
            return memoryview(out), (len(out),)
        width = shape[1] if shape[1].__class__ is int else len(value[0]) if len(value) else 0
        for i, row in enumerate(rows):
            if len(row) != width:
                raise ValueError(f"{name}[{i}]: expected {width} numbers, found {len(row)}")
            out.extend(row)
        found = len(value), width
        return memoryview(out).cast("B").cast(code, found) if out else memoryview(out), found
    except (TypeError, OverflowError, LookupError, NotImplementedError) as error:
        raise TypeError(f"{name}: expected {_TYPES[code][0]}, of shape {_shape_text(shape)}: "
                        f"{error}") from None


def _iterate(name: str, value: Any, shape: tuple = ()) -> Iterator[Any]:
    try:
        return iter(None if isinstance(value, (str, bytes, bytearray)) else _rows(value))
    except TypeError:
        expected = f"an array of shape {_shape_text(shape)}" if shape else "a sequence"
        raise TypeError(f"{name}: expected {expected}, found {value!r:.40}") from None


def _shape_text(shape: tuple) -> str:
    return (f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})" +
            " with dim 2 or 3" * ("dim" in shape))


def _pointer(buffer: Any) -> Any:
    """A pointer to a buffer, which it keeps alive; NULL for None."""
    if buffer is None:
        return None
    view = memoryview(buffer)
    if not view.nbytes:  # an empty array is not NULL
        return ctypes.byref(ctypes.c_int64())
    if view.readonly:
        return ctypes.byref((ctypes.c_char * view.nbytes).from_buffer_copy(view))
    return ctypes.byref(ctypes.c_char.from_buffer(view))


# ---- Bodies ----


def _free_nothing(_: int) -> None:
    """Of a handle that belongs to another object."""


class Body(_Handle):
    """A rigid body of one or more frames, in body coordinates. It may be placed any number of times, in
    any scene. Made by box(), cuboid(), tetrahedron(), face(), hull(), sphere(), capsule(),
    cylinder() and compound().

    dim: 2 or 3
    """

    _free = _lib.fmb_flat_body_free

    def __init__(self, dim: int, handle: int, keeps: Any = None, owned: bool = True) -> None:
        self.dim, self._keeps = dim, keeps  # keeps: what the body points to
        if not owned:
            self._free = _free_nothing
        self._handle = handle


def _make_body(name: str, dim: int, make: Any, *arguments: Any, keeps: Any = None) -> Body:
    handle = ctypes.c_void_p()
    status = make(*arguments, ctypes.byref(handle))
    if status:
        raise _error(status, f"{name}: {status_text(status)}")
    return Body(dim, handle.value, keeps)


# Values of placement_t.shapes.
_CUBOID, _TETRAHEDRON, _FACE, _BOX, _HULL, _TETRAHEDRON_VERTICES, _FACE_VERTICES = range(1, 8)
_RADIUS = 16


def _numbers(name: str, value: Any, shape: tuple) -> tuple[array, int]:
    """The numbers of an argument, and their dimension, which is the length of its last axis."""
    buffer, found = _flat(name, value, "d", shape)
    if not found[0]:
        raise ValueError(f"{name}: it is empty")
    if found[-1] not in (2, 3):
        raise ValueError(f"{name}: expected 2 or 3 axes, found {found[-1]}")
    numbers = array("d", memoryview(buffer).tobytes())
    if not all(map(math.isfinite, numbers)):
        raise Error(f"{name}: {status_text(7)}", 7)
    return numbers, found[-1]


def _from_0(name: str, value: Any) -> float:
    number = _float(name, value)
    if not math.isfinite(number) or number < 0:
        status = 17 if math.isfinite(number) else 7
        raise Error(f"{name}: {status_text(status)}", status)
    return number


def _body(code: int, name: str, numbers: array, dim: int, radius: Any) -> Body:
    if _from_0("radius", radius):
        code, numbers = code + _RADIUS, array("d", [radius]) + numbers
    return _make_body(name, dim, _lib.fmb_flat_body_make, dim, code, _pointer(numbers), len(numbers))


def _frame(code: int, name: str, value: Any, shape: tuple, origin_name: str, origin: Any,
           radius: Any) -> Body:
    numbers, dim = _numbers(name, value, shape)
    if origin is not None:
        numbers = _numbers(origin_name, origin, (dim,))[0] + numbers
    return _body(code, name, numbers, dim, radius)


def box(size: Array, centre: Optional[Array] = None, *, radius: float = 0) -> Body:
    """A box aligned with the axes of the body.

    size: (dim,), lengths of the edges, 0 or more
    centre: (dim,); None: 0
    radius: 0 or more: the body is the set of points within this distance of the shape. A box extends
        beyond its size by the radius on every side. Every other shape may have a radius too.
    """
    return _frame(_BOX, "size", size, ("dim",), "centre", centre, radius)


def sphere(radius: float, centre: Optional[Array] = None, *, dim: int = 3) -> Body:
    """A sphere, in 2D a disc.

    radius: 0 or more
    centre: (dim,); None: 0
    dim: 2 or 3; not used if there is a centre
    """
    return _frame(_HULL, "centre", [0] * _dim(dim) if centre is None else centre, ("dim",), "", None, radius)


def capsule(radius: float, length: float, *, dim: int = 3) -> Body:
    """The set of points within a radius of a segment, its core, along the last axis and centred at 0.

    radius: 0 or more
    length: of the core, 0 or more; the capsule is longer by twice the radius
    dim: 2 or 3
    """
    before, half = [0] * (_dim(dim) - 1), _from_0("length", length) / 2
    return hull([[*before, -half], [*before, half]], radius=radius)


def cylinder(radius: float, length: float, *, sides: int = 16) -> Body:
    """A hull of 2 * sides vertices that contains a cylinder about z, centred at 0. It extends beyond the
    cylinder by at most radius * (1 / cos(pi / sides) - 1).

    radius, length: 0 or more
    sides: a multiple of 4, from 4 to 512
    """
    if _int("sides", sides) not in range(4, _HULL_VERTICES_MAX // 2 + 1, 4):
        raise ValueError(f"sides: expected a multiple of 4 up to {_HULL_VERTICES_MAX // 2}, found {sides}")
    vertices = array("d", bytes(48 * sides))
    _lib.fmb_flat_cylinder(_from_0("radius", radius), _from_0("length", length), sides, _pointer(vertices))
    return _body(_HULL, "radius", vertices, 3, 0)


def _dim(dim: Any) -> int:
    if _int("dim", dim) not in (2, 3):
        raise ValueError(f"dim: expected 2 or 3, found {dim}")
    return dim


def cuboid(components: Array, origin: Optional[Array] = None, *, radius: float = 0) -> Body:
    """A cuboid, the set origin + sum x_i components[i] with all x_i in [0, 1].

    components: (dim, dim), [component][axis]
    origin: (dim,); None: 0
    radius: see box()
    """
    return _frame(_CUBOID, "components", components, ("n", "dim"), "origin", origin, radius)


def tetrahedron(components: Optional[Array] = None, origin: Optional[Array] = None, *,
                vertices: Optional[Array] = None, radius: float = 0) -> Body:
    """A tetrahedron, in 2D a triangle: the set origin + sum x_i components[i] with x_i >= 0 and
    sum x_i <= 1; or given by its vertices, which are exact.

    components: (dim, dim), [component][axis]
    origin: (dim,); None: 0
    vertices: (dim + 1, dim), in place of both
    radius: see box()
    """
    return _simplex(_TETRAHEDRON, _TETRAHEDRON_VERTICES, components, origin, vertices, radius)


def face(components: Optional[Array] = None, origin: Optional[Array] = None, *,
         vertices: Optional[Array] = None, radius: float = 0) -> Body:
    """A triangle in 3D, given by its origin and two components, or by its vertices.

    components: (2, 3), [component][axis]
    origin: (3,); None: 0
    vertices: (3, 3), in place of both
    radius: see box()
    """
    return _simplex(_FACE, _FACE_VERTICES, components, origin, vertices, radius)


def _simplex(code: int, code_vertices: int, components: Any, origin: Any, vertices: Any,
             radius: Any) -> Body:
    if (components is None) == (vertices is None):
        raise TypeError("components: expected either components or vertices")
    if vertices is None:
        return _frame(code, "components", components, ("n", "dim"), "origin", origin, radius)
    if origin is not None:
        raise TypeError("origin: not with vertices")
    return _frame(code_vertices, "vertices", vertices, ("n", "dim"), "", None, radius)


def hull(vertices: Array, *, radius: float = 0) -> Body:
    """The convex hull of 1 to 1,024 vertices, in any order; it may be flat.

    vertices: (n, dim)
    radius: see box()
    """
    numbers, dim = _numbers("vertices", vertices, ("n", "dim"))
    if len(numbers) > dim * _HULL_VERTICES_MAX:
        raise Error(f"vertices: {len(numbers) // dim}, at most {_HULL_VERTICES_MAX}", 3)
    return _body(_HULL, "vertices", numbers, dim, radius)


def compound(bodies: Iterable[Body]) -> Body:
    """One rigid body with the frames of others, which are not tested against each other."""
    parts = _bodies(bodies)
    return _make_body("bodies", parts[0].dim, _lib.fmb_flat_body_join, _handles(parts), len(parts), keeps=parts)


def _handles(bodies: Sequence[Body]) -> Any:
    return (ctypes.c_void_p * len(bodies))(*[body._handle for body in bodies])


def _bodies(bodies: Iterable[Body]) -> tuple[Body, ...]:
    out = tuple(_iterate("bodies", bodies))
    if not out:
        raise ValueError("bodies: expected at least one")
    for i, body in enumerate(out):
        if not isinstance(body, Body):
            raise TypeError(f"bodies[{i}]: expected a Body, found {body!r:.40}")
        if body.dim != out[0].dim:
            raise Error(f"bodies[{i}]: {status_text(8)}", 8)
    return out


# ---- Answers ----


def _comparison(compare: Any) -> Any:
    def compared(self: Verdict, other: Any) -> Any:
        other = _NUMBERS.get(other, other) if isinstance(other, str) else getattr(other, "_value_", other)
        return compare(self._value_, other)
    return compared


class Verdict(enum.Enum):
    """Equal to its name in JSON ("touching"), which has the same hash, and to its number in arrays."""

    SEPARATED = 1
    TOUCHING = 2
    OVERLAPPING = 3

    def __str__(self) -> str:
        return self._name_.lower()

    def __hash__(self) -> int:
        return hash(str(self))

    def __index__(self) -> int:
        return self._value_

    __eq__, __ne__, __lt__, __le__, __gt__, __ge__ = map(
        _comparison, (operator.eq, operator.ne, operator.lt, operator.le, operator.gt, operator.ge))
    __array_ufunc__ = None  # arrays leave comparisons to these


SEPARATED, TOUCHING, OVERLAPPING = Verdict
_VERDICTS = (None,) + tuple(Verdict)
_NUMBERS = {str(verdict): verdict.value for verdict in Verdict}

Vector = tuple[float, ...]


class Answer(NamedTuple):
    """The answer to one pair. A field is None if it was not wanted, or if the pair does not have it."""

    a: int  #: indices of the bodies in the scene
    b: int
    names: tuple[Optional[str], Optional[str]]
    status: int  #: 0; or why there is no verdict, see status_text()
    verdict: Optional[Verdict]
    contact: Optional[tuple[float, float]]  #: first and last time of contact, seconds
    box: Optional[tuple[Vector, Vector]]  #: lower and upper corner of the intersection, (dim,) each
    point: Optional[tuple[float, Vector]]  #: a time, and a point (dim,) of both bodies at that time
    gap: Optional[tuple[float, float]]  #: lower and upper bound of the signed distance
    direction: Optional[Vector]  #: of the gap, from a to b, (dim,)
    time: Optional[float]  #: of the witness points, seconds; None if the gap has none
    witness: Optional[tuple[Vector, Vector]]  #: the nearest or deepest points of a and b
    frames: Optional[tuple[int, int]]  #: indices of the frames of a and b that have this gap


_EDGE_VERDICTS = (None, "free", "near", "contact", "undecided")


class Edge(NamedTuple):
    """The result for one edge of a path. An edge is the motion from one row to the next."""

    #: "free": all pairs are at least `clearance` apart at all times; "near": no contact, but some pair is closer than
    #: the required clearance; "contact"; "undecided": neither a contact nor its absence could be proven
    verdict: str
    #: A part of the edge, as fractions from 0 to 1. Contact: contains the first contact. Undecided: the edge is free
    #: before this part. Near: the time of `closest`. Free: the whole edge
    at: tuple[float, float]
    clearance: float  #: proven lower bound of the least gap, if free or near; else 0. Infinite if there are no pairs
    closest: float  #: upper bound of the least gap, from the times examined; infinite if none was
    pair: Optional[tuple[int, int]]  #: indices in the scene: pair in contact or undecided, else the pair of `closest`
    names: Optional[tuple[Optional[str], Optional[str]]]  #: of this pair


class Path(tuple):
    """The answers for a path: a tuple of Edge. path[k] is the edge from row k to row k + 1.

    verdict: "contact" if an edge has one, else "near", else "undecided", else "free"
    clearance: proven for the whole path; 0 if there is a contact, or an edge is undecided
    joint_error: the path stays free of contact if every joint is off by less than this (radians or lengths)
    pairs: number of pairs of bodies that were tested on each edge
    touches: (a, b, verdict) for each pair that meets and does not move relative to each other. If
        such a pair overlaps, the verdict of the path is "contact"
    names: names of all bodies, by index
    """

    def __new__(cls, edges: Iterable[Edge], touches: Iterable[Any], scene: Scene, pairs: int, lever: float) -> Path:
        self = super().__new__(cls, edges)
        self.touches, self.pairs, self.names = tuple(touches), pairs, scene.names
        found = {edge.verdict for edge in self} | {"contact" for touch in self.touches if touch[2] is OVERLAPPING}
        self.verdict = next(verdict for verdict in ("contact", "near", "undecided", "free") if verdict in found)
        self.clearance = 0.0 if found & {"contact", "undecided"} else min(edge.clearance for edge in self)
        self.joint_error = self.clearance / lever if lever else math.inf
        return self


class Rows(Sequence):
    """An array of several axes, if numpy is not installed. Its rows are memoryviews or Rows."""

    def __init__(self, view: memoryview) -> None:
        self.view, self.shape = view, view.shape
        self.tolist, self.tobytes = view.tolist, view.tobytes

    def __len__(self) -> int:
        return len(self.view)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, (slice, tuple)):
            return _rows(self.view[index])
        k = range(len(self))[index]
        return _rows(memoryview(self.view[k:k + 1].tobytes()).cast(self.view.format, self.shape[1:]))


def _rows(value: Any) -> Any:
    return Rows(value) if isinstance(value, memoryview) and value.ndim > 1 else value


@functools.lru_cache(maxsize=None)
def _columns(dim: int, pairs: bool, wanted: int) -> tuple[dict[str, Any], int]:
    """The columns of fmb_flat_pack(), and the bytes of an answer. A column is its offset, in bytes per answer,
    its type and its shape; None if it is not wanted."""
    contact, corners, point, gap = (
        wanted & bit for bit in (_WANT_TIMES, _WANT_BOX, _WANT_POINT, _WANT_GAP))
    columns: dict[str, Any] = {}
    width = 0
    for name, found, code, shape in (
            ("pairs", pairs, "q", (2,)), ("contacts", contact, "d", (2,)), ("boxes", corners, "d", (2, dim)),
            ("points", point, "d", (1 + dim,)), ("gaps", gap, "d", (2,)), ("directions", gap, "d", (dim,)),
            ("times", gap, "d", ()), ("witnesses", gap, "d", (2, dim)), ("frames", gap, "q", (2,)),
            ("statuses", True, "i", ()), ("verdicts", True, "B", ())):
        columns[name] = (width, code, shape, struct.Struct(f"{math.prod(shape)}{code}")) if found else None
        width += math.prod(shape) * array(code).itemsize if found else 0
    return columns, width


class Answers(Sequence):
    """The answers to n pairs, in their order. A sequence of Answer, and an array for each field;
    None where it was not wanted.

    pairs: (n, 2) int64, [pair][a, b], indices of bodies; of a list of pairs, this list
    verdicts: (n,) uint8, of Verdict; 0: none, the status says why
    statuses: (n,) int32, 0; or why there is no verdict
    contacts: (n, 2), first and last time of contact, seconds; NaN for pairs that never meet
    boxes: (n, 2, dim), [pair][lower, upper][axis] of the intersection; NaN for pairs that never meet
    points: (n, 1 + dim), [pair][time, then coordinates] of a point of both; NaN for pairs that never meet
    gaps: (n, 2), lower and upper bound of the signed distance; NaN if there is none. The arrays below
        are then undefined
    directions: (n, dim), of the gap, from a to b
    times: (n,), of the witness points, seconds; NaN if there are none. Separated pairs have them, and
        pairs that overlap may
    witnesses: (n, 2, dim), [pair][of a, of b], the nearest or deepest points at that time; NaN if there are none
    frames: (n, 2) int64, indices of the frames of a and b that have this gap
    """

    def __init__(self, handle: int, count: int, dim: int, names: Any, pairs: Any, wanted: int) -> None:
        self._names, self._pairs, self._count = names, pairs, count
        self._columns, width = _columns(dim, pairs is None, wanted)
        self._data = (ctypes.c_char * ((count or 1) * width))()  # all columns; each becomes an array when it is used
        if count:
            _lib.fmb_flat_pack(handle, self._data)

    def __getattr__(self, name: str) -> Any:
        if name[0] == "_" or name not in self._columns:
            raise AttributeError(f"'Answers' object has no attribute '{name}'")
        n, column, view = self._count, self._columns[name], None
        if name == "pairs" and self._pairs is not None:
            view = self._pairs if numpy is None else numpy.asarray(self._pairs)
        elif column:
            offset, code, shape, row = column
            size = (n or 1) * row.size
            view = memoryview(self._data).cast("B")[n * offset:n * offset + size].cast(code, (n or 1,) + shape)[:n]
            view = view if numpy is None else numpy.asarray(view)
        view = self.__dict__[name] = _rows(view)
        return view

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(self._count))]
        n, k = self._count, range(self._count)[index]

        def known(name: str) -> Any:
            """A row; None if it was not wanted, or begins with NaN: it has no value."""
            column = self._columns[name]
            row = column and column[3].unpack_from(self._data, n * column[0] + k * column[3].size)
            return row if row and row[0] == row[0] else None

        def halves(row: Any) -> Any:
            return row and (row[:len(row) // 2], row[len(row) // 2:])

        a, b = known("pairs") or (self._pairs[k, 0], self._pairs[k, 1])
        gap, point, time = known("gaps"), known("points"), known("times")
        return Answer(a, b, (self._names[a], self._names[b]), known("statuses")[0], _VERDICTS[known("verdicts")[0]],
                      known("contacts"), halves(known("boxes")), point and (point[0], point[1:]), gap,
                      *(known("directions"), time and time[0], halves(known("witnesses")), known("frames"))
                      if gap else (None,) * 4)


# ---- The bus ----


class Client(_Shared):
    """A client of fmbd on an LCM bus. A client sends each body once: use it for all queries. A child
    process needs its own client. Signals (Ctrl-C) are handled when the current call returns.

    url: of the bus, udpm://[GROUP:PORT][?ttl=N]; None: LCM_DEFAULT_URL, or else only this host
    prefix: of the service's channels
    timeout: the longest time before a query is sent again, seconds
    tries: number of timeouts after which a query fails
    within: time limit for each scene, seconds; 0: none

    Raises BusError if the bus cannot be opened or an option is wrong.
    """

    _free = _lib.fmb_client_close
    _kind, _name = BusError, "client"

    def __init__(self, url: Optional[str] = None, prefix: Optional[str] = None, *,
                 timeout: float = 0.5, tries: int = 6, within: float = 0) -> None:
        super().__init__()
        self._process = os.getpid()
        why = ctypes.create_string_buffer(_WHY_MAX)
        tries = _int("tries", tries)
        if not 0 < tries < 2**31:
            raise ValueError(f"tries: {tries} is out of range")
        bus = url or os.environ.get("LCM_DEFAULT_URL")
        self._start = "fmbd" + (f' --lcm-url "{bus}"' if bus else "") + (
            f" --prefix {prefix}" if prefix else "")
        options = _ClientOptions(_text("url", url), _text("prefix", prefix), _float("timeout", timeout), tries,
                                 _float("within", within))
        self._handle = _lib.fmb_client_open(ctypes.byref(options), why, _WHY_MAX)
        if not self._handle:
            raise BusError(why.value.decode(errors="replace"))

    def close(self) -> None:
        """Closes the client. It must not be used afterwards. Raises BusError in a child process if another
        thread was using it during the fork."""
        with self._lock:
            self.__del__()
            self._handle = None

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


_NO_LOCK = contextlib.nullcontext()


def _lock_of(client: Optional[Client]) -> Any:
    if client is None:
        return _NO_LOCK
    if not isinstance(client, Client):
        raise TypeError(f"client: expected a Client, found {client!r:.40}")
    if client._process != os.getpid():  # both would take the answers to each other's queries
        raise BusError("client: it was opened by another process: open one after a fork")
    return client._lock


def _handle_of(client: Optional[Client]) -> Optional[int]:
    if client is not None and not client._handle:
        raise BusError("client: it is closed")
    return client and client._handle


def _advice(status: int, client: Optional[Client]) -> str:
    return f": start one with '{client._start} &'" if client and status == _NO_SERVICE else ""


# ---- Scenes ----


def normalized(orientations: Array) -> Any:
    """Returns orientations (n, 4), in 2D (n, 2), scaled to length 1, up to rounding.

    The length of a quaternion does not change its rotation, but between quaternions of different lengths a
    body turns unevenly. Raises ValueError if a quaternion is all 0 or not finite.
    """
    view, shape = _flat("orientations", orientations, "d", ("n", "4"))
    flat, out = view.cast("B").cast("d"), array("d")
    for k in range(0, len(flat), shape[1] if len(flat) else 1):
        row = flat[k:k + shape[1]]
        largest = max(map(abs, row))
        if not 0 < largest < math.inf:
            raise ValueError(f"orientations[{k // shape[1]}]: expected finite numbers that are not all 0")
        length = math.hypot(*(x / largest for x in row))
        out.extend(x / largest / length for x in row)
    if not out:
        return view if numpy is None else numpy.empty(shape)
    scaled = memoryview(out).cast("B").cast("d", shape)
    return Rows(scaled) if numpy is None else numpy.array(scaled)


class Scene(_Shared):
    """Placed bodies. place() and move() change their poses and motions between queries; all else is fixed.

    bodies: n bodies of one dimension; a body may be placed several times
    positions: (n, dim), world coordinates of the origins of the bodies at time 0; None: 0
    orientations: (n, 4), (w, x, y, z), in 2D (n, 2), (w, z); None: not rotated
    velocities: (n, dim), per second; None: at rest
    end_positions, end_orientations: the poses at the end of the window, in place of velocities: the bodies
        turn by less than half a turn. Give quaternions of equal lengths, as normalized() returns them:
        otherwise bodies turn unevenly. Without end_positions, bodies do not move; without
        end_orientations, they do not turn
    names: n texts of at most 64 bytes of UTF-8; any of them may be None
    groups: (n,) int64; bodies of one group other than 0 are not tested against each other
    ids: (n,) int64, 1 to 2^53 - 1, under which the service caches the bodies; 0: it does not;
        None: 1 to n
    ignored: (m, 2) int64, pairs of bodies that decide() does not test, unless it gets a list of pairs
    """

    _free = _lib.fmb_flat_scene_free

    def __init__(self, bodies: Iterable[Body], *, positions: Optional[Array] = None,
                 orientations: Optional[Array] = None, velocities: Optional[Array] = None,
                 end_positions: Optional[Array] = None, end_orientations: Optional[Array] = None,
                 names: Optional[Sequence[Optional[str]]] = None, groups: Optional[Array] = None,
                 ids: Optional[Array] = None, ignored: Optional[Array] = None) -> None:
        super().__init__()
        self.bodies = _bodies(bodies)
        self.dim = self.bodies[0].dim
        n = len(self.bodies)
        self.names = (None,) * n if names is None else tuple(_iterate("names", names))
        if len(self.names) != n:
            raise ValueError(f"names: expected {n}, found {len(self.names)}")
        texts = [_text(f"names[{i}]", name) for i, name in enumerate(self.names)]
        pairs = _flat("ignored", [] if ignored is None else ignored, "q", ("m", 2))[0]
        handle = ctypes.c_void_p()
        status = _lib.fmb_flat_scene_make(
            n, _handles(self.bodies),
            _pointer(_flat("ids", range(1, n + 1) if ids is None else ids, "q", (n,))[0]),
            _pointer(_flat("groups", [0] * n if groups is None else groups, "q", (n,))[0]),
            (ctypes.c_char_p * n)(*texts), _pointer(pairs), len(pairs), ctypes.byref(handle))
        self.ignored: Any = (_rows(pairs) if len(pairs) else []) if numpy is None else numpy.array(pairs).reshape(-1, 2)
        self.links: tuple[Optional[str], ...] = (None,) * n
        self.duration, self.margin = None, 0.0
        self._robot: Any = None
        self._handle = handle.value
        self._check(status)
        self.place(positions, orientations, velocities, end_positions, end_orientations)

    @staticmethod
    def from_json(path: Union[str, os.PathLike]) -> Scene:
        """Reads the only scene of a JSON file, with its ignored pairs. Its bodies may be carried by links of
        a robot: links has the name of the link for each body, or None. duration and margin are those of the
        file. decide() does not use them; Robot.scene() passes them on.

        Raises ValueError for a file that is refused.
        """
        made = _Made("fmb_robot_json", "_read", _path("path", path))
        world = made._lib.fmb_robot_json_get(made._handle).contents
        of = world.scene.contents
        if of.which:
            raise Error(f"{path}: \"pairs\" is not supported in a file: pass pairs to decide()")
        links = [link and link.decode() for link in world.links[:of.placement_count]] if world.links else ()
        return _scene_of(of, made, [], duration=of.duration, **{"links": tuple(links)} if links else {})

    def __len__(self) -> int:
        return len(self.bodies)

    def _check(self, status: int, name: str = "", client: Optional[Client] = None) -> None:
        if status:
            why = _lib.fmb_flat_why(self._handle).decode() if self._handle else status_text(status)
            raise _error(status, name + why + _advice(status, client) +
                         (": pass instant=True" if why.endswith(" moves") else ""))

    def place(self, positions: Optional[Array] = None, orientations: Optional[Array] = None,
              velocities: Optional[Array] = None, end_positions: Optional[Array] = None,
              end_orientations: Optional[Array] = None) -> None:
        """Sets positions (n, dim), orientations (n, 4), in 2D (n, 2), and velocities (n, dim) or the poses
        at the end of the window, of all bodies; None: unchanged. Setting velocities removes ends, and setting
        ends removes velocities."""
        n = len(self.bodies)
        self._place(0, n, (n,), positions=positions, orientations=orientations, velocities=velocities,
                    end_positions=end_positions, end_orientations=end_orientations)

    def move(self, index: int, position: Optional[Array] = None, orientation: Optional[Array] = None,
             velocity: Optional[Array] = None, end_position: Optional[Array] = None,
             end_orientation: Optional[Array] = None) -> None:
        """Sets position (dim,), orientation (4,), in 2D (2,), and velocity (dim,), or the pose at the end of
        the window, of one body; None: unchanged."""
        index = _int("index", index)
        if not 0 <= index < len(self.bodies):
            raise IndexError(f"index: there is no body {index}")
        self._place(index, 1, (), position=position, orientation=orientation, velocity=velocity,
                    end_position=end_position, end_orientation=end_orientation)

    def _place(self, first: int, count: int, rows: tuple, **poses: Any) -> None:
        turn = 2 if self.dim == 2 else 4
        widths = (self.dim, turn, self.dim, self.dim, turn)
        pointers = [None if value is None else _pointer(_flat(name, value, "d", rows + (width,))[0])
                    for (name, value), width in zip(poses.items(), widths)]
        ends = [name for name, pointer in zip(poses, pointers) if pointer is not None and name[:4] == "end_"]
        if pointers[2] is not None and ends:
            raise ValueError(f"{list(poses)[2]}: not with {ends[0]}")
        with self._lock:
            status = _lib.fmb_flat_place(self._handle, first, count, *pointers)
            if status and not rows:  # "positions[0]: ..." is about position
                argument, _, text = _lib.fmb_flat_why(self._handle).decode().partition("[0]")
                raise _error(status, next(n for n in poses if n[:7] == argument[:7]) + text)
            self._check(status)

    def pair(self, a: int, b: int, duration: float, *, box: bool = False, point: bool = False,
             gap: bool = False, client: Optional[Client] = None) -> Answer:
        """Decides one pair over the window [0, duration], in seconds. Groups are not considered. Raises
        Error or BusError if it has no answer.

        a, b: indices of bodies
        box, point, gap: also wanted, besides verdict and contact
        client: decides the pair; None: in process
        """
        a, b, duration = _int("a", a), _int("b", b), _float("duration", duration)
        want = (_WANT_BOX if box else 0) + (_WANT_POINT if point else 0) + (_WANT_GAP if gap else 0)
        with self._lock, _lock_of(client):
            self._check(_lib.fmb_flat_pair(self._handle, _handle_of(client), a, b, duration, want), "pair: ", client)
            return Answers(self._handle, 1, self.dim, self.names, {(0, 0): a, (0, 1): b}, want | _WANT_TIMES)[0]

    def decide(self, duration: float, *, pairs: Optional[Array] = None,
               split: Optional[int] = None, ignored: Optional[Array] = None, margin: float = 0,
               instant: bool = False, contacts: bool = False, boxes: bool = False,
               points: bool = False, gaps: bool = False, label: Optional[str] = None,
               client: Optional[Client] = None) -> Answers:
        """Decides pairs over the window [0, duration], in seconds.

        pairs: (m, 2) int64, indices of bodies: each of these pairs gets an answer. None: all pairs;
            those that touch, overlap, are near or have no verdict get an answer, and all others
            are separated
        split: only pairs of one of the first split bodies with one of the others
        ignored: (m, 2) int64, pairs that are not tested, besides those of the scene; not with pairs
        margin: separated pairs at most this far apart are near; they have gaps, as do pairs that meet
        instant: the window is [0, 0] even if bodies move; duration is 0
        contacts, boxes, points, gaps: also wanted, besides verdicts
        label: for monitoring the bus, at most 64 bytes of UTF-8 without control characters
        client: decides the pairs; None: in process
        """
        want = (_WANT_TIMES if contacts else 0) + (_WANT_BOX if boxes else 0) + (
            _WANT_POINT if points else 0) + (_WANT_GAP if gaps else 0)
        if pairs is None and split is None and ignored is None and label is None and client is None:
            with self._lock:  # the common case, with few calls; errors are raised below
                try:
                    count = _lib.fmb_flat_decide_all(self._handle, duration, bool(instant), want, margin)
                except ctypes.ArgumentError:
                    count = -1
                if count >= 0:
                    return Answers(self._handle, count, self.dim, self.names, None,
                                   want | (_WANT_GAP if margin else 0))
        if pairs is not None and (split is not None or ignored is not None):
            raise ValueError(f"{'ignored' if split is None else 'split'}: not with pairs")
        listed = None if pairs is None else _flat("pairs", pairs, "q", ("m", 2))[0]
        left_out = None if ignored is None else _flat("ignored", ignored, "q", ("m", 2))[0]
        first = -1 if split is None else _int("split", split)
        if split is not None and first < 0:
            raise ValueError(f"split: {first} is negative")
        duration, margin = _float("duration", duration), _float("margin", margin)
        with self._lock, _lock_of(client):
            status = _lib.fmb_flat_decide(
                self._handle, _handle_of(client), duration, bool(instant), want, margin, first,
                _pointer(listed), 0 if listed is None else len(listed),
                _pointer(left_out), 0 if left_out is None else len(left_out),
                _text("label", label))
            self._check(status)
            answers = Answers(self._handle, _lib.fmb_flat_count(self._handle), self.dim, self.names, listed,
                              want | (_WANT_GAP if margin else 0))
        worst = min(memoryview(answers.statuses), default=0) if client else 0
        if worst < 0:
            raise BusError(f"client: {status_text(worst)}{_advice(worst, client)}", worst)
        return answers


# ---- Robots ----


def _path(name: str, value: Any) -> Optional[bytes]:
    try:
        return None if value is None else os.fsencode(value)
    except TypeError:
        raise TypeError(f"{name}: expected a path, found {value!r:.40}") from None


class _Made(_Handle):
    """An object of libfmb-robot, made by the function kind + make with these arguments."""

    def __init__(self, kind: str, make: str, *arguments: Any, keeps: Any = None) -> None:
        self._lib = lib = _robots()
        self._free, self._why, self._keeps = getattr(lib, kind + "_free"), getattr(lib, kind + "_why"), keeps
        handle = ctypes.c_void_p()
        status = getattr(lib, kind + make)(*arguments, ctypes.byref(handle))
        self._handle = handle.value
        if status:
            raise Error(self.why())

    def why(self) -> str:
        return self._why(self._handle).decode(errors="replace")


def _scene_of(of: Any, owner: _Made, bodies: list[Body], **more: Any) -> Scene:
    """Makes a Scene from a struct fmb_scene. bodies: of the last placements; the owner has the others. more:
    attributes."""
    placed = of.placements[:of.placement_count]
    owned = [p.body.contents for p in placed[:len(placed) - len(bodies)]]
    scene = Scene([Body(body.dim, ctypes.addressof(body), owner, False) for body in owned] + bodies,
                  ids=[p.id for p in placed], groups=[p.group for p in placed],
                  names=[p.name and p.name.decode() for p in placed],
                  velocities=[p.velocity[:p.body.contents.dim] for p in placed],
                  ignored=[of.ignored[2 * i:2 * i + 2] for i in range(of.ignored_count)])
    scene.__dict__.update(margin=of.margin, **more)
    _lib.fmb_flat_take(scene._handle, of.placements, len(placed))
    return scene


class Robot(_Handle):
    """A robot of a URDF file, with a body for each link that has collision elements.

    path: of the file; "-" is standard input
    srdf: path of an SRDF file: the pairs that it disables are ignored, in place of neighbours and of
        pairs within a rigid body
    package_path: folders of packages, separated by colons
    ignore: pairs of names, of links or of bodies of the world, that are not tested
    base: the pose of the root: x, y, z, or x, y, z, roll, pitch, yaw
    sides: of the hulls of cylinders, a multiple of 4 up to 512
    excess: how far hulls may extend beyond meshes, so that they need fewer vertices
    objects: a hull for each object of an OBJ file

    joints: names of the joints that move and follow no other, in the order of q
    lower, upper, home: (len(joints),), of q: limits, infinite if there are none; and 0, or the middle of
        the limits if 0 is outside. Radians, or lengths of prismatic joints
    links: names of the links that have a body, in the order of a scene
    excess: the largest distance by which bodies may extend beyond the cylinders and meshes of the file

    Raises Error with all errors of the files, one a line; ImportError without libfmb-robot.
    """

    def __init__(self, path: Union[str, os.PathLike], srdf: Union[str, os.PathLike, None] = None,
                 package_path: Optional[str] = None, ignore: Iterable[Sequence[str]] = (),
                 base: Optional[Array] = None, *, sides: int = 16, excess: float = 0,
                 objects: bool = False) -> None:
        place, (found,) = _flat("base", [0] * 6 if base is None else base, "d", ("6",))
        if found not in (3, 6):
            raise ValueError(f"base: expected x, y, z, or x, y, z, roll, pitch, yaw, found {found} numbers")
        self._ignore = [tuple(_iterate(f"ignore[{i}]", pair)) for i, pair in enumerate(_iterate("ignore", ignore))]
        for i, pair in enumerate(self._ignore):
            if len(pair) != 2 or not all(isinstance(name, str) for name in pair):
                raise ValueError(f"ignore[{i}]: expected two names, found {pair!r:.40}")
        if path is None:
            raise TypeError("path: expected a path, found None")
        sides, excess = _int("sides", sides), _float("excess", excess)
        if not 0 < sides < 2**31:
            raise ValueError(f"sides: {sides} is out of range")
        options = _Options(_path("srdf", srdf), _path("package_path", package_path), (_REAL * 6)(*place.tolist()), sides,
                           excess, bool(objects))
        self._made = made = _Made("fmb_robot", "_read", _path("path", path), ctypes.byref(options))
        self._lib, self._free = made._lib, _free_nothing  # made frees the robot

        def names(function: Any) -> tuple[str, ...]:
            found = ctypes.POINTER(ctypes.c_char_p)()
            return tuple(found[i].decode() for i in range(function(made._handle, ctypes.byref(found))))

        self.joints, self.links = names(self._lib.fmb_robot_joints), names(self._lib.fmb_robot_links)
        values = [array("d", bytes(8 * len(self.joints))) for _ in range(3)]
        self._lib.fmb_robot_limits(made._handle, *map(_pointer, values[:2]))
        self._lib.fmb_robot_home(made._handle, _pointer(values[2]))
        self.lower, self.upper, self.home = (
            memoryview(value) if numpy is None else numpy.array(value) for value in values)
        self.excess = self._lib.fmb_robot_excess(made._handle)
        self._handle = made._handle

    def scene(self, world: Optional[Scene] = None) -> Scene:
        """Returns a scene of the robot in its home pose: first the bodies of the links, in the order of
        links; then the bodies of the world that links carry; then its other bodies. Its ignored pairs are
        those of the robot and of the world. Links have the ids from 1 on; bodies of the world with one of
        these get others. Without SRDF, the links of a rigid body have one group.

        world: a Scene in 3D, in its current poses; Scene.from_json() reads one with carried bodies
        """
        around, bodies = None, []
        if world is not None:
            if not isinstance(world, Scene):
                raise TypeError(f"world: expected a Scene, found {world!r:.40}")
            n, pairs = len(world), _flat("ignored", world.ignored, "q", ("m", 2))[0].tolist()
            of = _Placed(_lib.fmb_flat_placements(world._handle), n, margin=world.margin, ignored_count=len(pairs),
                         ignored=(_UNSIGNED * (2 * len(pairs)))(*itertools.chain(*pairs)))
            around = _World(ctypes.pointer(of), (_TEXT * n)(*[_text("links", link) for link in world.links]))
            bodies = [world.bodies[i] for i in sorted(range(n), key=lambda i: world.links[i] is None)]
        names = [_text("ignore", name) for pair in self._ignore for name in pair]
        with _NO_LOCK if world is None else world._lock:
            made = _Made("fmb_robot_scene", "", self._handle, around and ctypes.byref(around), int(around is not None),
                         (_TEXT * len(names))(*names), len(self._ignore), keeps=(self._made, world, around))
        of = self._lib.fmb_robot_scene_get(made._handle).contents
        return _scene_of(of, made, bodies, duration=world.duration if world else None,
                         _robot=(self, made, (_REAL * len(self.joints))(), of.placements,
                                 self._lib.fmb_robot_moved(made._handle)))

    def place(self, scene: Scene, q: Array) -> None:
        """Poses the links and the bodies that they carry. Other bodies of the scene keep their poses.

        scene: made by scene() of this robot
        q: (len(joints),), finite values of the joints; limits are not checked
        """
        robot, made, values, placements, moved = getattr(scene, "_robot", None) or 5 * (None,)
        if robot is not self:
            raise ValueError("scene: expected a scene of this robot: scene() makes one")
        numbers = q.tolist() if numpy is not None and q.__class__ is numpy.ndarray and q.ndim == 1 else q
        with scene._lock:
            try:
                values[:] = numbers
            except (TypeError, ValueError):
                values[:] = _flat("q", q, "d", (len(self.joints),))[0].tolist()
            if self._lib.fmb_robot_place(made._handle, values):
                raise Error("q: " + made.why())
            _lib.fmb_flat_take(scene._handle, placements, moved)

    def check_path(self, rows: Any, world: Optional[Scene] = None, clearance: Optional[float] = None) -> Path:
        """Proves that the robot meets nothing, at all times, between consecutive rows. Between two rows,
        the value of each joint changes linearly. clients/robot/PATHS.md says what is proven.

        rows: joint values: an array (n, len(joints)), or a table or dict with a column for each
            joint, by name. Limits are not checked. A single row is a path of one pose
        world: as for scene(); its bodies must be at rest
        clearance: the clearance to prove; None: the margin of the world. 0: none is required, and the
            clearance of each edge is determined to within a tenth
        """
        values = self._joint_values(rows)
        scene = self.scene(world)
        wanted = scene.margin if clearance is None else _float("clearance", clearance)
        made = _Made("fmb_robot_path", "_begin", scene._robot[1]._handle, wanted, keeps=scene)

        def begin(k: int) -> None:
            to = min(k + 1, len(values) - 1)
            if self._lib.fmb_robot_path_edge(made._handle, values[k], values[to]):
                raise Error(f"rows[{to}]: {made.why()}")

        def edge(k: int) -> Edge:
            found = _Edge()
            begin(k)
            while not self._lib.fmb_robot_path_step(made._handle, ctypes.byref(found)):
                pass  # each step is short, so that other threads and signals are not kept waiting
            pair = (found.a, found.b) if found.has_pair else None
            return Edge(_EDGE_VERDICTS[found.verdict], tuple(found.at), found.clearance, found.closest, pair,
                        pair and tuple(scene.names[i] for i in pair))

        edges = range(max(1, len(values) - 1))
        for k in edges:  # errors come before the work
            begin(k)
        touches = ctypes.POINTER(_Touch)()
        count = self._lib.fmb_robot_path_touches(made._handle, ctypes.byref(touches))
        return Path(map(edge, edges), ((t.a, t.b, _VERDICTS[t.verdict]) for t in touches[:count]), scene,
                    self._lib.fmb_robot_path_pairs(made._handle), self._lib.fmb_robot_path_lever(made._handle))

    def _joint_values(self, rows: Any) -> list[Any]:
        width = len(self.joints)
        if hasattr(rows, "keys"):
            missing = [name for name in self.joints if name not in rows.keys()]
            if missing:
                raise ValueError(f"rows: no column for {', '.join(missing)}")
            columns = [_flat(f"rows[{name!r}]", rows[name], "d", ("n",))[0].tolist() for name in self.joints]
            if len(set(map(len, columns))) > 1:
                raise ValueError("rows: the columns have different lengths")
            rows = list(zip(*columns))
        values = _flat("rows", rows, "d", ("n", width))[0].tolist()
        if not values:
            raise ValueError("rows: expected at least one")
        return [(_REAL * width)(*row) for row in values]
