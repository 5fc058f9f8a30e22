# SPDX-License-Identifier: BSD-3-Clause
"""Pictures."""

import lisco
import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")


def test_clusters_are_drawn_in_colours_of_their_own(rng, tmp_path):
    points = np.concatenate([rng.normal(center, 0.2, size=(50, 3)) for center in (-6, 2, 7)] + [[[20, 20, 0]]])
    labels = lisco.cluster(points, 1.0, min_size=2)
    ax = lisco.plot(points, labels, extent=25)
    alone, clustered = ax.collections
    assert len(alone.get_offsets()) == 1 and len(clustered.get_offsets()) == 150
    assert len(np.unique(clustered.get_facecolors(), axis=0)) == 3
    ax.figure.savefig(tmp_path / "scan.png", dpi=40)
    pixels = matplotlib.image.imread(tmp_path / "scan.png")[..., :3]
    assert len(np.unique((pixels.reshape(-1, 3) * 4).round(), axis=0)) > 4


def test_scans_without_clusters_are_drawn():
    lisco.plot(np.zeros((0, 3)), np.zeros(0, int))
    lisco.plot(np.full((3, 4, 3), np.nan), np.full((3, 4), -1))


def test_labels_of_another_shape_are_a_value_error():
    with pytest.raises(ValueError, match="labels must be of the shape of points"):
        lisco.plot(np.ones((5, 3)), np.zeros(4, int))
    with pytest.raises(ValueError, match="whole numbers"):
        lisco.plot(np.ones((5, 3)), np.zeros(5))
    with pytest.raises(ValueError, match="extent"):
        lisco.plot(np.ones((5, 3)), np.zeros(5, int), extent=0)


def test_boxes_are_outlines(rng):
    points = np.concatenate([rng.normal(center, 0.2, size=(50, 3)) for center in (-6, 2)])
    labels = np.repeat([3, 10**12], 50)
    boxes = lisco.boxes(points, labels)
    outlines = lisco.plot(points, labels, boxes).lines
    assert len(outlines) == 2
    for outline, corners in zip(outlines, lisco.corners(boxes)):
        assert np.array_equal(outline.get_xydata(), corners[[0, 1, 2, 3, 0], :2])
