"""Tests of fmb.py. FMB is the program to compare with. The tests on the bus need fmbd, and BUS=1."""

import contextlib
import copy
import ctypes
import glob
import importlib.util
import itertools
import json
import math
import os
import random
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from array import array

import fmb

BUS = os.environ.get("BUS")


def body_of(json_body, dim):
    made = []
    for frame in json_body.get("frames", [json_body]):
        given = {key: frame[key] for key in ("components", "origin", "vertices", "size", "radius", "length")
                 if key in frame}
        if frame["shape"] in ("sphere", "capsule"):
            given["dim"] = dim
        if "sides" in frame:
            given["sides"] = frame["sides"]
        if "frames" in json_body and "position" in frame:
            given["centre"] = frame["position"]
        made.append(getattr(fmb, frame["shape"])(**given))
    return made[0] if len(made) == 1 else fmb.compound(made)


def scene_of(json_scene):
    """A scene, and its listed pairs."""
    bodies = json_scene["bodies"]
    dim = json_scene["dim"]
    scene = fmb.Scene([body_of(body, dim) for body in bodies],
                      positions=[body.get("position", [0] * dim) for body in bodies],
                      velocities=[body.get("velocity", [0] * dim) for body in bodies],
                      names=[body.get("name") for body in bodies],
                      groups=[body.get("group", 0) for body in bodies],
                      ids=[body["id"] for body in bodies])
    for i, body in enumerate(bodies):
        if "orientation" in body:
            scene.move(i, orientation=body["orientation"])
    index = {body["id"]: i for i, body in enumerate(bodies)}
    pairs = json_scene.get("pairs", list(itertools.combinations(index, 2)))
    return scene, [(index[a], index[b]) for a, b in pairs]


def random_scene(dim, count, seed):
    draw = random.Random(seed)

    def vector(size, n=dim):
        return [size * (draw.random() - 0.5) for _ in range(n)]

    def frame():
        out = core()
        if "radius" not in out and draw.random() < 0.3:
            out["radius"] = draw.choice([0, draw.random()])
        return out

    def core():
        shape = draw.choice(["box", "cuboid", "tetrahedron", "hull", "sphere", "capsule"] + ["face", "cylinder"] * (dim == 3))
        if shape == "sphere":
            return {"shape": shape, "radius": draw.random(), "position": vector(2)}
        if shape == "cylinder":
            return {"shape": shape, "radius": draw.random(), "length": draw.random(), "sides": draw.choice([4, 20])}
        if shape == "capsule":
            return {"shape": shape, "radius": draw.random(), "length": draw.random()}
        if shape == "box":
            return {"shape": shape, "size": [0.5 + draw.random() for _ in range(dim)]}
        if shape == "hull":
            return {"shape": shape, "vertices": [vector(2) for _ in range(draw.randrange(1, 12))]}
        corners = 3 if shape == "face" else dim + 1
        if shape != "cuboid" and draw.random() < 0.5:
            return {"shape": shape, "vertices": [vector(2) for _ in range(corners)]}
        return {"shape": shape, "origin": vector(1), "components": [vector(2) for _ in range(corners - 1)]}

    bodies = []
    for i in range(count):
        body = {"id": i + 1, "name": f"body {i}", "position": vector(4), "velocity": vector(1)}
        if draw.random() < 0.7:
            body["orientation"] = vector(1, 4 if dim == 3 else 2)
        body["frames"] = [frame() for _ in range(draw.choice([1, 1, 3]))]
        bodies.append(body)
    return {"dim": dim, "duration": 0.7, "bodies": bodies}


def as_json(answer):
    """An answer as fmb query prints it, without ids."""
    out = {"verdict": answer.verdict.name.lower()}
    if answer.contact:
        out["contact"] = list(answer.contact)
    if answer.box:
        out["box"] = {end: [x if math.isfinite(x) else None for x in corner]
                      for end, corner in zip(("min", "max"), answer.box)}
    if answer.point:
        out["point"] = {"time": answer.point[0], "position": list(answer.point[1])}
    if answer.gap:
        out["gap"] = list(answer.gap)
        out["direction"] = list(answer.direction)
        if answer.frames != (0, 0):
            out["frames"] = list(answer.frames)
        if answer.witness:
            out["witness"] = dict(zip("ab", map(list, answer.witness)), time=answer.time)
    return out


def of_json(pair):
    out = {key: value for key, value in pair.items() if key not in ("a", "b", "names")}
    if out.get("frames") == [0, 0]:
        del out["frames"]
    return out


def placed_of(scene):
    """Of each body: position, velocity, orientation and its count; position, orientation and count of the end."""
    dim = scene.dim
    turns = 2 if dim == 2 else 4
    return [(tuple(p.position[:dim]), tuple(p.velocity[:dim]), tuple(p.orientation[:turns]), p.orientation_count,
             tuple(p.end_position[:dim]), tuple(p.end_orientation[:turns]), p.end_count)
            for p in fmb._lib.fmb_flat_placements(scene._handle)[:len(scene)]]


WANTED = {"contacts": True, "boxes": True, "points": True, "gaps": True}


def in_child(work):
    """Returns whether work() is true in a child process that does not hang."""
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        try:
            os._exit(not work())
        finally:
            os._exit(2)
    return os.waitpid(child, 0)[1] == 0


class Busy:
    """A thread that calls work() until the end of the context."""

    def __init__(self, work):
        self.begun, self.over = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=self.run, args=(work,))

    def run(self, work):
        while not self.over.is_set():
            self.begun.set()
            work()

    def __enter__(self):
        self.thread.start()
        self.begun.wait()
        time.sleep(0.02)

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()


