"""bench.py BENCH_BATCH FILE: compares fmb.py with the same work in C, which the program BENCH_BATCH
does; the scene is written to FILE. Nanoseconds of CPU time; medians of five rounds of both."""

import statistics
import subprocess
import sys
import time

import numpy

import fmb


def nanoseconds(work, count):
    work()
    times = []
    for _ in range(9):
        begin = time.thread_time_ns()
        work()
        times.append((time.thread_time_ns() - begin) / count)
    return statistics.median(times)


def in_c(program, path):
    printed = subprocess.run([program, path], check=True, capture_output=True, text=True).stdout
    return {name: float(value) for name, value in map(str.split, printed.splitlines())}


def in_python(path):
    with open(path, "rb") as file:
        boxes, count = numpy.fromfile(file, "i8", 2)
        sizes, positions, orientations = (
            numpy.fromfile(file, "f8", boxes * width).reshape(boxes, width) for width in (3, 3, 4))
        pairs = numpy.fromfile(file, "i8", 2 * count).reshape(count, 2)
    scene = fmb.Scene([fmb.box(size) for size in sizes], positions=positions,
                      orientations=orientations)
    some = pairs[:20000].tolist()

    def singles():
        for a, b in some:
            scene.pair(a, b, 1)

    def moved():
        for a, b in some:
            scene.move(a, (1.0, 2.0, 3.0))
            scene.pair(a, b, 1)

    return {"verdicts": nanoseconds(lambda: scene.decide(1, pairs=pairs), count),
            "contacts": nanoseconds(lambda: scene.decide(1, pairs=pairs, contacts=True), count),
            "gaps": nanoseconds(lambda: scene.decide(1, pairs=pairs, gaps=True), count),
            "pair": nanoseconds(singles, len(some)), "moved": nanoseconds(moved, len(some))}


def main(program, path):
    rounds = [(in_c(program, path), in_python(path)) for _ in range(5)]

    def median(value):
        return statistics.median(value(c, python) for c, python in rounds)

    print("listed pairs of boxes, ns a pair     C  Python  rate of C's")
    for name in ("verdicts", "contacts", "gaps"):
        print(f"{name:30}{median(lambda c, p: c[name]):8.1f}{median(lambda c, p: p[name]):8.1f}"
              f"{median(lambda c, p: c[name] / p[name]):13.2f}")
    print("a single pair, ns                    C  Python  more than in C")
    for name, what in (("pair", "pair()"), ("moved", "move() and pair()")):
        print(f"{what:30}{median(lambda c, p: c['pair']):8.0f}{median(lambda c, p: p[name]):8.0f}"
              f"{median(lambda c, p: p[name] - c['pair']):16.0f}")


main(*sys.argv[1:])
