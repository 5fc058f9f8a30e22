# SPDX-License-Identifier: BSD-3-Clause
"""From a scan to labelled boxes: labelled_boxes.py SCAN PICTURE PAGE"""
import sys

import lisco

scan, picture, page = sys.argv[1:]
points = lisco.read(scan)
objects = lisco.remove_ground(points)
labels = lisco.cluster(objects, tolerance=0.5, min_size=30)
boxes = lisco.boxes(objects, labels)
ax = lisco.plot(points, labels, boxes, extent=30)
for box in boxes[boxes["length"] > 1.5]:
    ax.text(box["min"][0], box["max"][1] + 0.3, f"{box['label']}: {box['length']:.1f} m", fontsize=7, clip_on=True)
ax.figure.savefig(picture, dpi=80)
lisco.view(points, labels, page, ground=lisco.ground(points), tolerance=0.5)