class Answers(unittest.TestCase):
    """In process; Bus repeats them on the bus."""

    client = None
    maxDiff = None

    def test_cases_have_their_answers(self):
        for path in glob.glob("tests/cases/*.json"):
            with self.subTest(path), open(path, encoding="utf-8") as file:
                case = json.load(file)
                scene, pairs = scene_of(case["scene"])
                duration = case["scene"].get("duration", 1)
                answers = scene.decide(duration, pairs=pairs, instant=duration == 0, contacts=True,
                                       boxes=True, client=self.client)
                self.assertEqual([as_json(a) for a in answers],
                                 [of_json(pair) for pair in case["answer"]["pairs"]])

    def test_answers_are_those_of_fmb_query(self):
        scenes = [random_scene(dim, 14, seed) for dim in (2, 3) for seed in range(4)]
        lines = subprocess.run([os.environ["FMB"], "query", "--local", "--json", "--box", "--point", "--gap"],
                               input="\n".join(map(json.dumps, scenes)), check=True, text=True,
                               capture_output=True).stdout.splitlines()
        seen = set()
        for json_scene, line in zip(scenes, lines, strict=True):
            scene, pairs = scene_of(json_scene)
            expected = json.loads(line)["pairs"]
            answers = scene.decide(0.7, pairs=pairs, client=self.client, **WANTED)
            self.assertEqual([as_json(a) for a in answers], [of_json(pair) for pair in expected])
            self.assertEqual([list(a.names) for a in answers], [pair["names"] for pair in expected])
            seen.update(a.verdict for a in answers)
        self.assertEqual(seen, {fmb.SEPARATED, fmb.OVERLAPPING})

    def test_each_part_is_the_same_whatever_else_is_wanted(self):
        square = fmb.hull([[-2, -2], [2, -2], [2, 2], [-2, 2]])
        kite = fmb.hull([[0, -3], [-1, -1], [1, 4], [-1, 1]])
        tight = fmb.Scene([square, kite], positions=[[0, 0], [-1, 2]], velocities=[[0, 0], [-3, -1]])
        for scene in tight, scene_of(random_scene(2, 8, 1))[0], scene_of(random_scene(3, 8, 2))[0]:
            whole = [as_json(a) for a in scene.decide(1, client=self.client, **WANTED)]
            self.assertGreater(len(whole), 0)
            for wanted in itertools.product((False, True), repeat=len(WANTED)):
                answers = scene.decide(1, client=self.client, **dict(zip(WANTED, wanted)))
                parts = "contact", "box", "point", "gap"
                left_out = set(parts).difference(itertools.compress(parts, wanted))
                if "gap" in left_out:
                    left_out.update(("direction", "witness", "frames"))
                self.assertEqual([as_json(a) for a in answers],
                                 [{k: v for k, v in a.items() if k not in left_out} for a in whole])

    def test_shapes_with_a_radius_touch_exactly(self):
        ball, cube = fmb.sphere(3), fmb.box([2, 2, 2])
        for other, place in ((fmb.sphere(4), [2, 3, 6]), (cube, [4, 0, 0]), (cube, [2, 3, 3]),
                             (fmb.capsule(1, 6), [0, 4, -3]), (fmb.box([2, 2, 2], radius=1), [0, 0, 5]),
                             (fmb.capsule(0, 2), [0, 0, 4]), (fmb.sphere(0), [1, 2, 2])):
            for scale, verdict in ((1 - 2**-40, fmb.OVERLAPPING), (1, fmb.TOUCHING), (1 + 2**-40, fmb.SEPARATED)):
                scene = fmb.Scene([ball, other], positions=[[0, 0, 0], [x * scale for x in place]])
                self.assertEqual(scene.pair(0, 1, 0, client=self.client).verdict, verdict)
        moved = fmb.Scene([ball, fmb.sphere(4, [1, 3, 5])], positions=[[0, 0, 0], [1, 0, 1]])
        self.assertEqual(moved.pair(0, 1, 0, client=self.client).verdict, fmb.TOUCHING)
        discs = fmb.Scene([fmb.sphere(2, dim=2), fmb.sphere(3, dim=2)], positions=[[0, 0], [3, 4]])
        self.assertEqual(discs.pair(0, 1, 0, client=self.client).verdict, fmb.TOUCHING)

    def test_ways_to_name_pairs_agree(self):
        scene, pairs = scene_of(random_scene(3, 20, 9))
        listed = list(scene.decide(0.7, pairs=pairs, client=self.client, **WANTED))
        meet = [a for a in listed if a.verdict > fmb.SEPARATED]
        self.assertGreater(len(meet), 5)
        self.assertLess(len(meet), len(listed))
        every = scene.decide(0.7, client=self.client, **WANTED)
        self.assertEqual(list(every), meet)
        self.assertEqual([every[-1], every[1:3]], [meet[-1], meet[1:3]])
        across = scene.decide(0.7, split=6, client=self.client, **WANTED)
        self.assertEqual(list(across), [a for a in meet if a.a < 6 <= a.b])
        ignored = [(a.b, a.a) for a in meet[::2]]
        left = scene.decide(0.7, ignored=ignored, client=self.client, **WANTED)
        self.assertEqual(list(left), meet[1::2])
        for answer in listed[:40]:
            self.assertEqual(scene.pair(answer.a, answer.b, 0.7, box=True, point=True, gap=True,
                                        client=self.client), answer)
        near = [a for a in listed if a.gap[0] <= 0.3]
        margin = scene.decide(0.7, margin=0.3, contacts=True, boxes=True, points=True, client=self.client)
        self.assertEqual(list(margin), near)
        self.assertGreater(len(near), len(meet))

    def test_groups_are_not_tested_against_each_other(self):
        cube = fmb.box([1, 1, 1])
        scene = fmb.Scene([cube] * 3, groups=[5, 0, 5])
        self.assertEqual([(a.a, a.b) for a in scene.decide(0, client=self.client)], [(0, 1), (1, 2)])
        with self.assertRaisesRegex(fmb.Error, r"^pairs\[1\]: "):
            scene.decide(0, pairs=[(0, 1), (2, 0)], client=self.client)

    def test_bodies_move_and_turn_to_an_end(self):
        draw = random.Random(3)
        for dim in (2, 3):
            n, turns = 6, 2 if dim == 2 else 4
            rows = lambda width: [[draw.uniform(-1, 1) for _ in range(width)] for _ in range(n)]
            begin, end, turned = rows(dim), rows(dim), fmb.normalized(rows(turns))
            on = [[x + 0.3 * y for x, y in zip(q, q[1:] + q[:1])] for q in map(list, turned)]
            bodies = [fmb.box([0.5] * dim)] * n
            scene = fmb.Scene(bodies, positions=begin, orientations=turned, end_positions=end, end_orientations=on)
            given = [{"id": i + 1, "shape": "box", "size": [0.5] * dim, "position": list(begin[i]),
                      "orientation": list(turned[i]), "end": {"position": list(end[i]), "orientation": on[i]}}
                     for i in range(n)]
            with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
                json.dump({"dim": dim, "bodies": given}, file)
                file.flush()
                read = fmb.Scene.from_json(file.name)
            self.assertEqual(placed_of(read), placed_of(scene))
            later = fmb.Scene(bodies, positions=[[9] * dim] * n, velocities=end)
            later.place(begin, turned, end_positions=end, end_orientations=on)
            self.assertEqual(placed_of(later), placed_of(scene))
            pairs = list(itertools.combinations(range(n), 2))
            answers = scene.decide(1, pairs=pairs, client=self.client, **WANTED)
            self.assertEqual(list(answers), list(read.decide(1, pairs=pairs, **WANTED)))
            self.assertTrue(all(status in (0, 13) for status in answers.statuses))
            # A window of 0 s has no end. At an instant, bodies are in the pose at the beginning.
            with self.assertRaisesRegex(fmb.Error, "^duration: .*body 0 moves: .*instant=True"):
                scene.decide(0, client=self.client)
            with self.assertRaisesRegex(fmb.Error, "duration") as caught:
                scene.pair(0, 1, 0, client=self.client)
            self.assertEqual(caught.exception.status, 9)
            still = fmb.Scene(bodies, positions=begin, orientations=turned)
            self.assertEqual(list(scene.decide(0, instant=True, client=self.client)), list(still.decide(0)))
            # The next window begins where this one ends; velocities remove ends.
            scene.place(end, on, end_positions=begin, end_orientations=turned)
            self.assertEqual([(p[4], p[5], p[0], p[2]) for p in placed_of(scene)],
                             [(p[0], p[2], p[4], p[5]) for p in placed_of(read)])
            scene.place(velocities=[[0] * dim] * n)
            self.assertEqual(list(scene.decide(0, client=self.client)), list(
                fmb.Scene(bodies, positions=end, orientations=on).decide(0)))

    def test_what_is_missing_of_an_end_is_as_at_the_begin(self):
        scene = fmb.Scene([fmb.box([1, 1])] * 3, positions=[[1, 2]] * 3)
        scene.move(0, end_position=[3, 4])
        scene.move(1, end_orientation=[3, -2])
        self.assertEqual([p[:1] + p[2:] for p in placed_of(scene)],
                         [((1, 2), (0, 0), 0, (3, 4), (0, 0), 2), ((1, 2), (1, 0), 2, (1, 2), (3, -2), 4),
                          ((1, 2), (0, 0), 0, (0, 0), (0, 0), 0)])
        scene.move(0, orientation=[0, 2])  # does not turn
        scene.move(1, [5, 6])  # the end stays
        self.assertEqual([p[:1] + p[2:] for p in placed_of(scene)][:2],
                         [((1, 2), (0, 2), 2, (3, 4), (0, 2), 4), ((5, 6), (1, 0), 2, (1, 2), (3, -2), 4)])

    def test_orientations_are_normalized(self):
        for rows in ([[3, 4], [0, -5e-324]], [[1e308, 0, -1e308, 1e308], [1, 1, 1, 1]]):
            for given, q in zip(rows, fmb.normalized(rows)):
                largest = max(map(abs, given))
                length = math.hypot(*(x / largest for x in given))
                for x, y in zip(given, q):
                    self.assertAlmostEqual(y * length, x / largest, delta=1e-15)

    def test_a_moving_body_needs_a_window_or_an_instant(self):
        scene = fmb.Scene([fmb.box([1, 1])] * 3, velocities=[[0, 0], [0, -1], [0, 0]])
        with self.assertRaisesRegex(fmb.Error, "^duration: .*body 1 moves: .*instant=True") as caught:
            scene.decide(0, client=self.client)
        self.assertEqual(caught.exception.status, 9)
        self.assertEqual(len(scene.decide(0, instant=True, client=self.client)), 3)
        self.assertEqual(scene.pair(0, 1, 0, client=self.client).verdict, fmb.OVERLAPPING)

    def test_a_verdict_equals_its_name_and_its_number(self):
        scene = fmb.Scene([fmb.box([1, 1])] * 3, positions=[[0, 0], [1, 0], [0.5, 0]])
        answers = scene.decide(0, client=self.client)
        self.assertEqual([a.verdict for a in answers], ["touching", "overlapping", "overlapping"])
        touching = answers[0].verdict
        self.assertTrue(touching == "touching" and "touching" == touching)
        self.assertFalse(touching != "touching" or touching == "overlapping" or touching == "x")
        for words in (["touching"], ("touching",), {"touching"}, {"touching": 1}, {fmb.TOUCHING}):
            self.assertIn(touching, words)
        self.assertNotIn(touching, {"overlapping", "separated"})
        self.assertEqual((f"{touching}", str(touching)), ("touching", "touching"))
        self.assertEqual((touching, touching.name, int(touching)), (2, "TOUCHING", 2))
        self.assertTrue(touching != 3 and touching is fmb.TOUCHING)
        self.assertTrue(fmb.SEPARATED < touching <= "touching" < fmb.OVERLAPPING > "separated")
        with self.assertRaises(TypeError):
            touching < "x"
        self.assertEqual([v == fmb.TOUCHING for v in answers.verdicts], [True, False, False])
        if fmb.numpy:
            self.assertEqual((answers.verdicts == fmb.OVERLAPPING).tolist(), [False, True, True])
            self.assertEqual((fmb.OVERLAPPING != answers.verdicts).tolist(), [True, False, False])
            self.assertEqual((answers.verdicts >= fmb.OVERLAPPING).tolist(), [False, True, True])
            self.assertTrue(fmb.numpy.isin(answers.verdicts, [fmb.TOUCHING, fmb.OVERLAPPING]).all())


