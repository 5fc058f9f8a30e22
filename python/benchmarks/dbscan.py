#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times Lisco against the DBSCAN of scikit-learn and, if installed (python3-open3d), of Open3D.

PYTHONPATH=build/release/python python/benchmarks/dbscan.py scan.pcd=-1.7...
"""

import argparse
import json
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import lisco
import numpy as np


def by_scikit_learn(points, tolerance):
    from sklearn.cluster import DBSCAN

    return DBSCAN(eps=tolerance, min_samples=1).fit(points).labels_


def by_open3d(points, tolerance):
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points.astype(np.float64)))
    return np.asarray(cloud.cluster_dbscan(eps=tolerance, min_points=1))


METHODS = {"Lisco": None, "scikit-learn": by_scikit_learn, "Open3D": by_open3d}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scans", nargs="*", metavar="SCAN[=M]", help="and the height below which points are left out")
    parser.add_argument("--tolerance", type=float, nargs="+", default=[0.1, 0.4, 1.0], metavar="M")
    parser.add_argument("--runs", type=int, default=5, metavar="N", help="of which the median is printed")
    parser.add_argument("--limit", type=float, default=60, metavar="S", help="seconds for each method and tolerance; "
                        "the runs done until then count")
    parser.add_argument("--memory", type=float, default=8, metavar="GB", help="for each")
    parser.add_argument("--child", nargs=3, metavar=("METHOD", "FILE", "M"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        return child(given)
    names = [name for name in METHODS if is_installed(name)]
    print(f"{platform.machine()}, Python {platform.python_version()}, lisco {lisco.__version__}: median of up to "
          f"{given.runs} runs within {given.limit:g} s, one thread for Lisco.\n"
          "In brackets: clusters more than Lisco's.\n")
    print("| scan | points | tolerance, m | " + " | ".join(f"{name}, ms" for name in names) + " |")
    print("|---|---|---|" + "---|" * len(names))
    for item in given.scans:
        path, _, height = item.partition("=")
        points = points_of(path, float(height or -np.inf))
        for tolerance in given.tolerance:
            cells = row(names, points, tolerance, given)
            print(f"| {path.rsplit('/', 1)[-1]} | {len(points)} | {tolerance} | {' | '.join(cells)} |", flush=True)


def is_installed(name):
    module = {"scikit-learn": "sklearn", "Open3D": "open3d"}.get(name, "lisco")
    done = subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True)
    if done.returncode != 0:
        print(f"{name} is left out: the module {module} is not installed\n", file=sys.stderr)
    return done.returncode == 0


def points_of(path, height):
    points = lisco.read(path).reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)]
    return points[points[:, 2] >= height]


def row(names, points, tolerance, given):
    """Milliseconds of each method, in a process each, or why there are none."""
    cells, expected = [], None
    with tempfile.NamedTemporaryFile(suffix=".npy") as file:
        np.save(file, points)
        file.flush()
        for name in names:
            command = [sys.executable, __file__, "--child", name, file.name, str(tolerance), "--runs", str(given.runs)]
            command += ["--limit", str(given.limit), "--memory", str(given.memory)]
            try:  # starting takes some seconds more
                done = subprocess.run(command, capture_output=True, text=True, timeout=given.limit + 30)
            except subprocess.TimeoutExpired:
                cells.append(f"> {1e3 * given.limit:.0f}")
                continue
            if done.returncode != 0:
                reason = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
                cells.append(f"failed: {reason[:60]}")
                continue
            found = json.loads(done.stdout.splitlines()[-1])
            expected = found["clusters"] if expected is None else expected
            difference = found["clusters"] - expected
            digits = 2 if name == "Lisco" else 0
            cells.append(f"{1e3 * found['seconds']:.{digits}f}" + (f" ({difference:+})" if difference else ""))
    return cells


def child(given):
    """Prints the number of clusters and the median time of a method."""
    name, file, tolerance = given.child
    limit = int(given.memory * 1e9)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    points = np.load(file)
    clusterer = lisco.Clusterer(float(tolerance))
    method = METHODS[name] or (lambda points, _: clusterer.cluster(points))
    method(points if name == "Lisco" else points[:100], float(tolerance))  # loads libraries, takes memory
    times = []
    while len(times) < given.runs and sum(times) < given.limit:
        start = time.perf_counter()
        labels = method(points, float(tolerance))
        times.append(time.perf_counter() - start)
    print(json.dumps({"clusters": int(labels.max()) + 1, "seconds": statistics.median(times)}))


if __name__ == "__main__":
    main()
