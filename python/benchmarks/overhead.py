#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Overhead of Clusterer.cluster over the C++ call on a scan, both in turns.

Needs the benchmarks of a build (LISCO_BUILD_BENCHMARKS, LISCO_BUILD_PYTHON):
PYTHONPATH=build/release/python python/benchmarks/overhead.py build/release/python/python_overhead scan.pcd...
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time

import lisco
import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="build/release/python/python_overhead")
    parser.add_argument("scans", nargs="+", metavar="SCAN")
    parser.add_argument("--tolerance", type=float, nargs="+", default=[0.1, 0.4, 1.0], metavar="M")
    parser.add_argument("--runs", type=int, default=100, metavar="N")
    parser.add_argument("--dtype", choices=["float32", "float64"], default="float32", help="of the array")
    given = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # both on one core: those of a shared machine differ
    print("| scan | tolerance, m | C++, ms | Python, ms | overhead |\n|---|---|---|---|---|")
    for scan in given.scans:
        points = lisco.read(scan)
        points = points if points.ndim == 3 else points[np.newaxis]
        for tolerance in given.tolerance:
            native, python = both(given.program, points, points.astype(given.dtype), tolerance, given.runs)
            name = scan.rsplit("/", 1)[-1]
            overhead = 100 * (python / native - 1)
            print(f"| {name} | {tolerance} | {1e3 * native:.3f} | {1e3 * python:.3f} | {overhead:+.1f} % |")


def both(program, points, array, tolerance, runs):
    """Median seconds of the C++ call and of the Python call, of processor time."""
    with tempfile.NamedTemporaryFile(suffix=".bin") as file:
        points.tofile(file)
        file.flush()
        arguments = [program, file.name, *map(str, points.shape[:2]), str(tolerance)]
        clusterer = lisco.Clusterer(tolerance, min_size=10)
        times = ([], [])
        with subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            for _ in range(runs):
                process.stdin.write("\n")
                process.stdin.flush()
                times[0].append(float(process.stdout.readline()))
                start = time.thread_time()
                clusterer.cluster(array)
                times[1].append(time.thread_time() - start)
            process.stdin.close()
    return statistics.median(times[0]), statistics.median(times[1])


if __name__ == "__main__":
    main()
