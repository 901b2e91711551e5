"""bench.py BENCH_BATCH FILE: fmb.py beside the same work in C, which the program BENCH_BATCH does;
FILE is for the scene. CPU time, medians of nine rounds, nanoseconds."""

import statistics
import subprocess
import sys
import time

import numpy

import fmb


def median(work, count):
    work()
    times = []
    for _ in range(9):
        begin = time.thread_time_ns()
        work()
        times.append((time.thread_time_ns() - begin) / count)
    return statistics.median(times)


def main(program, path):
    in_c = {}
    for line in subprocess.run([program, path], check=True, capture_output=True, text=True).stdout.splitlines():
        name, value = line.split()
        in_c[name] = float(value)

    with open(path, "rb") as file:
        boxes, count = numpy.fromfile(file, "i8", 2)
        sizes, positions, orientations = (
            numpy.fromfile(file, "f8", boxes * width).reshape(boxes, width) for width in (3, 3, 4))
        pairs = numpy.fromfile(file, "i8", 2 * count).reshape(count, 2)
    scene = fmb.Scene([fmb.box(size) for size in sizes], positions=positions,
                      orientations=orientations)

    print("listed pairs of boxes, ns a pair     C  Python  rate of C's")
    for name, options in (("verdicts", {}), ("contacts", {"contacts": True}), ("gaps", {"gaps": True})):
        ns = median(lambda: scene.decide(1, pairs=pairs, **options), count)
        print(f"{name:30} {in_c[name]:8.1f}{ns:8.1f}{in_c[name] / ns:13.2f}")

    some = pairs[:20000].tolist()

    def singles():
        for a, b in some:
            scene.pair(a, b, 1)

    def moved():
        for a, b in some:
            scene.move(a, (1.0, 2.0, 3.0))
            scene.pair(a, b, 1)

    print("a single pair, ns                    C  Python  more than in C")
    for name, work in (("pair()", singles), ("move() and pair()", moved)):
        ns = median(work, len(some))
        print(f"{name:30} {in_c['pair']:8.0f}{ns:8.0f}{ns - in_c['pair']:16.0f}")


main(*sys.argv[1:])