@unittest.skipUnless(BUS, "needs fmbd")
class Bus(Answers):
    @classmethod
    def setUpClass(cls):
        cls.client = fmb.Client()

    @classmethod
    def tearDownClass(cls):
        cls.client.close()

    def test_a_closed_client_is_refused(self):
        scene = fmb.Scene([fmb.box([1, 1])] * 2)
        with fmb.Client() as client:
            self.assertEqual(len(scene.decide(0, client=client)), 1)
        client.close()
        for call in (lambda: scene.decide(0, client=client), lambda: scene.pair(0, 1, 0, client=client)):
            with self.assertRaisesRegex(fmb.BusError, "^client: "):
                call()

    def test_a_client_is_not_used_by_another_process(self):
        # Both would take the answers to each other's queries for their own.
        scene = fmb.Scene([fmb.box([1, 1])] * 2)

        def is_refused():
            with fmb.Client() as own:
                answered = scene.pair(0, 1, 0, client=own).verdict == "overlapping"
            try:
                scene.pair(0, 1, 0, client=self.client)
            except fmb.BusError as error:
                return answered and str(error).startswith("client: it was opened by another process")

        def is_closed():
            self.client.close()
            return is_refused()

        self.assertTrue(in_child(is_refused))
        self.assertTrue(in_child(is_closed))
        # Another thread uses another client.
        with fmb.Client(prefix="none", timeout=0.2, tries=2) as other:
            def wait():
                with contextlib.suppress(fmb.BusError):
                    fmb.Scene([fmb.box([1, 1])] * 2).decide(0, client=other)

            def is_not_closed():
                try:
                    other.close()
                except fmb.BusError as error:
                    return str(error).startswith("client: another thread was using it during the fork: ")

            with Busy(wait):
                self.assertTrue(in_child(is_refused))
                self.assertTrue(any(in_child(is_not_closed) for _ in range(3)))
        self.assertEqual(scene.pair(0, 1, 0, client=self.client).verdict, fmb.OVERLAPPING)

    def test_without_a_service_nothing_is_answered(self):
        # An array of verdicts that are none would read as "nothing overlaps".
        scene = fmb.Scene([fmb.box([1, 1])] * 3)
        with fmb.Client(prefix="none", timeout=0.01, tries=2) as client:
            for name, call in (("client", lambda: scene.decide(0, client=client)),
                               ("client", lambda: scene.decide(0, pairs=[(1, 2)], client=client)),
                               ("pair", lambda: scene.pair(0, 1, 0, client=client))):
                with self.assertRaisesRegex(fmb.BusError, f"^{name}: .*no fmbd.*: start one with 'fmbd .*--prefix none &'$") as caught:
                    call()
                self.assertEqual(caught.exception.status, -2)

    def test_names_and_labels_are_on_the_bus(self):
        scene = fmb.Scene([fmb.box([1, 1])] * 2, names=["tafel \u00e4", None])
        answers = scene.decide(0, label="a label", client=self.client)
        self.assertEqual(answers[0].names, ("tafel \u00e4", None))
        with self.assertRaisesRegex(fmb.Error, "^label: "):
            scene.decide(0, label="\n", client=self.client)


