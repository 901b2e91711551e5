"""Tests of fmb-check-path. Proofs are searched with its own checks, by bisection: whatever directions
and intervals are tried, no proof may exist of more than the true clearance, which is known in closed
form for small robots, and bounded by sampled poses for random ones."""

import contextlib
import copy
import gzip
import importlib.machinery
import importlib.util
import io
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
    return {"body": name, "link": link, "frames": [{"box": [hexed(*at), hexed(*size)]}]} | others


def cuboid(name, link, at, size):
    """The same body as a box."""
    sides = [[size[i] if i == j else 0 for j in range(3)] for i in range(3)]
    corner = [x - y / 2 for x, y in zip(at, size)]
    return {"body": name, "link": link, "frames": [{"cuboid": [hexed(*v) for v in [corner] + sides]}]}


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
    for kind, r in (("A", r_a), ("B", r_b), ("W", base)):
        for n in axes + [few_bits(check_path.turn_back(r, centres))]:
            if any(n):
                yield kind, n
    for n in [centres] + [check_path.turn(r, [x << check_path.P for x in n]) for r in (r_a, r_b) for n in axes]:
        if any(n):
            yield "L", few_bits(check_path.turn_back(r_a, n))
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
                     cuboid("post", -1, (0.6 + 0.25, 0.8 + 0.25, 0.3 + 0.25), (0.5, 0.5, 0.5))],
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


class Done:
    pass


def run(lines, *options, packed=False):
    """As the program, in this process."""
    path = os.path.join(tempfile.mkdtemp(dir=FOLDER), "proof")
    if isinstance(lines, bytes):
        with open(path, "wb") as file:
            file.write(lines)
    else:
        write(path, lines, packed)
    done, out = Done(), io.TextIOWrapper(io.BytesIO(), "utf-8")
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()) as error:
        done.returncode = check_path.main([*options, path])
    out.seek(0)
    done.stdout, done.stderr = out.read(), error.getvalue()
    return done


class Known(unittest.TestCase):
    def test_the_least_clearance_is_proven_and_no_more(self):
        for case in KNOWN:
            with self.subTest(case.__name__):
                lines, clearance = case()
                done = run(proof(lines, clearance * 0.999))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn("proven: on all", done.stdout)
                self.assertIsNone(proof(lines, clearance * 1.001))

    def test_each_kind_of_interval_proves(self):
        # Beside S, which alone would need many; a bar above a bar is proven by a cross product.
        for kinds, case in (("L", swing), ("SA", fingers), ("SB", swing), ("SW", scissors), ("SE", crossing)):
            lines, clearance = case()
            done = proof(lines, clearance * 0.99, kinds=kinds)
            self.assertEqual(run(done).returncode, 0)
            self.assertTrue(any(item[0] == kinds[-1] for line in done for item in line.get("proof", [])))
            self.assertIsNone(proof(lines, clearance * 1.001, kinds=kinds))

    def test_what_is_proven_is_printed(self):
        lines, clearance = fingers()
        done = run(proof(lines, 0.03125), "-v", packed=True)
        self.assertEqual(done.stdout, """robot 'test': 3 joints that move, 3 bodies of links, 0 bodies of the world
path: 1 edges; pairs: 3 to be proven, 0 ignored, 0 at rest relative to each other
edge 1: clearance 0.03125
proven: on all 1 edges all 3 pairs are at least 0.03125 apart
""")
        lines, _ = swing()
        lines = lines[:-1] + [{"row": hexed(0)}, {"row": hexed(3)}, lines[-1]]
        whole = proof(lines, 0.1)
        self.assertEqual(run(whole).returncode, 0)
        # Nothing of edge 1, half of edge 2.
        parts = proof(lines, 0.1, to=0)[:-3] + proof(lines, 0.1, to=0.5)[-5:-3] + whole[-3:-1]
        parts.append({"end": len(parts)})
        done = run(parts)
        self.assertEqual(done.returncode, 3)
        self.assertIn("not proven: edge 1\nnot proven: edge 2 after 0.5 of it\n", done.stdout)
        self.assertEqual(run(proof(lines, 0.1, to=0)).returncode, 3)

    def test_a_path_without_pairs_may_claim_any_clearance(self):
        lines = question(2, [joint("revolute", 0, 1, column=0)], [ball("hand", 1, (1, 0, 0))], [(0,), (1,)])
        self.assertEqual(run(proof(lines, 2.0**100)).returncode, 0)

    def test_one_row_is_a_pose(self):
        lines, clearance = swing()
        lines = [line for line in lines if "row" not in line]
        lines.insert(-1, {"row": hexed(0)})
        self.assertEqual(run(proof(lines, clearance * (1 - 1e-12))).returncode, 0)
        self.assertIsNone(proof(lines, clearance * (1 + 1e-12)))


