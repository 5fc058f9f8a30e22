# SPDX-License-Identifier: BSD-3-Clause
"""From a scan to labels and a picture: top_view.py SCAN PICTURE"""
import sys

import lisco
import matplotlib

matplotlib.use("Agg")  # draws into files, without a display
scan, picture = sys.argv[1:]

points = lisco.read(scan)
objects = lisco.remove_ground(points)
labels = lisco.cluster(objects, tolerance=0.5, min_size=10)
ax = lisco.plot(points, labels, extent=40)
ax.figure.savefig(picture, dpi=80)
print(f"{labels.max() + 1} clusters of {(labels >= 0).sum()} points")