class Arrays(unittest.TestCase):
    def setUp(self):
        self.scene = fmb.Scene([fmb.box([1, 1, 1])] * 3, positions=[[0, 0, 0], [0.5, 0, 0], [3, 0, 0]])

    def check(self, array_of, **options):
        answers = self.scene.decide(0, **WANTED, **options)
        shapes = {"pairs": (2,), "verdicts": (), "statuses": (), "contacts": (2,), "boxes": (2, 3),
                  "points": (4,), "gaps": (2,), "directions": (3,), "times": (), "witnesses": (2, 3), "frames": (2,)}
        for name, shape in shapes.items():
            column = getattr(answers, name)
            self.assertIsInstance(column, array_of, name)
            self.assertEqual(column.shape, (len(answers),) + shape, name)
        return answers

    def test_results_have_the_shapes_that_are_documented(self):
        array_of = fmb.numpy.ndarray if fmb.numpy else (memoryview, fmb.Rows)
        self.assertEqual(self.check(array_of).pairs.tolist(), [[0, 1]])
        listed = self.check(array_of, pairs=[[2, 0], [1, 0]])
        self.assertEqual(listed.verdicts.tolist(), [fmb.SEPARATED, fmb.OVERLAPPING])
        self.assertEqual(listed.pairs.tolist(), [[2, 0], [1, 0]])
        self.assertTrue(math.isnan(listed.contacts.tolist()[0][0]))
        self.assertEqual(listed.witnesses.tolist()[0][0][0], 2.5)
        self.assertEqual(listed.times.tolist(), [0, 0])
        moving = fmb.Scene([fmb.box([1, 1, 1])] * 2, velocities=[[1, 0, 0], [0, 0, 0]]).decide(1, gaps=True)
        self.assertTrue(math.isnan(moving.times.tolist()[0]) and math.isnan(moving.witnesses.tolist()[0][1][2]))
        nothing = self.scene.decide(0)
        self.assertEqual([nothing.contacts, nothing.boxes, nothing.points, nothing.gaps], [None] * 4)
        flat = fmb.Scene([fmb.box([1, 1])] * 2).decide(0, boxes=True, points=True)
        self.assertEqual(flat.boxes.tolist(), [[[-0.5, -0.5], [0.5, 0.5]]])
        self.assertEqual(flat.points.tolist(), [[0, 0, 0]])
        for none in (self.scene.decide(0, pairs=[], **WANTED), self.scene.decide(0, split=0, **WANTED)):
            self.assertEqual((len(none), list(none), len(none.gaps)), (0, [], 0))

    def test_points_of_contacts(self):
        # Two cubes that overlap in [0, 0.5] x [-0.5, 0.5] x [-0.5, 0.5], and one that is apart.
        self.assertEqual(self.scene.pair(0, 1, 0, point=True).point, (0, (0.25, 0, 0)))
        self.assertIsNone(self.scene.pair(0, 2, 0, point=True).point)
        self.assertIsNone(self.scene.pair(0, 1, 0).point)
        apart = self.scene.decide(0, pairs=[[2, 0], [1, 0]], points=True).points.tolist()
        self.assertEqual([math.isnan(x) for x in apart[0]], [True] * 4)
        self.assertEqual(apart[1], [0, 0.25, 0, 0])
        self.scene.place(velocities=[[0, 0, 0], [0, 0, 0], [-4, -2, 0]])
        answers = self.scene.decide(0.5, pairs=[[2, 0], [0, 1], [2, 1]], points=True)
        self.assertEqual(answers[1].point, (0, (0.25, 0, 0)))
        time, (x, y, z) = answers[2].point  # the third cube passes the second one
        self.assertEqual(answers.points.tolist()[2], [time, x, y, z])
        self.assertTrue(0.375 <= time <= 0.5 and 0 <= x <= 1 and abs(y) <= 0.5 and abs(z) <= 0.5)

    def test_answers_outlive_the_next_call(self):
        first = self.scene.decide(0, contacts=True)
        self.scene.place(positions=[[0, 0, 0], [5, 0, 0], [9, 0, 0]])
        self.assertEqual(len(self.scene.decide(0, contacts=True)), 0)
        self.assertEqual([(a.a, a.b, a.contact) for a in first], [(0, 1, (0, 0))])

    def test_refused_poses_change_nothing(self):
        before = self.scene.pair(0, 1, 0, box=True)
        for pose in ({"positions": [[1, 1, 1], [2, 2, 2], [3, 3, math.inf]]},
                     {"positions": [[1, 1, 1]] * 3, "orientations": [[1, 0, 0, 0]] * 2 + [[0] * 4]}):
            with self.assertRaises(fmb.Error):
                self.scene.place(**pose)
            self.assertEqual(self.scene.pair(0, 1, 0, box=True), before)

    def test_buffers_are_accepted_without_numpy(self):
        for code in "dfbhilqBHILQ":
            with self.subTest(code):
                numbers = array(code, [0, 0, 0, 9, 0, 0, 1, 0, 0])
                rows = memoryview(numbers).cast("B").cast(code, (3, 3))
                self.scene.place(rows)
                self.assertEqual([a.verdict for a in self.scene.decide(0, pairs=[[0, 1], [0, 2]])], [1, 2])
                self.scene.place(rows[::-1])  # not in C order
                self.assertEqual([a.verdict for a in self.scene.decide(0, pairs=[[0, 2], [0, 1]])], [2, 1])
                self.scene.move(0, memoryview(numbers)[3:6])
                self.assertEqual(self.scene.pair(0, 1, 0).verdict, fmb.OVERLAPPING)
        self.scene.place([[0, 0, 0], [9, 0, 0], [1, 0, 0]])
        for code in "bhilqBHILQ":
            pairs = memoryview(bytes(array(code, [0, 1, 0, 2]))).cast(code, (2, 2))  # read-only
            self.assertEqual(list(self.scene.decide(0, pairs=pairs).verdicts), [1, 2])
            self.assertEqual(list(self.scene.decide(0, pairs=pairs[::-1]).verdicts), [2, 1])
        rows = (ctypes.c_double * 3 * 3)((0, 0, 0), (1, 0, 0), (9, 0, 0))
        self.scene.place(rows)
        self.assertEqual(list(self.scene.decide(0, pairs=[[0, 1], [0, 2]]).verdicts), [2, 1])

    def test_rows_of_results_can_be_indexed(self):
        answers = self.scene.decide(0, pairs=[[2, 0], [1, 0]], **WANTED)
        for name in ("pairs", "contacts", "boxes", "points", "gaps", "directions", "witnesses", "frames"):
            column = getattr(answers, name)
            rows = column.tolist()
            with self.subTest(name):
                self.assertEqual(str([row.tolist() for row in column]), str(rows))
                self.assertEqual(str(column[-1].tolist()), str(rows[1]))
                self.assertEqual(str(column[1:].tolist()), str(rows[1:]))
                self.assertEqual(str(column[::-1][1].tolist()), str(rows[0]))
                self.assertEqual(str([column[0][k].tolist() if name == "boxes" else column[0][k]
                                      for k in range(len(rows[0]))]).count("nan"), str(rows[0]).count("nan"))
                with self.assertRaises(IndexError):
                    column[2]
        self.assertEqual((answers.gaps[0][0], answers.gaps[0, 1], len(answers.gaps)), (2, 2, 2))
        self.assertEqual(answers.boxes[1][0].tolist(), [0, -0.5, -0.5])
        self.assertEqual(answers.boxes[1, 1, 0], 0.5)
        # An array of results is an argument, too.
        found = self.scene.decide(0)
        self.assertEqual(len(self.scene.decide(0, ignored=found.pairs)), 0)
        self.assertEqual(len(self.scene.decide(0, pairs=answers.pairs[1:])), 1)
        self.scene.place(answers.boxes[1].tolist() + [list(answers.directions[0])])
        bounds = [fmb.hull(corners).dim for corners in answers.boxes[1:]]
        self.assertEqual(bounds, [3])

    def test_attributes_are_not_set(self):
        box = fmb.box([1, 1, 1])
        for owner, name in ((box, "postion"), (box, "position"), (box, "dim"), (self.scene, "positions")):
            with self.subTest(name), self.assertRaisesRegex(AttributeError, f"^{name}: .*Scene"):
                setattr(owner, name, [0, 0, 0])
        self.assertFalse(hasattr(box, "position"))

    def test_scenes_are_usable_in_a_child_process(self):
        expected = list(self.scene.decide(0, **WANTED))
        self.assertTrue(in_child(lambda: list(self.scene.decide(0, **WANTED)) == expected))

    def test_a_scene_that_a_thread_used_during_a_fork_is_refused_in_the_child(self):
        used = fmb.Scene([fmb.box([1, 1, 1])] * 300)
        expected = list(self.scene.decide(0, **WANTED))

        def is_refused():
            for call in (lambda: used.decide(0), lambda: used.pair(0, 1, 0), lambda: used.place([[0, 0, 0]] * 300)):
                try:
                    call()
                except fmb.Error as error:
                    if not str(error).startswith("scene: another thread was using it during the fork: "):
                        return False
                else:
                    return False
            wrong = []

            def work():
                for _ in range(200):
                    if list(self.scene.decide(0, **WANTED)) != expected:
                        wrong.append(1)

            with Busy(work), Busy(work):
                pass
            return not wrong

        # The thread does not use the scene between two queries.
        with Busy(lambda: used.decide(0, **WANTED)):
            self.assertTrue(any(in_child(is_refused) for _ in range(3)))
        self.assertEqual(used.pair(0, 1, 0).verdict, fmb.OVERLAPPING)

    def refused(self, error, start, call):
        with self.subTest(start):
            with self.assertRaises(error) as caught:
                call()
            self.assertTrue(f"{caught.exception}: ".startswith(start + ": "), str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))

    def test_refusals_name_the_argument(self):
        scene, box, nan = self.scene, fmb.box([1, 1, 1]), math.nan
        for error, start, call in (
                (ValueError, "positions", lambda: scene.place([[0, 0, 0]])),
                (ValueError, "positions[0]", lambda: scene.place([[0, 0]] * 3)),
                (ValueError, "positions[1]", lambda: scene.place([[0, 0, 0], [0, 0], [0, 0, 0]])),
                (TypeError, "positions", lambda: scene.place([0, 0, 0])),
                (TypeError, "positions", lambda: scene.place([["a", 0, 0]] * 3)),
                ((TypeError, ValueError), "positions", lambda: scene.place(array("f", [0] * 9))),
                (ValueError, "positions", lambda: scene.place(array("d", [0] * 9))),
                (TypeError, "size", lambda: fmb.box(b"abc")),
                (TypeError, "size", lambda: fmb.box(memoryview(b"\1\1\1").cast("?"))),
                (TypeError, "size: expected an array of shape (dim,) with dim 2 or 3, found 1", lambda: fmb.box(1)),
                (TypeError, "positions", lambda: scene.place(1.5)),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=memoryview(array("d", [0, 1])).cast("B").cast("d", (1, 2)))),
                (fmb.Error, "positions[2]", lambda: scene.place([[0, 0, 0], [0, 0, 0], [0, nan, 0]])),
                (fmb.Error, "velocities[0]", lambda: scene.place(velocities=[[nan, 0, 0]] * 3)),
                (fmb.Error, "orientations[0]", lambda: scene.place(orientations=[[0, 0, 0, 0]] * 3)),
                (ValueError, "orientations[0]", lambda: scene.place(orientations=[[1, 0]] * 3)),
                (fmb.Error, "velocity", lambda: scene.move(1, velocity=[nan, 0, 0])),
                (fmb.Error, "end_positions[1]", lambda: scene.place(end_positions=[[0, 0, 0], [nan, 0, 0], [0, 0, 0]])),
                (fmb.Error, "end_orientations[2]", lambda: scene.place(end_orientations=[[1, 0, 0, 0]] * 2 + [[0, 1, 0, 0]])),
                (fmb.Error, "end_orientations[0]", lambda: scene.place(end_orientations=[[nan, 0, 0, 0]] * 3)),
                (fmb.Error, "orientations[0]", lambda: scene.place(orientations=[[0] * 4] * 3, end_orientations=[[1] * 4] * 3)),
                (ValueError, "end_positions", lambda: scene.place(end_positions=[[0, 0, 0]])),
                (ValueError, "end_orientations[0]", lambda: scene.place(end_orientations=[[1, 0]] * 3)),
                (ValueError, "velocities: not with end_positions",
                 lambda: scene.place(velocities=[[0, 0, 0]] * 3, end_positions=[[0, 0, 0]] * 3)),
                (ValueError, "velocity: not with end_orientation",
                 lambda: scene.move(1, velocity=[0, 0, 0], end_orientation=[1, 0, 0, 0])),
                (fmb.Error, "end_position", lambda: scene.move(1, end_position=[nan, 0, 0])),
                (fmb.Error, "end_orientation", lambda: scene.move(1, end_orientation=[5, 0, 0, 0])),
                (ValueError, "orientations[1]", lambda: fmb.normalized([[1, 0], [0, 0]])),
                (ValueError, "orientations[0]", lambda: fmb.normalized([[1, math.inf]])),
                (TypeError, "orientations", lambda: fmb.normalized([1, 0, 0, 0])),
                (fmb.Error, "orientation", lambda: scene.move(1, orientation=[0, 0, 0, 0])),
                (ValueError, "position", lambda: scene.move(1, [0, 0])),
                (IndexError, "index", lambda: scene.move(3, [0, 0, 0])),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=[[0.5, 1]])),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=[[0, 2**70]])),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=7)),
                (ValueError, "pairs[0]", lambda: scene.decide(0, pairs=[[0, 1, 2]])),
                (fmb.Error, "pairs[1]: there is no body 3", lambda: scene.decide(0, pairs=[[0, 1], [0, 3]])),
                (fmb.Error, "pairs[0]: there is no body -1", lambda: scene.decide(0, pairs=[[-1, 1]])),
                (fmb.Error, "pairs[0]", lambda: scene.decide(0, pairs=[[2**32, 1]])),
                (fmb.Error, "pairs[0]", lambda: scene.decide(0, pairs=[[1, 1]])),
                (fmb.Error, "ignored[0]: there is no body 3", lambda: scene.decide(0, ignored=[[0, 3]])),
                (ValueError, "ignored", lambda: scene.decide(0, ignored=[[0, 1]], pairs=[[0, 1]])),
                (ValueError, "split", lambda: scene.decide(0, split=1, pairs=[[0, 1]])),
                (ValueError, "split", lambda: scene.decide(0, split=-1)),
                (fmb.Error, "split", lambda: scene.decide(0, split=4)),
                (fmb.Error, "margin", lambda: scene.decide(0, margin=-1)),
                (fmb.Error, "duration", lambda: scene.decide(nan)),
                (fmb.Error, "duration", lambda: scene.decide(1, instant=True)),
                (TypeError, "duration", lambda: scene.decide(None)),
                (ValueError, "duration", lambda: scene.decide(10**400)),
                (TypeError, "client", lambda: scene.decide(0, client="udpm://")),
                (TypeError, "label", lambda: scene.decide(0, label=b"x")),
                (fmb.Error, "label", lambda: scene.decide(0, label="x" * 65)),
                (fmb.Error, "label", lambda: scene.decide(0, label="\n", pairs=[[0, 1]])),
                (fmb.Error, "pair", lambda: scene.pair(0, 0, 1)),
                (fmb.Error, "pair: there is no body 3", lambda: scene.pair(0, 3, 1)),
                (fmb.Error, "pair", lambda: scene.pair(0, 1, -1)),
                (ValueError, "a", lambda: scene.pair(2**64, 1, 1)),
                (TypeError, "b", lambda: scene.pair(0, 1.0, 1)),
                (fmb.Error, "size", lambda: fmb.box([1, -1, 1])),
                (fmb.Error, "size", lambda: fmb.box([1, math.inf, 1])),
                (ValueError, "size", lambda: fmb.box([1])),
                (ValueError, "centre", lambda: fmb.box([1, 1, 1], [0, 0])),
                (fmb.Error, "radius: a negative size or radius", lambda: fmb.box([1, 1, 1], radius=-1)),
                (fmb.Error, "radius: not a finite number", lambda: fmb.hull([[1, 1, 1]], radius=math.nan)),
                (fmb.Error, "radius: not a finite number", lambda: fmb.sphere(math.inf)),
                (fmb.Error, "radius", lambda: fmb.sphere(-5e-324, dim=2)),
                (TypeError, "radius", lambda: fmb.sphere(None)),
                (ValueError, "centre", lambda: fmb.sphere(1, [0])),
                (ValueError, "dim", lambda: fmb.sphere(1, dim=4)),
                (ValueError, "dim", lambda: fmb.capsule(1, 1, dim=1)),
                (fmb.Error, "length: a negative size or radius", lambda: fmb.capsule(1, -1)),
                (fmb.Error, "radius: a negative size or radius", lambda: fmb.capsule(-1, 1)),
                (fmb.Error, "length", lambda: fmb.capsule(1, math.inf)),
                (ValueError, "sides", lambda: fmb.cylinder(1, 1, sides=6)),
                (ValueError, "sides", lambda: fmb.cylinder(1, 1, sides=516)),
                (TypeError, "sides", lambda: fmb.cylinder(1, 1, sides=4.0)),
                (fmb.Error, "length: a negative size or radius", lambda: fmb.cylinder(1, -1)),
                (fmb.Error, "radius", lambda: fmb.cylinder(1.79e308, 1)),
                (TypeError, "hull() takes 1 positional argument but 2 were given", lambda: fmb.hull([[1, 1, 1]], 1)),
                (fmb.Error, "components", lambda: fmb.cuboid([[1, 0, 0]])),
                (TypeError, "components", fmb.tetrahedron),
                (TypeError, "origin", lambda: fmb.face(vertices=[[0, 0, 0]] * 3, origin=[0, 0, 0])),
                (fmb.Error, "vertices", lambda: fmb.face(vertices=[[0, 0]] * 3)),
                (fmb.Error, "vertices: 1025, at most 1024", lambda: fmb.hull([[0, 0, i] for i in range(1025)])),
                (ValueError, "vertices[1]", lambda: fmb.hull([[0, 0, 0], [0, 0]])),
                (ValueError, "vertices: it is empty", lambda: fmb.hull([])),
                (ValueError, "size: it is empty", lambda: fmb.box([])),
                (ValueError, "bodies", lambda: fmb.compound([])),
                (TypeError, "bodies[1]", lambda: fmb.Scene([box, None])),
                (TypeError, "bodies", lambda: fmb.Scene(box)),
                (fmb.Error, "bodies[1]", lambda: fmb.Scene([box, fmb.box([1, 1])])),
                (ValueError, "names", lambda: fmb.Scene([box], names=["a", "b"])),
                (TypeError, "names", lambda: fmb.Scene([box], names=1)),
                (TypeError, "names[0]", lambda: fmb.Scene([box], names=[1])),
                (TypeError, "names", lambda: fmb.Scene([box, box], names="ab")),
                (ValueError, "names[0]", lambda: fmb.Scene([box], names=["a\0b"])),
                (fmb.Error, "names[0]", lambda: fmb.Scene([box], names=["x" * 65])),
                (fmb.Error, "names[0]", lambda: fmb.Scene([box], names=["\ud800"])),
                (fmb.Error, "ids[0]", lambda: fmb.Scene([box], ids=[2**53])),
                (ValueError, "groups", lambda: fmb.Scene([box], groups=[1, 2])),
                (TypeError, "groups", lambda: fmb.Scene([box], groups=["a"])),
                (fmb.BusError, "prefix", lambda: fmb.Client(prefix="no prefix")),
                (ValueError, "tries", lambda: fmb.Client(tries=0)),
                (fmb.BusError, "within", lambda: fmb.Client(within=-1)),
                (TypeError, "timeout", lambda: fmb.Client(timeout="1")),
                (TypeError, "duration", lambda: scene.decide("1")),
                (TypeError, "margin", lambda: scene.decide(0, margin=b"1")),
                (TypeError, "fmb", lambda: copy.copy(scene))):
            self.refused(error, start, call)
        self.assertEqual(scene.pair(0, 1, 0).verdict, fmb.OVERLAPPING)

    @unittest.skipUnless(fmb.numpy, "needs numpy")
    def test_numpy_arrays_of_any_real_type_and_order_are_taken(self):
        numpy, scene = fmb.numpy, self.scene
        good = numpy.array([[0.0, 0, 0], [1, 0, 0], [9, 0, 0]])
        wide = numpy.zeros((6, 3, 2))
        wide[::2, :, 1] = good
        read_only = good.copy()
        read_only.setflags(write=False)
        pairs = numpy.argwhere(numpy.tri(3, k=-1))  # not in C order
        for positions in (good, read_only, numpy.asfortranarray(good), wide[::2, :, 1], good[::-1][::-1],
                          *(good.astype(code) for code in ("f2", "f4", ">f4", ">f8", "i1", "u8", ">i4"))):
            scene.place([[5, 5, 5]] * 3)
            scene.place(positions)
            self.assertEqual(scene.decide(0, pairs=pairs).verdicts.tolist(), [2, 1, 1])
            scene.move(2, positions[0])
            scene.move(1, position=positions[1])
            self.assertEqual(scene.pair(0, 2, 0).verdict, fmb.OVERLAPPING)
        scene.place(good)
        for listed in (numpy.ascontiguousarray(pairs), numpy.asfortranarray(pairs), pairs.astype("u4"),
                       pairs.astype("i2"), pairs.astype(">i8"), pairs.astype("u8")):
            self.assertEqual(scene.decide(0, pairs=listed).verdicts.tolist(), [2, 1, 1])
        narrow = numpy.float32([[0.1, 0, 0], [0, 0.1, 0]])
        exact = fmb.Scene([fmb.hull(narrow), fmb.hull(narrow.astype(float))])
        self.assertEqual(*exact.pair(0, 1, 0, gap=True).witness)
        whole = numpy.eye(3, dtype=int)
        for body in (fmb.box(whole[0] + 1, centre=whole[1]), fmb.cuboid(whole, whole[0]), fmb.face(whole[:2]),
                     fmb.tetrahedron(vertices=numpy.float32([[0, 0], [1, 0], [0, 1]]))):
            self.assertIn(body.dim, (2, 3))
        ids = numpy.array([5, 6, 7], "u2")
        fmb.Scene([fmb.box(whole[0])] * 3, positions=good.astype("f4"), orientations=numpy.eye(3, 4, dtype="i1"),
                  velocities=numpy.asfortranarray(good), ids=ids, groups=ids[::-1])
        for error, start, call in (
                (TypeError, "positions", lambda: scene.place(good.astype(object))),
                (TypeError, "positions", lambda: scene.place(good.astype(complex))),
                (TypeError, "positions", lambda: scene.place(good.astype(numpy.longdouble))),
                (TypeError, "positions", lambda: scene.place(good.astype(bool))),
                (TypeError, "positions", lambda: scene.place(good.astype("M8[s]"))),
                (TypeError, "positions", lambda: scene.place(good.astype(str))),
                (TypeError, "positions", lambda: scene.place(numpy.ma.masked_equal(good, 9))),
                (TypeError, "positions", lambda: scene.place(numpy.ma.masked_equal(good.astype("f4"), 9))),
                (ValueError, "positions", lambda: scene.place(good[:2])),
                (ValueError, "size", lambda: fmb.box(numpy.float32(1))),
                (fmb.Error, "positions[2]", lambda: scene.place(numpy.float32([[0] * 3, [0] * 3, [numpy.inf] * 3]))),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=numpy.array([[0.0, 1.0]]))),
                (TypeError, "pairs", lambda: scene.decide(0, pairs=numpy.array([[True, False]]))),
                (fmb.Error, "pairs[0]", lambda: scene.decide(0, pairs=numpy.array([[0, 2**64 - 1]], "u8"))),
                (ValueError, "pairs", lambda: scene.decide(0, pairs=numpy.array([0, 1])))):
            self.refused(error, start, call)

    @unittest.skipUnless(importlib.util.find_spec("pandas"), "needs pandas")
    def test_tables_of_pandas_are_arrays(self):
        import pandas
        table = pandas.DataFrame({"x": [0, 1, 9], "y": [0.0, 0, 0], "z": [0, 0, 0], "name": list("abc")})
        self.scene.place(table[["x", "y", "z"]])
        self.assertEqual([a.verdict for a in self.scene.decide(0)], ["touching"])
        found = pandas.DataFrame(self.scene.decide(0, pairs=[(0, 1), (0, 2)]))
        for touching in ("touching", fmb.TOUCHING):
            self.assertEqual((found.verdict == touching).tolist(), [True, False])
        scene = fmb.Scene([fmb.box(table[["x", "y", "z"]].loc[2])] * 3, names=table["name"], ids=table.index + 1)
        self.assertEqual(scene.names, ("a", "b", "c"))
        self.refused(TypeError, "positions", lambda: scene.place(table[["x", "y", "name"]]))

    def test_threads_may_share_a_scene(self):
        scene, pairs = scene_of(random_scene(3, 12, 3))
        expected = list(scene.decide(0.7, pairs=pairs, **WANTED))
        wrong = []

        def work():
            for _ in range(20):
                if list(scene.decide(0.7, pairs=pairs, **WANTED)) != expected:
                    wrong.append(1)

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])