# ---- Faults ----

class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Two fingers and a hand between a part, a wall and a post; the first pair is ignored."""
        cls.asked = question(
            5, [joint("revolute", 0, 1, column=0), joint("prismatic", 1, 2, (0, 0.5, 0), (0, -2, 0), column=1),
                joint("prismatic", 1, 3, (0, -0.5, 0), (0, -1, 0), mimic=[1, hexed(-1), hexed(0)]),
                joint("fixed", 3, 4, (0, 0, 1))],
            [box("palm", 1, (0.25, 0, 0), (0.25, 1, 0.25)), box("left", 2, (1, 0, 0), (0.5, 0.25, 0.5)),
             box("right", 3, (1, 0, 0), (0.5, 0.25, 0.5)), ball("tip", 4, (1, 0, 0), 0.25),
             box("wall", -1, (2.25, 0, 0), (1, 4, 1)), ball("post", -1, (0, 0, 2), 0.5)],
            [(-1, 0), (0.25, 0.25), (1, 0.25)], ignored=[(0, 1), (0, 2)])
        cls.clearance = 0.0625
        cls.proof = proof(cls.asked, cls.clearance)
        assert run(cls.proof).returncode == 0

    def change(self, line, *keys, to):
        """The lines with a change at keys of the line."""
        lines = copy.deepcopy(self.proof)
        at = lines[line]
        for key in keys[:-1]:
            at = at[key]
        if to is None:
            del at[keys[-1]]
        else:
            at[keys[-1]] = to
        return lines

    def refused(self, lines, code, text="", **options):
        done = run(lines, **options)
        self.assertEqual(done.returncode, code, (done.stdout, done.stderr))
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertNotIn("proven: on", done.stdout)
        self.assertIn(text, done.stderr)

    def each(self, kind):
        return [k for k, line in enumerate(self.proof) if kind in line]

    def test_every_interval_counts(self):
        for k in self.each("pair"):
            intervals = self.proof[k]["proof"]
            for i, (kind, depth, *n) in enumerate(intervals):
                self.refused(self.change(k, "proof", i, to=None), 1)
                self.refused(self.change(k, "proof", i, 1, to=depth + 1), 1)
                if n:
                    opposite = [kind, depth] + [-x for x in n[:3]] + n[3:]
                    self.refused(self.change(k, "proof", i, to=opposite), 1, "interval %d, of kind %s" % (i + 1, kind))
            self.refused(self.change(k, "proof", to=intervals + intervals[-1:]), 1)
            self.refused(self.change(k, "proof", to=[]), 1)

    def test_every_line_counts(self):
        for k in range(len(self.proof) - 1):
            lines = self.proof[:k] + self.proof[k + 1:-1]
            code = 1 if k > self.each("ignored")[0] or k in self.each("body") + self.each("row") else 2
            self.refused(lines + [{"end": len(lines)}], code)
        lines = self.proof[:]
        k = self.each("pair")[0]
        lines[k], lines[k + 1] = lines[k + 1], lines[k]
        self.refused(lines, 1)

    def test_a_clearance_or_a_question_that_is_not_that_of_the_proof(self):
        for k in self.each("edge"):
            self.refused(self.change(k, "clearance", to=hexed(self.clearance * 4 / 3)), 1)
            self.refused(self.change(k, "clearance", to=hexed(0)), 2)
            self.refused(self.change(k, "clearance", to=hexed(-1)), 2)
            self.refused(self.change(k, "edge", to=9), 1)
            self.refused(self.change(k, "to", to=hexed(0.5)), 1)
            self.refused(self.change(k, "to", to=hexed(2)), 2)
            self.refused(self.change(k, "to", to=hexed(0.1)), 1)
            self.refused(self.change(k, "to", to=hexed(2**-100)), 2)
        row, body, tree = self.each("row")[1], self.each("body"), self.each("joint")
        self.refused(self.change(row, "row", to=hexed(0.25, 0.5)), 1)
        self.refused(self.change(body[4], "xyz", to=hexed(-0.5, 0, 0)), 1)
        self.refused(self.change(body[4], "rpy", to=hexed(0, 0, 0.8)), 1)
        self.refused(self.change(body[3], "frames", 0, "radius", to=hexed(1)), 1)
        self.refused(self.change(tree[2], "mimic", 1, to=hexed(-2)), 1)
        self.refused(self.change(tree[1], "axis", to=hexed(1, 0, 0)), 1)
        self.refused(self.change(tree[3], "xyz", to=hexed(0, 0, 1.5)), 1)
        self.refused(self.change(1, "xyz", to=hexed(0.5, 0, 0)), 1)

    def test_ignored_pairs_are_those_of_the_tree_and_counted(self):
        k = self.each("ignored")[0]
        for ignored in ([[0, 1], [0, 2], [0, 4]], [[0, 1]], [[0, 2], [0, 1]], [[0, 1], [0, 1], [0, 2]],
                        [[0, 1], [0, 2], [2, 3]], [[0, 1], [0, 2], [4, 5]], [[0, 1], [0, 2], [0, 9]], [[0, 1], [2, 0]]):
            self.refused(self.change(k, "ignored", to=ignored), 1)
        for key in "pairs", "rigid":
            for count in (0, 3, 99):
                self.refused(self.change(k, key, to=count), 1)
        # With the counts that belong to it.
        lines = self.change(k, "ignored", to=[[0, 1], [0, 2], [0, 4]])
        lines[k]["pairs"] -= 1
        self.refused(lines, 1, "pair is missing")
        lines = [line for line in lines if line.get("pair") != [0, 4]]
        lines[-1]["end"] = len(lines) - 1
        done = run(lines, "--verbose")  # another question, as it says
        self.assertEqual(done.returncode, 0)
        self.assertIn(' 3 ignored', done.stdout)
        self.assertIn('ignored: "palm" and "wall"', done.stdout)

    def test_other_forms_are_unreadable(self):
        tree, body, row = self.each("joint"), self.each("body"), self.each("row")[0]
        edge, pair, ignored = self.each("edge")[0], self.each("pair")[0], self.each("ignored")[0]
        for place, wrong in [
                ((0, "fmb-path"), [2, "1", None]), ((0, "more"), [1]), ((1, "robot"), [None]), ((1, "links"), [None, 5, [], ["l0"]]),
                ((1, "xyz"), ["", "0x0p+0", "0 0 0", hexed(1, 2), hexed(1, 2, 3, 4), hexed(1e300, 0, 0), 3, [1, 2, 3]]),
                ((1, "quat"), [hexed(0, 0, 0, 0), hexed(1, 0, 0)]),
                ((tree[0], "type"), ["planar", None, 3]), ((tree[0], "parent"), [1, 5, -1, "0", True]), ((tree[0], "child"), [0, 2, 5]),
                ((tree[0], "axis"), [hexed(0, 0, 0), None, "nan nan nan", "inf 0x0p+0 0x0p+0"]),
                ((tree[0], "column"), [None, 1, 2, -1, "0"]), ((tree[0], "mimic"), [[1, hexed(1), hexed(0)]]),
                ((tree[2], "mimic"), [None, [], [2, hexed(1), hexed(0)], [3, hexed(1), hexed(0)], [-3, hexed(1), hexed(0)],
                                      [9, hexed(1), hexed(0)], [1, hexed(1e9), hexed(0)], [1, 1, 0], [1, hexed(1)]]),
                ((tree[3], "axis"), [hexed(1, 0, 0)]), ((tree[3], "quat"), [hexed(0, 0, 0, 0)]),
                ((body[0], "link"), [None, 5, -2, -1, 1 << 64]), ((body[5], "link"), [0]),
                ((body[0], "frames"), [None, [], [{}], 7, [{"hull": []}], [{"cone": [hexed(0, 0, 0)]}], [{"hull": [hexed(0, 0)]}],
                                       [{"hull": [hexed(0, 0, 0)], "radius": hexed(-1)}], [{"hull": ["nan nan nan"]}],
                                       [{"cuboid": [hexed(0, 0, 0)] * 5}], [{"box": [hexed(0, 0, 0)]}], [{"box": [hexed(0, 0, 0)] * 3}],
                                       [{"hull": [hexed(1, 0, 0)], "simplex": [hexed(0, 0, 0)]}]]),
                ((row, "row"), [None, hexed(0), hexed(0, 0, 0), hexed(0, 1 << 21), "0x1p+9999 0x0p+0", "0x1p+1024 0x0p+0", "nan inf"]),
                ((ignored, "ignored"), [None, 5, [5], [[[0], 1]]]), ((edge, "to"), [None, 1, hexed(-1), "nan"]),
                ((pair, "proof"), [None, 7, [7], [[]], [["S"]], [["X", 0]], [["S", -1]], [["S", 61]], [["S", 1 << 70]], [["S", "0"]],
                                   [["S", 0, 1]], [["A", 0, 1, 2]], [["A", 0, 0, 0, 0]], [["A", 0, 1, 2, 1 << 60]],
                                   [["A", 0, 1, 2, "3"]], [["E", 0, 1, 2, 3, 0, 0, 0]], [["E", 0, 1, 2, 3]], [[["S"], 0]]])]:
            for value in wrong:
                with self.subTest(place=place, value=value):
                    self.refused(self.change(*place, to=value) if value is not None or place[1] != "more" else [], 2)

    def test_damaged_files_are_unreadable(self):
        text = "".join(json.dumps(line) + "\n" for line in self.proof).encode()
        packed = gzip.compress(text)
        for size in [0, 1, 2, 3, 10, 11, len(packed) // 3, len(packed) // 2, len(packed) - 9, len(packed) - 5, len(packed) - 1]:
            self.refused(packed[:size], 2)
        for size in [1, 5, 20, len(text) // 2, len(text) - 1, text.rindex(b"{"), text.rindex(b'{"pair')]:
            self.refused(text[:size], 2)
        for place in range(20, len(packed), len(packed) // 20):
            self.refused(packed[:place] + bytes([packed[place] ^ 4]) + packed[place + 1:], 2)
        for wrong in (text + b"{}\n", text + text, text + b"\n", b"[" * 100000 + b"\n", b"\xff\xfe\n", b"null\n", b"[]\n", b"7\n", b"\n",
                      b'{"fmb-path":1e0}\n', b'{"fmb-path":NaN}\n', b'{"fmb-path":1,"fmb-path":1}\n', b'{"fmb-path":' + b"1" * 9999 + b"}\n",
                      b"x" * (1 << 24) + b"\n", packed + packed, packed + b"more"):
            self.refused(wrong, 2)
        self.assertEqual(run(text).returncode, 0)

    def test_random_damage_of_the_text_ends_in_a_verdict(self):
        text = "".join(json.dumps(line) + "\n" for line in self.proof).encode()
        for _ in range(40):
            place = DRAW.randrange(len(text))
            done = run(text[:place] + DRAW.choice(b'0123456789-"[]{},:xp. \n').to_bytes(1, "big") + text[place + 1:])
            self.assertIn(done.returncode, (0, 1, 2, 3))
            self.assertNotIn("Traceback", done.stderr)

    def test_wrong_usage(self):
        for words in ([], ["--quiet", "x"], ["a", "b"]):
            done = subprocess.run([sys.executable, PROGRAM, *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (2, "usage: fmb-check-path [--verbose] FILE\n"))
        for name in ("/nonexistent", "."):
            done = subprocess.run([sys.executable, PROGRAM, name], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        text = "".join(json.dumps(line) + "\n" for line in self.proof).encode()
        self.assertEqual(subprocess.run([sys.executable, PROGRAM, "-"], input=gzip.compress(text), capture_output=True).returncode, 0)


# ---- Random trees, beside kinematics in doubles ----

def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turned(r, v):
    return [sum(r[i][k] * v[k] for k in range(3)) for i in range(3)]


def about(axis, angle):
    length = math.sqrt(sum(x * x for x in axis))
    x, y, z = (v / length for v in axis)
    s, c = math.sin(angle), math.cos(angle)
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]


def numbers(text):
    return [float.fromhex(word) for word in text.split()]


def rpy(line):
    roll, pitch, yaw = numbers(line["rpy"])
    return times(about((0, 0, 1), yaw), times(about((0, 1, 0), pitch), about((1, 0, 0), roll)))


def poses(lines, row):
    """Rotation and position of each link, and of the world as the last one."""
    tree = [line for line in lines if "joint" in line]
    at = {0: (rpy(lines[1]), numbers(lines[1]["xyz"])), -1: ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0])}
    for line in tree:  # each after its parent
        r, x = at[line["parent"]]
        x = [u + v for u, v in zip(x, turned(r, numbers(line["xyz"])))]
        r = times(r, rpy(line))
        if line["type"] != "fixed":
            axis = numbers(line["axis"])
            if "mimic" in line:
                target, factor, offset = line["mimic"]
                value = row[tree[target]["column"]] * numbers(factor)[0] + numbers(offset)[0]
            else:
                value = row[line["column"]]
            if line["type"] == "prismatic":
                length = math.sqrt(sum(v * v for v in axis))
                x = [u + v for u, v in zip(x, turned(r, [v * value / length for v in axis]))]
            else:
                r = times(r, about(axis, value))
        at[line["child"]] = r, x
    return at


def random_tree(branching=0.4):
    links, column, tree, bodies = DRAW.randint(2, 7), 0, [], []
    vector = lambda size=1.0: [DRAW.uniform(-size, size) for _ in range(3)]
    for child in range(1, links):
        kind = DRAW.choice(["revolute", "revolute", "continuous", "prismatic", "fixed"])
        parent = DRAW.randrange(child) if DRAW.random() < branching else child - 1
        others = {"rpy": hexed(*vector(3))}
        movers = [k for k, line in enumerate(tree) if "column" in line]
        if kind != "fixed" and movers and DRAW.random() < 0.25:
            others["mimic"] = [DRAW.choice(movers), hexed(DRAW.uniform(-2, 2)), hexed(DRAW.uniform(-1, 1))]
        elif kind != "fixed":
            others["column"] = column
            column += 1
        tree.append(joint(kind, parent, child, vector(0.5), vector(), **others))
    for link in range(links):
        bodies.append(ball(f"b{link}", link, vector(0.25), DRAW.uniform(0.01, 0.06)))
    bodies.append(ball("far", -1, vector(2), DRAW.uniform(0.01, 0.06)))
    begin = vector(1) + vector(1) + vector(1)
    step = DRAW.choice([0.1, 0.5, 1.5])
    rows = [begin[:column], [x + DRAW.choice([0, step, -step, DRAW.uniform(-step, step)]) for x in begin[:column]]]
    place = {"xyz": hexed(*vector()), "rpy": hexed(*vector(3))}
    return question(links, tree, bodies, rows, **place) if column else random_tree()


def between(rows, s):
    return [x + s * (y - x) for x, y in zip(*rows)]


class Random(unittest.TestCase):
    def test_sines_and_cosines(self):
        one = check_path.ONE
        for _ in range(300):
            x, y = (DRAW.uniform(-1, 1) * 2 ** DRAW.randint(-40, 19) for _ in range(2))
            s, c = check_path.sin_cos(check_path.fix(Fraction(x)))
            self.assertLess(abs(s / one - math.sin(x)) + abs(c / one - math.cos(x)), 1e-15)
            self.assertLess(abs(s * s + c * c - one * one), one << 4)
            # To all digits, by the sum of angles.
            t, d = check_path.sin_cos(check_path.fix(Fraction(y)))
            u, e = check_path.sin_cos(check_path.fix(Fraction(x) + Fraction(y)))
            self.assertLess(abs(u * one - s * d - c * t) + abs(e * one - c * d + s * t), one << 5)

    def test_poses(self):
        for _ in range(100):
            lines = random_tree()
            rows = [numbers(line["row"]) for line in lines if "row" in line]
            asked = read(lines)
            edge = check_path.Edge(asked, *asked.rows)
            for s in (0, 1, DRAW.random()):
                at = poses(lines, between(rows, s))
                for link, (r, x) in at.items():
                    own_r, own_x = edge.link(link, int(s * check_path.END))
                    for u, v in zip(sum(r, []) + x, [*itertools.chain(*own_r), *own_x]):
                        self.assertAlmostEqual(u, v / check_path.ONE, delta=1e-12)

    def test_speed_and_curvature_are_within_the_bounds(self):
        """By differences, of points and of directions fixed in either body or in the last common link. Where
        one joint turns about an axis at right angles, the bounds are attained."""
        most = dict.fromkeys("SABWE", 0)
        h, one = 2.0**-11, check_path.ONE
        for _ in range(SAMPLES):
            lines = random_tree()
            rows = [numbers(line["row"]) for line in lines if "row" in line]
            asked = read(lines)
            edge = check_path.Edge(asked, *asked.rows)
            for a, b in DRAW.sample(asked.pairs, min(3, len(asked.pairs))):
                a, b = asked.bodies[a], asked.bodies[b]
                speed, bends, spin, base = edge.bounds(a, b)
                s = DRAW.uniform(h, 1 - h)
                e, f = ([DRAW.gauss(0, 1) for _ in range(3)] for _ in range(2))
                e, f = ([x / math.sqrt(sum(y * y for y in v)) for x in v] for v in (e, f))
                values = []
                for t in (s - h, s, s + h):
                    at = poses(lines, between(rows, t))
                    def point(body):
                        r, x = at[body.link]
                        centre = [v / one for v in body.centre]
                        return [u + v for u, v in zip(x, turned(r, centre))]
                    d = [y - x for x, y in zip(point(a), point(b))]
                    u, v = turned(at[a.link][0], e), turned(at[b.link][0], f)
                    n = {"A": u, "B": v, "W": turned(at[base][0], e), "E": [u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)]}
                    values.append({"S": math.sqrt(sum(x * x for x in d))} | {k: sum(map(lambda x, y: x * y, n[k], d)) for k in n})
                low, middle, high = values
                found = {"S": abs(high["S"] - low["S"]) / (2 * h)}
                found |= {k: abs(high[k] + low[k] - 2 * middle[k]) / h**2 for k in "ABWE"}
                known = {"S": speed / one, "E": bends["E"] / one + (spin / one)**2 * max(x["S"] for x in values)}
                for k in found:
                    bound = known.get(k, bends.get(k, 0) / one)
                    self.assertLessEqual(found[k], bound * (1 + 1e-4) + 1e-7, (k, lines))
                    most[k] = max(most[k], found[k] / bound if bound > 1e-3 else 0)
        self.assertGreater(min(most.values()), 0.5, most)

    def test_no_interval_that_holds_is_contradicted_by_a_pose(self):
        """The largest clearance with which an interval holds, beside poses within it. The last trees are
        an arm that grows while it turns, and a body that spins about itself, far from the other one."""
        one, held, kinds = check_path.ONE, dict.fromkeys("SLABWE", 0), check_path.INTEGERS
        place = dict(xyz=hexed(0, 0, 0), rpy=hexed(0, 0, 0))
        level = {"rpy": hexed(0, 0, 0)}
        grows = question(3, [joint("revolute", 0, 1, column=0, **level), joint("prismatic", 1, 2, axis=(1, 0, 0), column=1, **level)],
                         [ball("tip", 2, (0.01, 0, 0)), ball("post", -1, (0, 8, 3))], [(-1, 0), (1, 3)], **place)
        spins = question(2, [joint("revolute", 0, 1, axis=(1, 2, 3), column=0, **level)],
                         [ball("spinner", 1, (0.01, 0, 0)), ball("post", -1, (0, 9, 0))], [(-1,), (1,)], **place)
        for lines in [random_tree() for _ in range(SAMPLES // 5)] + [grows, spins] * 10:
            rows = [numbers(line["row"]) for line in lines if "row" in line]
            asked = read(lines)
            edge = check_path.Edge(asked, *asked.rows)
            for pair, kind in itertools.product(DRAW.sample(asked.pairs, min(2, len(asked.pairs))), kinds):
                a, b = (asked.bodies[k] for k in pair)
                depth = DRAW.choice([0, 1, 2, 3])
                low = DRAW.randrange(1 << depth) * (check_path.END >> depth)
                integers = [round(DRAW.gauss(0, 1) * 1000) or 1 for _ in range(kinds[kind])]
                def gap(s):
                    """The least n . (y - x) and |n|; for S and L the distance and 1."""
                    at = poses(lines, between(rows, s))
                    x, y = ([u + v for u, v in zip(at[body.link][1], turned(at[body.link][0], [v / one for v in body.centre]))]
                            for body in (a, b))
                    d, radius = [v - u for u, v in zip(x, y)], (a.radius + b.radius) / one
                    if kind in "SL":
                        return math.hypot(*d) - radius, 1
                    e, f = (v and [x / math.hypot(*v) for x in v] for v in (integers[:3], integers[3:]))
                    link = {"A": a.link, "B": b.link, "W": edge.question.way(a.link, b.link)[1], "E": a.link}[kind]
                    n = turned(at[link][0], e)
                    if kind == "E":
                        f = turned(at[b.link][0], f)
                        n = [n[i - 2] * f[i - 1] - n[i - 1] * f[i - 2] for i in range(3)]
                    return sum(map(lambda u, v: u * v, n, d)) - radius * math.hypot(*n), math.hypot(*n)
                inside = [(low / check_path.END) + k / (16 << depth) for k in range(17)]
                gaps = [gap(s) for s in inside]
                if gaps[8][0] < 0:  # the other way round
                    integers[:3] = [-x for x in integers[:3]]
                    gaps = [gap(s) for s in inside]
                bounds, least, most = edge.bounds(a, b), 0, 16 * one
                for _ in range(24):
                    middle = least + most >> 1
                    high = low + (check_path.END >> depth)
                    least, most = (middle, most) if edge.holds(a, b, middle, kind, integers, low, high, depth, *bounds) \
                        else (least, middle)
                if least > one >> 6:
                    held[kind] += 1
                    for f, n in gaps:
                        self.assertLessEqual(least / one * n, f + 1e-9, (kind, integers, depth, low / check_path.END, pair, lines))
        self.assertGreater(min(held.values()), SAMPLES // 40, held)

    def test_a_long_chain(self):
        links = 301
        bodies = [ball("first", 0), ball("last", links - 1), ball("post", -1, (0, 0, 3))]
        tree = [joint("revolute", k, k + 1, (0.001, 0, 0), column=k) for k in range(links - 1)]
        rows = [[0] * (links - 1), [0.0001] * (links - 1)]
        lines = question(links, tree, bodies, rows, ignored=[(0, 1)])
        self.assertEqual(run(proof(lines, 1)).returncode, 0)
        tree.append(joint("revolute", links - 1, links, column=links - 1))
        lines[1]["links"].append("more")
        lines[links + 1:links + 1] = tree[-1:]
        done = run(lines)
        self.assertEqual(done.returncode, 2)
        self.assertIn("more than 300 joints", done.stderr)


# ---- Proofs of fmb path ----

def decimal(text):
    return " ".join(repr(x) for x in numbers(text))


def element(frame, line):
    at = f'<origin xyz="{decimal(line)}"/>' if line else ""
    if "radius" in frame:
        return f'<collision>{at}<geometry><sphere radius="{decimal(frame["radius"])}"/></geometry></collision>'
    return f'<collision>{at}<geometry><box size="{decimal(frame["box"][1])}"/></geometry></collision>'


def write_urdf(folder, lines):
    """A robot of URDF, a world of JSON and a table. Some links get a second element, and one carries a box."""
    links, rows = lines[1]["links"], [line["row"] for line in lines if "row" in line]
    text, bodies = '<robot name="random">', []
    for k, link in enumerate(links):
        text += f'<link name="{link}">'
        for line in lines:
            if line.get("link") == k:
                text += element(line["frames"][0], line["frames"][0]["hull"][0])
                if k % 3 == 2:
                    text += element(box("", 0, (0, 0, 0), (0.05, 0.1, 0.025))["frames"][0], "0x1p-4 0x0p+0 0x1p-5")
        text += "</link>"
    columns = {}
    tree = [line for line in lines if "joint" in line]
    for line in tree:
        text += f'<joint name="{line["joint"]}" type="{line["type"]}"><parent link="{links[line["parent"]]}"/>'
        text += f'<child link="{links[line["child"]]}"/><origin xyz="{decimal(line["xyz"])}" rpy="{decimal(line["rpy"])}"/>'
        if "axis" in line:
            text += f'<axis xyz="{decimal(line["axis"])}"/><limit lower="-100" upper="100" effort="1" velocity="1"/>'
        if "mimic" in line:
            target, factor, offset = line["mimic"]
            text += f'<mimic joint="{tree[target]["joint"]}" multiplier="{decimal(factor)}" offset="{decimal(offset)}"/>'
        if "column" in line:
            columns[line["column"]] = line["joint"]
        text += "</joint>"
    far = next(line for line in lines if line.get("link") == -1)["frames"][0]
    bodies.append({"id": 100, "name": "far", "shape": "sphere", "radius": numbers(far["radius"])[0],
                   "position": numbers(far["hull"][0])})
    bodies.append({"id": 101, "name": "tool", "shape": "box", "size": [0.1, 0.05, 0.025], "link": links[-1],
                   "position": [0, 0.1, 0], "orientation": [3, 1, 2, 0.5]})
    bodies.append({"id": 102, "name": "post", "shape": "box", "size": [0.25, 0.125, 1], "position": [1, 1, 0],
                   "orientation": [1, 0.25, 0, 0.5]})
    for name, text in (("robot.urdf", text + "</robot>"), ("world.json", json.dumps({"dim": 3, "bodies": bodies})),
                       ("path.csv", "\n".join([",".join(columns[k] for k in sorted(columns))] +
                                              [",".join(repr(x) for x in numbers(row)) for row in rows]) + "\n")):
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)


def fmb_path(folder, *options):
    """The proof that fmb writes, and its lines of JSON, of which the last one is the path's."""
    names = [os.path.join(folder, name) for name in ("robot.urdf", "path.csv", "world.json", "proof")]
    done = subprocess.run([FMB, "path", names[0], "--joints-csv", names[1], "--with", names[2], "--proof", names[3], "--force",
                           "--base", "0.5,-0.25,1,0.125,-2,3", "--json", *options], capture_output=True, text=True)
    if done.returncode == 2:
        raise AssertionError(done.stderr)
    with open(names[3], "rb") as file:
        return file.read(), [json.loads(line) for line in done.stdout.splitlines()]


