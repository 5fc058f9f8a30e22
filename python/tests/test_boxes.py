# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of clusters, against NumPy."""

import lisco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

SIZES = st.integers(1, 60)


def car(yaw, place=(12.0, -5.0, 0.3), length=4.4, width=1.8):
    """Returns of two visible sides of a car, at 5 cm."""
    along = np.linspace(-length / 2, length / 2, round(length / 0.05))
    across = np.linspace(-width / 2, width / 2, round(width / 0.05))
    sides = [(x, -width / 2) for x in along] + [(length / 2, y) for y in across]
    points = np.array([(x, y, z) for x, y in sides for z in np.linspace(0, 1.4, 8)])
    sine, cosine = np.sin(yaw), np.cos(yaw)
    x, y = points[:, 0], points[:, 1]
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=1)
    return np.concatenate([turned, points[:, 2:]], axis=1) + place


def scene():
    """Points of three cars, in random order with points in no cluster between, and their labels."""
    cars = [car(0.3), car(-1.1, (-20, 4, 0)), car(1.4, (3, 30, -0.5))]
    points = np.concatenate([*cars, np.full((50, 3), 3.0)])
    labels = np.repeat([0, 1, 2, -1], [*map(len, cars), 50])
    order = np.random.default_rng(4).permutation(len(points))
    return points[order].astype(np.float32), labels[order].astype(np.int32)


def test_sizes_centroids_and_ranges_are_those_of_numpy():
    points, labels = scene()
    found = lisco.boxes(points, labels, origin=(1, 2, 3))
    assert found["label"].tolist() == [0, 1, 2]
    for box in found:
        members = points[labels == box["label"]].astype(np.float64)
        assert box["size"] == len(members)
        assert np.allclose(box["centroid"], members.mean(axis=0), rtol=0, atol=1e-9)
        assert np.array_equal(box["min"], members.min(axis=0).astype(np.float32))
        assert np.array_equal(box["max"], members.max(axis=0).astype(np.float32))
        assert box["nearest_range"] == pytest.approx(np.linalg.norm(members - [1, 2, 3], axis=1).min(), rel=1e-6)
        sides = [box["length"] * box["width"], box["length"] * box["height"], box["width"] * box["height"]]
        assert box["density"] == pytest.approx(len(members) / sum(sides))


def test_oriented_boxes_are_those_of_the_cars():
    points, labels = scene()
    found = lisco.boxes(points, labels)
    assert np.allclose(found["yaw"], [0.3, -1.1, 1.4], atol=0.01)
    assert np.allclose(found["length"], 4.4, atol=0.05) and np.allclose(found["width"], 1.8, atol=0.05)
    assert np.allclose(found["height"], 1.4, atol=1e-5)
    assert np.allclose(found["center"], [[12, -5, 1], [-20, 4, 0.7], [3, 30, 0.2]], atol=0.05)


def test_corners_are_those_of_the_boxes():
    points, labels = scene()
    found = lisco.boxes(points, labels)
    corners = lisco.corners(found)
    assert corners.shape == (3, 8, 3)
    assert np.allclose(corners.mean(axis=1), found["center"])
    edges = np.diff(corners[:, [0, 1, 2, 3, 0]], axis=1)
    lengths = np.linalg.norm(edges, axis=2)
    assert np.allclose(lengths, np.stack([found["length"], found["width"]] * 2, axis=1))
    assert np.allclose(np.arctan2(edges[:, 0, 1], edges[:, 0, 0]), found["yaw"])
    assert (edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0] > 0).all()  # counter-clockwise
    assert np.allclose(corners[:, 4:] - corners[:, :4], [[[0, 0, h]] * 4 for h in found["height"]])
    for of, box in zip(corners, found):
        inside = points[labels == box["label"]] - of[0]
        for edge in (of[1] - of[0], of[3] - of[0], of[4] - of[0]):
            along = inside @ edge / np.linalg.norm(edge)
            assert along.min() > -1e-4 and along.max() < np.linalg.norm(edge) + 1e-4


def test_organized_scans_float64_and_records_have_the_same_boxes():
    points, labels = scene()
    points, labels = points[: len(points) // 8 * 8], labels[: len(points) // 8 * 8]
    expected = lisco.boxes(points, labels)
    records = np.zeros(len(points), dtype=[("x", "f4"), ("i", "u1"), ("y", "f8"), ("z", "f4")])
    for axis, field in enumerate("xyz"):
        records[field] = points[:, axis]
    for form in (points.reshape(8, -1, 3), points.astype(np.float64).reshape(-1, 8, 3), records):
        for dtype in (np.int8, np.int64, np.uint64, ">i2"):
            positive = np.where(labels < 0, 99, labels) if dtype == np.uint64 else labels
            found = lisco.boxes(form, positive.astype(dtype).reshape(form.shape[:2] if form.ndim == 3 else -1))
            assert np.array_equal(found[found["label"] != 99], expected)


def test_labels_may_have_gaps_and_no_returns_are_left_out():
    points = np.array([[1, 0, 0], [np.nan, 1, 1], [0, 0, 0], [3, 0, 0], [1, 0, 0], [2, np.inf, 0]], dtype=np.float32)
    found = lisco.boxes(points, [10**15, 10**15, 10**15, 7, -3, 7])
    assert found["label"].tolist() == [7, 10**15] and found["size"].tolist() == [1, 1]
    assert found["density"].tolist() == [0, 0]
    assert len(lisco.boxes(points[1:3], [0, 1])) == 0
    empty = lisco.boxes(np.zeros((0, 3)), np.zeros(0, int))
    assert len(empty) == 0 and empty.dtype == found.dtype and lisco.corners(empty).shape == (0, 8, 3)


@given(
    points=hnp.arrays(np.float32, st.tuples(SIZES, st.just(3)), elements=st.floats(width=32)),
    modulus=st.integers(1, 5),
)
def test_any_points_have_boxes_that_hold_them(points, modulus):
    labels = np.arange(len(points)) % modulus - 1
    found = lisco.boxes(points, labels)
    is_return = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    assert found["label"].tolist() == sorted(set(labels[is_return & (labels >= 0)].tolist()))
    for box in found:
        members = points[is_return & (labels == box["label"])]
        assert box["size"] == len(members)
        assert np.array_equal(box["min"], members.min(axis=0)) and np.array_equal(box["max"], members.max(axis=0))
        assert box["length"] >= box["width"] >= 0 and box["height"] >= 0 and -np.pi / 2 <= box["yaw"] < np.pi / 2


@pytest.mark.parametrize(
    "labels, origin, message",
    [
        (np.zeros(4, int), (0, 0, 0), "labels must be of the shape of points"),
        (np.zeros((5, 1), int), (0, 0, 0), "labels must be of the shape of points"),
        (np.zeros(5), (0, 0, 0), "whole numbers"),
        (np.full(5, 2**63, np.uint64), (0, 0, 0), "less than 2\\^63"),
        (np.zeros(5, int), (0, 0), "x, y and z"),
        (np.zeros(5, int), (0, 0, np.nan), "finite"),
        (np.zeros(5, int), (1e300, 0, 0), "float32"),
        (np.zeros(5, int), 5, "x, y and z"),
    ],
)
def test_wrong_arguments_are_value_errors(labels, origin, message):
    with pytest.raises(ValueError, match=message):
        lisco.boxes(np.ones((5, 3)), labels, origin)


def test_corners_of_other_arrays_are_a_value_error():
    for wrong in (np.zeros((3, 3)), np.zeros(2, dtype=[("length", "f8")])):
        with pytest.raises(ValueError, match="what lisco.boxes returns"):
            lisco.corners(wrong)