DEMO = "clients/demo/robot/"


class Robots(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        box = "<collision><geometry><box size='1 1 1'/></geometry></collision>"
        self.urdf = self.file("r.urdf", f"""<robot name="r"><link name="base">{box}</link>
            <link name="plate">{box}</link><link name="arm">{box}</link><link name="tool">{box}</link><link name="tip"/>
            <joint name="weld" type="fixed"><parent link="base"/><child link="plate"/></joint>
            <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
            <joint name="slide" type="prismatic"><origin xyz="0 0 4"/><parent link="arm"/><child link="tool"/>
            <axis xyz="0 1 0"/><limit lower="1" upper="3"/></joint>
            <joint name="end" type="fixed"><origin xyz="0 0 1"/><parent link="tool"/><child link="tip"/></joint>
            <joint name="follow" type="continuous"><parent link="tip"/><child link="flag"/><mimic joint="turn"/></joint>
            <link name="flag"/></robot>""")

    def file(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as out:
            out.write(text)
        return path

    def refused(self, error, start, call):
        with self.subTest(start), self.assertRaises(error) as caught:
            call()
        self.assertTrue(str(caught.exception).startswith(start), str(caught.exception))

    def test_answers_are_those_of_fmb_scene(self):
        with open(DEMO + "path.csv") as table:
            rows = [dict(zip(("time", "label", "waist", "lift", "elbow", "wrist"), line.split(",")))
                    for line in table.read().splitlines()[1:]]
        command = [os.environ["FMB"], "scene", DEMO + "robot.urdf", "--joints-csv", DEMO + "path.csv",
                   "--with", DEMO + "world.json", "--ignore", "base,table"]
        scenes = subprocess.run(command, check=True, text=True, capture_output=True).stdout
        lines = subprocess.run([os.environ["FMB"], "query", "--local", "--json", "--box", "--gap", "--contacts"],
                               input=scenes, text=True, capture_output=True).stdout.splitlines()
        robot = fmb.Robot(DEMO + "robot.urdf", ignore=[("base", "table")])
        self.assertEqual((robot.joints, robot.links),
                         (("waist", "lift", "elbow", "wrist"), ("base", "shoulder", "upper_arm", "forearm", "hand")))
        self.assertEqual((list(robot.lower), list(robot.upper), list(robot.home)),
                         ([-3, -0.5, -2.5, -math.inf], [3, 2, 2.5, math.inf], [0] * 4))
        self.assertAlmostEqual(robot.excess, 0.00244894, places=6)
        scene = robot.scene(fmb.Scene.from_json(DEMO + "world.json"))
        self.assertEqual(scene.names[5:], ("table", "post", "cube"))
        found = 0
        for row, line, json_scene in zip(rows, lines, scenes.splitlines(), strict=True):
            robot.place(scene, [float(row[name]) for name in robot.joints])
            answers = scene.decide(0, margin=scene.margin, contacts=True, boxes=True, gaps=True)
            expected = json.loads(line)["pairs"]
            for answer in expected:  # at rest the window does not matter
                if "contact" in answer:
                    answer["contact"] = [0, 0]
            self.assertEqual([as_json(a) for a in answers], [of_json(pair) for pair in expected])
            self.assertEqual([list(a.names) for a in answers], [pair["names"] for pair in expected])
            found += len(expected)
            # As in a scene of the file.
            path = self.file("row.json", json_scene)
            self.assertEqual(list(fmb.Scene.from_json(path).decide(0, margin=scene.margin, contacts=True, boxes=True, gaps=True)),
                             list(answers))
        self.assertGreater(found, 2)

    def test_a_scene_of_json_is_that_of_the_file(self):
        for dim in (2, 3):
            for seed in range(4):
                json_scene = random_scene(dim, 14, seed)
                json_scene.pop("pairs", None)
                json_scene["ignore"] = [[json_scene["bodies"][a]["id"], json_scene["bodies"][b]["id"]]
                                        for a, b in ((0, 1), (5, 3))]
                json_scene["margin"] = 0.25
                scene = fmb.Scene.from_json(self.file("s.json", json.dumps(json_scene)))
                again, _ = scene_of(json_scene)
                self.assertEqual((scene.dim, scene.margin, scene.duration, scene.names),
                                 (dim, 0.25, json_scene.get("duration", 1), again.names))
                expected = again.decide(0.7, ignored=[(0, 1), (3, 5)], **WANTED)
                self.assertEqual(list(scene.decide(0.7, **WANTED)), list(expected))
        self.refused(fmb.Error, "none.json: No such file", lambda: fmb.Scene.from_json("none.json"))
        path = self.file("s.json", '{"dim": 3, "bodies": [], "pairs": []}')
        self.refused(fmb.Error, f"{path}: \"pairs\" is not supported", lambda: fmb.Scene.from_json(path))
        path = self.file("s.json", '{"dim": 4, "bodies": []}')
        self.refused(fmb.Error, f"{path}: dim: expected 2 or 3", lambda: fmb.Scene.from_json(path))
        self.refused(TypeError, "path: expected a path", lambda: fmb.Scene.from_json(3))

    def test_a_robot_carries_bodies_and_ignores_pairs(self):
        world = fmb.Scene.from_json(self.file("w.json", json.dumps(
            {"dim": 3, "margin": 0.5, "bodies": [
                {"id": 1, "name": "table", "shape": "box", "size": [1, 1, 1], "position": [8, 0, 0], "group": -1},
                {"id": 9, "name": "cup", "shape": "box", "size": [1, 1, 1], "position": [0, 0, 1], "link": "tool"},
                {"id": 10, "name": "pen", "shape": "sphere", "radius": 0.5, "link": "tip"}],
             "ignore": [["cup", "pen"]]})))
        self.assertEqual(world.links, (None, "tool", "tip"))
        robot = fmb.Robot(self.urdf, ignore=[("tool", "pen"), ("flag", "base")], base=[10, 0, 0, 0, 0, math.pi / 2])
        self.assertEqual((robot.joints, list(robot.home)), (("turn", "slide"), [0, 2]))
        scene = robot.scene(world)
        self.assertEqual(scene.names, ("base", "plate", "arm", "tool", "cup", "pen", "table"))
        self.assertEqual(sorted(tuple(pair) for pair in scene.ignored), [(0, 2), (2, 3), (3, 4), (3, 5), (4, 5)])
        self.assertEqual(scene.margin, 0.5)
        met = {answer.names for answer in scene.decide(0)}
        self.assertEqual(met, {("plate", "arm")})  # base and plate are one rigid body
        robot.place(scene, [math.pi, 8])  # to x = 18
        scene.move(6, position=[18, 0, 5.25])
        self.assertEqual({answer.names for answer in scene.decide(0)},
                         {("plate", "arm"), ("cup", "table"), ("pen", "table")})
        bare = fmb.Robot(self.urdf).scene()
        self.assertEqual((len(bare), bare.margin), (4, 0))
        srdf = self.file("r.srdf", "<robot><disable_collisions link1='tool' link2='base'/></robot>")
        self.assertEqual([tuple(pair) for pair in fmb.Robot(self.urdf, srdf).scene().ignored], [(0, 3)])

    def test_answers_after_moves_are_those_of_a_new_scene(self):
        draw = random.Random(5)
        robot = fmb.Robot(DEMO + "robot.urdf", base=(0, 0, 0.25))
        cubes = fmb.Scene([fmb.box([0.2, 0.1, 0.3])] * 12, groups=[1] * 6 + [2] * 6, ignored=[(0, 6), (7, 1)],
                          positions=[[draw.uniform(-0.6, 0.6) for _ in range(3)] for _ in range(12)])
        scene = robot.scene(cubes)
        kinds = [{}, {"margin": 0.1}, WANTED, {"split": 5}, {"ignored": [(0, 7), (2, 9)]}, {"pairs": [(0, 7), (3, 9)]}]
        for step in range(150):
            robot.place(scene, [draw.uniform(-2, 2) for _ in robot.joints])
            if step % 10 == 3:  # an obstacle
                scene.move(draw.randrange(5, 17), position=[draw.uniform(-0.6, 0.6) for _ in range(3)])
            kind = kinds[draw.randrange(len(kinds)) if step % 4 == 0 else 0]
            fresh = fmb.Scene(scene.bodies, names=scene.names, ignored=scene.ignored,
                              groups=[0] * 5 + [1] * 6 + [2] * 6)
            copy_poses(scene, fresh)
            self.assertEqual(list(scene.decide(0, **kind)), list(fresh.decide(0, **kind)))
        self.assertTrue(in_child(lambda: list(scene.decide(0)) == list(fresh.decide(0))))
        self.assertTrue(in_child(lambda: robot.place(scene, robot.home) is None))

    def test_paths_are_those_of_fmb_path(self):
        with open(DEMO + "path.csv") as table:
            columns = dict(zip(("time", "label", "waist", "lift", "elbow", "wrist"),
                               zip(*(line.split(",") for line in table.read().splitlines()[1:]))))
        columns = {name: list(map(float, values)) for name, values in columns.items() if name != "label"}
        robot = fmb.Robot(DEMO + "robot.urdf")
        rows = list(zip(*(columns[name] for name in robot.joints)))
        bare, world = robot.scene(), fmb.Scene.from_json(DEMO + "world.json")
        verdicts = set()
        for clearance in (None, 0, 0.25):
            command = [os.environ["FMB"], "path", DEMO + "robot.urdf", "--joints-csv", DEMO + "path.csv", "--json",
                       "--with", DEMO + "world.json"] + ([] if clearance is None else ["--clearance", str(clearance)])
            lines = subprocess.run(command, text=True, capture_output=True).stdout.splitlines()
            rigid, *edges, whole = map(json.loads, lines)
            path = robot.check_path(rows, world, clearance=clearance)
            self.assertEqual(tuple(robot.check_path(columns, world, clearance=clearance)), tuple(path))
            self.assertEqual((path.verdict, len(path), path.pairs), (whole["path"], whole["edges"], whole["pairs"]))
            self.assertEqual((path.clearance, path.joint_error), (whole.get("clearance", 0), whole.get("joint_error", 0)))
            (a, b, verdict), = path.touches
            self.assertEqual(([path.names[a], path.names[b]], verdict), (rigid["names"], rigid["rigid"]))
            for edge, line in zip(path, edges, strict=True):
                self.assertEqual((edge.verdict, list(edge.at), edge.clearance, edge.closest, list(edge.names)),
                                 (line["verdict"], line.get("at", [0, 1]), line.get("clearance", 0), line["closest"], line["names"]))
                self.assertEqual(edge.names, tuple(path.names[i] for i in edge.pair))
                verdicts.add(edge.verdict)
        self.assertEqual(verdicts, {"free", "near", "contact"})
        # One pose; and no pair at all.
        pose = robot.check_path(rows[:1], world)
        self.assertEqual((len(pose), pose.verdict), (1, "free"))
        alone = fmb.Robot(self.file("one.urdf", """<robot name="one"><link name="a"/><link name="b"><collision><geometry>
            <sphere radius="1"/></geometry></collision></link><joint name="j" type="continuous"><parent link="a"/>
            <child link="b"/></joint></robot>""")).check_path([[0], [1]])
        self.assertEqual((alone.verdict, alone.clearance, alone.joint_error, alone[0].pair), ("free", math.inf, math.inf, None))
        self.assertEqual(list(robot.scene().decide(0)), list(bare.decide(0)))

    def test_ignored_pairs_belong_to_a_scene(self):
        cube = fmb.box([1, 1, 1])
        scene = fmb.Scene([cube] * 4, ignored=[(0, 1), (3, 2)])
        pairs = {(0, 2), (0, 3), (1, 2), (1, 3)}
        self.assertEqual({(a.a, a.b) for a in scene.decide(0)}, pairs)
        self.assertEqual({(a.a, a.b) for a in scene.decide(0, ignored=[(0, 2)])}, pairs - {(0, 2)})
        self.assertEqual({(a.a, a.b) for a in scene.decide(0)}, pairs)
        self.assertEqual({(a.a, a.b) for a in scene.decide(0, split=1)}, {(0, 2), (0, 3)})
        self.assertEqual(len(scene.decide(0, pairs=[(0, 1)])), 1)
        self.assertEqual([list(pair) for pair in scene.ignored], [[0, 1], [3, 2]])
        self.assertEqual(list(fmb.Scene([cube]).ignored), [])
        for wrong in ([(0, 4)], [(0, 0)], [(-1, 0)], [0, 1], [("a", 0)]):
            self.refused((ValueError, TypeError), "ignored",
                         lambda: fmb.Scene([cube] * 4, ignored=wrong).decide(0))

    def test_refusals_name_the_argument(self):
        robot, nan = fmb.Robot(self.urdf), math.nan
        scene, world = robot.scene(), fmb.Scene([fmb.box([1, 1])])
        other = fmb.Robot(self.urdf).scene()
        carried = fmb.Scene.from_json(self.file("w.json", json.dumps({"dim": 3, "bodies": [
            {"id": 1, "shape": "sphere", "radius": 1, "link": "hand"}]})))
        moving = fmb.Scene([fmb.box([1, 1, 1])], velocities=[[0, 0, 1]])
        for error, start, call in (
                (ValueError, "rows: expected at least one", lambda: robot.check_path([])),
                (ValueError, "rows: expected at least one", lambda: robot.check_path({"turn": [], "slide": []})),
                (ValueError, "rows[0]: expected 2 numbers, found 3", lambda: robot.check_path([[0, 0, 0]])),
                (ValueError, "rows: no column for slide", lambda: robot.check_path({"turn": [0], "end": [0]})),
                (ValueError, "rows: the columns have different lengths", lambda: robot.check_path({"turn": [0], "slide": [0, 1]})),
                (TypeError, "rows['slide']: ", lambda: robot.check_path({"turn": [0], "slide": ["a"]})),
                (TypeError, "rows: ", lambda: robot.check_path(None)),
                (fmb.Error, "rows[2]: joint 'turn': its value is not finite", lambda: robot.check_path([[0, 1], [0, 2], [nan, 0]])),
                (fmb.Error, "rows[1]: joint 'turn' turns from 0 to 4, by more than pi", lambda: robot.check_path([[0, 1], [4, 2]])),
                (fmb.Error, "body ", lambda: robot.check_path([[0, 1]], moving)),
                (TypeError, "world: ", lambda: robot.check_path([[0, 1]], "w.json")),
                (fmb.Error, "clearance: ", lambda: robot.check_path([[0, 1]], clearance=-1)),
                (TypeError, "clearance: ", lambda: robot.check_path([[0, 1]], clearance="1")),
                (ValueError, "q: expected shape (2,), found (3,)", lambda: robot.place(scene, [0, 0, 0])),
                (ValueError, "q: expected shape (2,), found (1, 2)", lambda: robot.place(scene, memoryview(array("d", [0, 0])).cast("B").cast("d", (1, 2)))),
                (TypeError, "q: ", lambda: robot.place(scene, [[0, 0]])),
                (TypeError, "q: ", lambda: robot.place(scene, ["a", 0])),
                (TypeError, "q: ", lambda: robot.place(scene, None)),
                (fmb.Error, "q: joint 'turn': its value is not finite", lambda: robot.place(scene, [nan, 0])),
                (fmb.Error, "q: joint 'slide': its value is not finite", lambda: robot.place(scene, [0, math.inf])),
                (fmb.Error, "q: joint 'turn': its value is beyond 1048576 radians", lambda: robot.place(scene, [2e6, 0])),
                (ValueError, "scene: ", lambda: robot.place(other, [0, 0])),
                (ValueError, "scene: ", lambda: robot.place(world, [0, 0])),
                (ValueError, "scene: ", lambda: robot.place(None, [0, 0])),
                (TypeError, "world: ", lambda: robot.scene("w.json")),
                (fmb.Error, "expected a scene in 3D", lambda: robot.scene(world)),
                (fmb.Error, "body 1: the robot has no link 'hand'", lambda: robot.scene(carried)),
                (fmb.Error, "ignore: no body has the name 'x'", lambda: fmb.Robot(self.urdf, ignore=[("base", "x")]).scene()),
                (ValueError, "ignore[1]: ", lambda: fmb.Robot(self.urdf, ignore=[("base", "arm"), ("base",)])),
                ((ValueError, TypeError), "ignore", lambda: fmb.Robot(self.urdf, ignore=[3])),
                (TypeError, "ignore", lambda: fmb.Robot(self.urdf, ignore=3)),
                (ValueError, "base: ", lambda: fmb.Robot(self.urdf, base=[0, 0])),
                (fmb.Error, "base: ", lambda: fmb.Robot(self.urdf, base=[0, 0, nan])),
                (ValueError, "sides: ", lambda: fmb.Robot(self.urdf, sides=-4)),
                (fmb.Error, "sides: expected a multiple of 4", lambda: fmb.Robot(self.urdf, sides=6)),
                (fmb.Error, "excess: ", lambda: fmb.Robot(self.urdf, excess=-1)),
                (TypeError, "path: ", lambda: fmb.Robot(None)),
                (TypeError, "srdf: ", lambda: fmb.Robot(self.urdf, 3)),
                (fmb.Error, "none.urdf: No such file", lambda: fmb.Robot("none.urdf")),
                (fmb.Error, "none.srdf: No such file", lambda: fmb.Robot(self.urdf, "none.srdf")),
                (AttributeError, "home: cannot be set", lambda: setattr(robot, "home", [0, 0])),
                (TypeError, "fmb: a Robot cannot be copied", lambda: copy.copy(robot))):
            self.refused(error, start, call)
        broken = self.file("b.urdf", "<robot><link name='a'><collision/></link><joint name='j' type='planar'/></robot>")
        with self.assertRaises(fmb.Error) as caught:
            fmb.Robot(broken)
        self.assertEqual(len(str(caught.exception).splitlines()), 2)


def copy_poses(scene, out):
    fmb._lib.fmb_flat_take(out._handle, fmb._lib.fmb_flat_placements(scene._handle), len(scene))

if __name__ == "__main__":
    unittest.main()