def lines_of(packed):
    return [json.loads(line) for line in gzip.decompress(packed).splitlines()]


FMB = os.environ.get("FMB")


@unittest.skipUnless(FMB, "FMB is not set")
class Together(unittest.TestCase):
    def paths(self, count, *options):
        """Proofs of random robots that prove something."""
        while count:
            folder = tempfile.mkdtemp(dir=FOLDER)
            lines = random_tree()
            k = next(k for k, line in enumerate(lines) if "row" in line)
            rows = [numbers(line["row"]) for line in lines if "row" in line]
            lines.insert(k, {"row": hexed(*(x + DRAW.uniform(-0.5, 0.5) for x in rows[0]))})
            write_urdf(folder, lines)
            packed, said = fmb_path(folder, *options)
            if any(edge["verdict"] in ("free", "near") for edge in said[:-1]):
                count -= 1
                yield packed, said

    def test_proofs_of_random_robots_hold(self):
        kinds = set()
        for options in ((), ("--clearance", "0.01"), ("--clearance", "0.25")):
            for packed, said in self.paths(SAMPLES // 20, *options):
                done = run(packed, "--verbose")
                edges = [edge["verdict"] in ("free", "near") for edge in said[:-1]]
                self.assertEqual((done.returncode, done.stderr), (0 if all(edges) else 3, ""), lines_of(packed))
                found = [line for line in lines_of(packed) if "edge" in line]
                for edge, line in zip(said[:-1], found):
                    if edge["verdict"] in ("free", "near"):
                        claimed = numbers(line["clearance"])[0]
                        self.assertLessEqual(claimed, edge["clearance"])
                        self.assertLess(edge["clearance"] * (1 - 2**-15), claimed)
                kinds |= {item[0] for line in lines_of(packed) for item in line.get("proof", [])}
        self.assertLessEqual({"S", "L", "A", "B"}, kinds)


SEED = int(os.environ.get("FMB_SEED") or 1)
SAMPLES = int(200 * float(os.environ.get("FMB_SAMPLE") or 1))
DRAW = random.Random(SEED)
FOLDER = None
if __name__ == "__main__":
    print("seed", SEED)
    with tempfile.TemporaryDirectory() as FOLDER:
        unittest.main()
