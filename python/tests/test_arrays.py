# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of any layout, and those that are no points."""

import lisco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.lib.stride_tricks import as_strided

SCAN = np.random.default_rng(2).uniform(-3, 3, size=(8, 50, 3)).astype(np.float32)
LABELS = lisco.cluster(SCAN, 0.7)


def padded(dtype):
    wide = np.full((8, 50, 7), 99, dtype=dtype)
    wide[..., 2:5] = SCAN
    return wide[..., 2:5]


def unaligned():
    raw = bytearray(1 + SCAN.nbytes)
    raw[1:] = SCAN.tobytes()
    return np.frombuffer(raw, dtype=np.float32, count=SCAN.size, offset=1).reshape(SCAN.shape)


def read_only():
    scan = SCAN.copy()
    scan.flags.writeable = False
    return scan


def records(*types):
    scan = np.zeros((8, 50), dtype=list(zip(("intensity", "z", "ring", "x", "y"), types)))
    for axis, field in enumerate("xyz"):
        scan[field] = SCAN[..., axis]
    return scan


LAYOUTS = {
    "float32": SCAN,
    "float64": SCAN.astype(np.float64),
    "columns first in memory": np.asfortranarray(SCAN),
    "reversed twice": SCAN[::-1, ::-1].copy()[::-1, ::-1],
    "every other": np.repeat(SCAN, 2, axis=1)[:, ::2],
    "padded float32": padded(np.float32),
    "padded float64": padded(np.float64),
    "transposed": np.ascontiguousarray(SCAN.transpose(1, 0, 2)).transpose(1, 0, 2),
    "coordinates first": np.ascontiguousarray(np.moveaxis(SCAN, 2, 0)).transpose(1, 2, 0),
    "unaligned": unaligned(),
    "read-only": read_only(),
    "big-endian": SCAN.astype(">f4"),
    "big-endian float64": SCAN.astype(">f8"),
    "records": records("f4", "f4", "u2", "f4", "f4"),
    "records of mixed types": records("u1", "f8", "u1", "f4", ">f4"),
    "nested lists": SCAN.astype(np.float64).tolist(),
    "four values": np.concatenate([SCAN, np.full((8, 50, 1), np.nan, np.float32)], axis=2),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layout_does_not_affect_labels(layout):
    labels = lisco.cluster(LAYOUTS[layout], 0.7)
    assert labels.dtype == np.int32 and labels.flags.writeable
    assert np.array_equal(labels, LABELS)


@pytest.mark.parametrize("layout", [name for name in LAYOUTS if "lists" not in name])
def test_native_arrays_are_not_copied(layout):
    from lisco._checks import axes_of

    points = LAYOUTS[layout]
    if "endian" in layout or "mixed" in layout:
        return
    axes = axes_of(points)
    assert all(np.shares_memory(axis, points) for axis in (axes.x, axes.y, axes.z))


def test_input_is_unchanged():
    scan = SCAN.copy()
    lisco.cluster(scan, 0.7)
    assert np.array_equal(scan, SCAN)


@pytest.mark.parametrize("shape", [(0, 3), (0, 5, 3), (5, 0, 3), (0, 0, 4)])
def test_empty_arrays_have_empty_labels(shape):
    assert lisco.cluster(np.empty(shape), 0.4).shape == shape[:-1]


def test_float64_is_rounded_to_float32():
    points = np.array([[1e8, 0, 0], [1e8 + 1, 0, 0], [1e300, 1, 1]])
    assert lisco.cluster(points, 0.5).tolist() == [0, 0, -1]  # equal as float32; infinite as float32


def test_no_returns_have_no_label():
    points = np.array([[0, 0, 0], [-0.0, 0, 0], [np.nan, 1, 1], [1, np.inf, 1], [1, 1, -np.inf], [1e-30, 0, 0]])
    assert lisco.cluster(points, 1.0).tolist() == [-1, -1, -1, -1, -1, 0]


def test_broadcast_points_share_a_cluster():
    assert lisco.cluster(np.broadcast_to(np.float32([1, 2, 3]), (1000, 3)), 0.1).tolist() == [0] * 1000


WRONG_POINTS = {
    "one axis": np.zeros(3),
    "four axes": np.zeros((2, 2, 2, 3)),
    "two values": np.zeros((5, 2)),
    "no axis": np.float32(1),
    "whole numbers": np.zeros((5, 3), dtype=np.int64),
    "half precision": np.zeros((5, 3), dtype=np.float16),
    "long double": np.zeros((5, 3), dtype=np.longdouble),
    "complex": np.zeros((5, 3), dtype=complex),
    "bool": np.zeros((5, 3), dtype=bool),
    "objects": np.zeros((5, 3), dtype=object),
    "text": np.full((5, 3), "1"),
    "a word": "points",
    "none": None,
    "masked": np.ma.masked_array(np.zeros((5, 3)), mask=True),
    "records without z": np.zeros(5, dtype=[("x", "f4"), ("y", "f4")]),
    "records of whole numbers": np.zeros(5, dtype=[("x", "i4"), ("y", "i4"), ("z", "i4")]),
    "records of vectors": np.zeros(5, dtype=[("x", "f4", 2), ("y", "f4", 2), ("z", "f4", 2)]),
    "records of three axes": np.zeros((1, 1, 1), dtype=[("x", "f4"), ("y", "f4"), ("z", "f4")]),
    "too many": as_strided(np.zeros(3, np.float32), shape=(2**31, 3), strides=(0, 4)),
    "too many cells": as_strided(np.zeros(3, np.float32), shape=(2**20, 2**20, 3), strides=(0, 0, 4)),
}


@pytest.mark.parametrize("what", WRONG_POINTS)
@pytest.mark.parametrize("add", ["cluster", "column", "endless"])
def test_what_is_no_points_is_a_value_error(what, add):
    points = WRONG_POINTS[what]
    with pytest.raises(ValueError, match="must|lisco"):
        if add == "cluster":
            lisco.cluster(points, 0.4)
        elif add == "column":
            lisco.ColumnClusterer(0.4).add_column(points)
        else:
            lisco.EndlessClusterer(0.4, columns_per_turn=100).add_column(points)


def test_ragged_lists_are_a_value_error():
    with pytest.raises(ValueError):
        lisco.cluster([[1.0, 2.0, 3.0], [1.0]], 0.4)


@pytest.mark.parametrize("tolerance", [-0.1, np.nan, np.inf, 1e39, -np.inf])
def test_tolerance_is_checked(tolerance):
    with pytest.raises(ValueError, match="tolerance must be a finite number of metres"):
        lisco.cluster(SCAN, tolerance)


@pytest.mark.parametrize(
    "arguments", [{"min_size": -1}, {"max_size": -1}, {"threads": -1}, {"min_size": 3, "max_size": 2}]
)
def test_counts_are_checked(arguments):
    with pytest.raises(ValueError, match="must"):
        lisco.cluster(SCAN, 0.4, **arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        {"tolerance": "a"},
        {"tolerance": None},
        {"tolerance": 10**400},
        {"min_size": 1.5},
        {"threads": None},
        {"max_size": "3"},
    ],
)
def test_types_are_checked(arguments):
    with pytest.raises(ValueError, match=f"{next(iter(arguments))} must be a (finite|whole) number"):
        lisco.cluster(SCAN, **{"tolerance": 0.4, **arguments})


def test_huge_counts_are_no_limits():
    assert np.array_equal(lisco.cluster(SCAN, 0.7, min_size=0, max_size=10**30, threads=10**30), LABELS)
    assert (lisco.cluster(SCAN, 0.7, min_size=10**30) == -1).all()


@settings(max_examples=200)
@given(
    array=hnp.arrays(
        st.one_of(hnp.floating_dtypes(), hnp.integer_dtypes(), hnp.boolean_dtypes(), hnp.complex_number_dtypes()),
        hnp.array_shapes(min_dims=1, max_dims=4, min_side=0, max_side=6),
    )
)
def test_any_array_has_labels_or_a_value_error(array):
    try:
        labels = lisco.cluster(array, 0.4)
    except ValueError:
        return
    assert labels.shape == array.shape[:-1] and labels.dtype == np.int32
