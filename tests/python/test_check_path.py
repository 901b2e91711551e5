"""Tests of fmb-check-path. Proofs are searched with its own checks, by bisection: whatever directions
and intervals are tried, no proof may exist of more than the true clearance, which is known in closed
form for small robots, and bounded by sampled poses for random ones."""

import gzip
import importlib.machinery
import importlib.util
import itertools
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

PROGRAM = os.environ.get("CHECK_PATH", "clients/robot/fmb-check-path")
loader = importlib.machinery.SourceFileLoader("check_path", PROGRAM)
check_path = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_path", loader))
loader.exec_module(check_path)


# ---- A generator of proofs ----

def hexed(*numbers):
    return " ".join(float(x).hex() for x in numbers)


def joint(kind, parent, child, xyz=(0, 0, 0), axis=(0, 0, 1), **others):
    line = {"joint": f"j{child}", "type": kind, "parent": parent, "child": child, "xyz": hexed(*xyz)}
    if kind != "fixed":
        line["axis"] = hexed(*axis)
    return line | others


def ball(name, link, at=(0, 0, 0), radius=0.1, **others):
    return {"body": name, "link": link, "frames": [{"hull": [hexed(*at)], "radius": hexed(radius)}]} | others


def box(name, link, at, size, **others):
    """at: of its middle."""
    sides = [[size[i] if i == j else 0 for j in range(3)] for i in range(3)]
    corner = [x - y / 2 for x, y in zip(at, size)]
    return {"body": name, "link": link, "frames": [{"cuboid": [hexed(*v) for v in [corner] + sides]}]} | others


def question(links, joints, bodies, rows, ignored=(), **base):
    """The lines before the edges. Counts of pairs are those of the checker."""
    lines = [{"fmb-path": 1}, {"robot": "test", "links": [f"l{i}" for i in range(links)]} | base, *joints, *bodies,
             *({"row": hexed(*row)} for row in rows), {"ignored": [list(pair) for pair in ignored], "pairs": 0, "rigid": 0}]
    for _ in range(2):
        try:
            read(lines)
        except check_path.Wrong as error:
            lines[-1]["pairs"], lines[-1]["rigid"] = [int(word) for word in str(error).split() if word.isdigit()]
    return lines


def read(lines):
    path = os.path.join(tempfile.mkdtemp(dir=FOLDER), "question")
    write(path, lines)
    with open(path, "rb") as file:
        return check_path.Question(check_path.Lines(file))


def write(path, lines, packed=False):
    text = "".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines).encode()
    with open(path, "wb") as file:
        file.write(gzip.compress(text) if packed else text)


