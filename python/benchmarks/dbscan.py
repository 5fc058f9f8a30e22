#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times Lisco against the DBSCAN of scikit-learn and, if installed (python3-open3d), of Open3D.

PYTHONPATH=build/release/python python/benchmarks/dbscan.py scan.pcd=-1.7...
"""

import argparse
import statistics
import time

import lisco
import numpy as np
from sklearn.cluster import DBSCAN


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scans", nargs="+", metavar="SCAN[=M]", help="and the height below which points are left out")
    parser.add_argument("--tolerance", type=float, nargs="+", default=[0.1, 0.4, 1.0], metavar="M")
    parser.add_argument("--runs", type=int, default=5, metavar="N")
    given = parser.parse_args()
    others = {"scikit-learn": by_scikit_learn}
    try:
        import open3d  # noqa: F401

        others["Open3D"] = by_open3d
    except ImportError:
        print("Open3D is not installed (Debian: python3-open3d)\n")
    print("| scan | points | tolerance, m | Lisco, ms | " + " | ".join(f"{name}, ms" for name in others) + " |")
    print("|---|---|---|---|" + "---|" * len(others))
    for item in given.scans:
        path, _, height = item.partition("=")
        scan = lisco.read(path)
        points = scan.reshape(-1, 3)
        points = points[np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)]
        points = points[points[:, 2] >= float(height or -np.inf)]
        for tolerance in given.tolerance:
            clusterer = lisco.Clusterer(tolerance)
            labels = clusterer.cluster(points)
            cells = [f"{1e3 * median(lambda: clusterer.cluster(points), given.runs):.2f}"]
            for other in others.values():
                found = other(points, tolerance)
                seconds = median(lambda: other(points, tolerance), given.runs)
                difference = found.max() - labels.max()
                same = "" if difference == 0 else f" ({difference:+} clusters)"
                cells.append(f"{1e3 * seconds:.0f}{same}")
            print(f"| {path.rsplit('/', 1)[-1]} | {len(points)} | {tolerance} | {' | '.join(cells)} |", flush=True)


def median(call, runs):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def by_scikit_learn(points, tolerance):
    return DBSCAN(eps=tolerance, min_samples=1).fit(points).labels_


def by_open3d(points, tolerance):
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points.astype(np.float64)))
    return np.asarray(cloud.cluster_dbscan(eps=tolerance, min_points=1))


if __name__ == "__main__":
    main()