def directions(edge, a, b, low, high):
    """Kinds with directions to try, from the poses in the middle."""
    middle = low + high >> 1
    (r_a, x_a), (r_b, x_b) = edge.body(a, middle), edge.body(b, middle)
    centres = check_path.minus(check_path.plus(x_b, check_path.turn(r_b, b.centre)),
                               check_path.plus(x_a, check_path.turn(r_a, a.centre)))
    yield "S", []
    axes = [[sign * (i == j) for j in range(3)] for i in range(3) for sign in (1, -1)]
    def few_bits(v):
        length = check_path.norm(v) or 1
        return [(x << 16) // length for x in v]
    base = edge.link(edge.question.way(a.link, b.link)[1], middle)[0]
    for kind, r, own in (("A", r_a, axes), ("B", r_b, axes), ("W", base, [])):
        for n in own + [few_bits(check_path.turn_back(r, centres))]:
            if any(n):
                yield kind, n
    n = few_bits(check_path.turn_back(r_a, centres))
    if any(n):
        yield "L", n
    for e, f in itertools.product(axes[::2], axes):
        yield "E", e + f


def search(edge, a, b, clearance, deepest, kinds="SLABWE", to=check_path.END):
    """Intervals that prove the pair, or None."""
    bounds, found = edge.bounds(a, b), []
    stack = [(0, 0)]
    while stack:
        low, depth = stack.pop()
        high = low + (check_path.END >> depth)
        if low >= to:
            continue
        for kind, integers in directions(edge, a, b, low, high):
            if kind in kinds and high <= to and edge.holds(a, b, clearance, kind, integers, low, high, depth, *bounds):
                found.append([kind, depth, *integers])
                break
        else:
            if depth == deepest:
                return None
            stack += [(low + high >> 1, depth + 1), (low, depth + 1)]
    return found


def proof(lines, clearance, deepest=12, kinds="SLABWE", to=1):
    """The lines of a proof of all edges, or None."""
    asked, lines = read(lines), list(lines)
    for k, (begin, end) in enumerate(zip(asked.rows, asked.rows[1:]), 1):
        edge = check_path.Edge(asked, begin, end)
        lines.append({"edge": k, "to": hexed(to), "clearance": hexed(clearance if to else 0)})
        for a, b in asked.pairs if to else []:
            intervals = search(edge, asked.bodies[a], asked.bodies[b], check_path.fix_up(Fraction(clearance)), deepest,
                               kinds, int(to * check_path.END))
            if intervals is None:
                return None
            lines.append({"pair": [a, b], "proof": intervals})
    return lines + [{"end": len(lines)}]


# ---- Robots whose least clearance is known ----

def swing(distance=1.25):
    """A ball of radius 0.125 at 1 m from a turning joint swings past a wall in front."""
    return question(2, [joint("revolute", 0, 1, column=0)],
                    [ball("hand", 1, (1, 0, 0), 0.125), box("wall", -1, (distance + 0.5, 0, 0), (1, 4, 1))],
                    [(-1,), (0.75,)]), distance - 1.125


def slide():
    """A box on an oblique rail passes the edge of another one."""
    return question(2, [joint("prismatic", 0, 1, axis=(3, 4, 0), column=0)],
                    [box("cart", 1, (0, 0, 0), (0.5, 0.5, 0.5)),
                     box("post", -1, (0.6 + 0.25, 0.8 + 0.25, 0.3 + 0.25), (0.5, 0.5, 0.5))],
                    [(-1,), (2,)]), 0.3 - 0.25


def scissors():
    """Two links of one length, the second turning back twice as far: its end moves on a line."""
    return question(3, [joint("revolute", 0, 1, column=0),
                        joint("continuous", 1, 2, (1, 0, 0), mimic=[0, hexed(-2), hexed(0)])],
                    [ball("hand", 2, (1, 0, 0), 0.125), box("wall", -1, (1, 0.75, 0), (4, 0.5, 1))],
                    [(-1,), (0.5,), (1.25,)]), 0.375


def fingers():
    """Two fingers on prismatic joints, one following the other, close up to a part between them."""
    return question(4, [joint("revolute", 0, 1, column=0),
                        joint("prismatic", 1, 2, (0, 0.5, 0), (0, -2, 0), column=1),
                        joint("prismatic", 1, 3, (0, -0.5, 0), (0, -1, 0), mimic=[1, hexed(-1), hexed(0)])],
                    [box("left", 2, (1, 0, 0), (0.1, 0.25, 0.5)), box("right", 3, (1, 0, 0), (0.1, 0.25, 0.5)),
                     box("part", 1, (1, 0, 0), (0.1, 0.125, 0.1))],
                    [(0, 0), (1.5, 0.25)]), 0.25 - 0.125 - 0.0625


def crossing():
    """A bar turns above another one, tilted by its joint's frame and on a moved and turned base."""
    bar = {"frames": [{"hull": [hexed(-1, 0, 0), hexed(1, 0, 0)], "radius": hexed(0.0625)}]}
    place = dict(xyz=hexed(3, -2, 1), rpy=hexed(0.3, -0.7, 2.5))
    return question(2, [joint("revolute", 0, 1, (0, 0, 0.25), column=0)],
                    [{"body": "upper", "link": 1} | bar, {"body": "lower", "link": 0} | bar], [(-3,), (4,)], **place), 0.125


def fixed_between():
    """The ball of swing(), at the end of a turned fixed joint; the wall has a quaternion."""
    wall = box("wall", -1, (0, 0, 0.5), (4, 1, 1), xyz=hexed(1.25, 0, 0), quat=hexed(3, 0, 3, 0))
    return question(3, [joint("continuous", 0, 1, axis=(0, 0, 1e-200), column=0),
                        joint("fixed", 1, 2, (0.5, 0.5, 0), rpy=hexed(0, 0, -math.pi / 2))],
                    [ball("hand", 2, (0.5, 0.5, 0), 0.125), wall], [(1000 * math.pi - 1,), (1000 * math.pi + 1,)]), 0.125


KNOWN = [swing, slide, scissors, fingers, crossing, fixed_between]


def run(lines, *options, packed=False):
    path = os.path.join(tempfile.mkdtemp(dir=FOLDER), "proof")
    if isinstance(lines, bytes):
        with open(path, "wb") as file:
            file.write(lines)
    else:
        write(path, lines, packed)
    return subprocess.run([sys.executable, PROGRAM, *options, path], capture_output=True, text=True)


class Known(unittest.TestCase):
    def test_the_least_clearance_is_proven_and_no_more(self):
        for case in KNOWN:
            with self.subTest(case.__name__):
                lines, clearance = case()
                done = run(proof(lines, clearance * 0.999))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn("proven: on all", done.stdout)
                self.assertIsNone(proof(lines, clearance * 1.001))


FOLDER = None
if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as FOLDER:
        unittest.main()
