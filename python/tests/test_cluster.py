# SPDX-License-Identifier: BSD-3-Clause
"""Clusters against independent implementations."""

import threading

import lisco
import numpy as np
import oracles
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp


def clumps(rng, count, dtype=np.float64):
    """Points in clumps, so that clusters have all sizes."""
    centers = rng.uniform(-20, 20, size=(max(1, count // 12), 3))
    return (centers[rng.integers(len(centers), size=count)] + rng.normal(0, 0.3, size=(count, 3))).astype(dtype)


@pytest.mark.parametrize("tolerance", [0.05, 0.2, 0.4, 1.0, 5.0])
def test_clusters_are_those_of_all_pairs(rng, tolerance):
    points = clumps(rng, 700)
    points[rng.random(700) < 0.05] = 0
    points[rng.random(700) < 0.05, 1] = np.nan
    labels = lisco.cluster(points, tolerance)
    assert oracles.same_partition(labels, oracles.brute_force(points, tolerance))


@pytest.mark.parametrize("oracle", [oracles.dbscan, oracles.kd_tree])
@pytest.mark.parametrize("tolerance", [0.1, 0.4, 1.0])
def test_clusters_are_those_of_scikit_learn_and_scipy(rng, oracle, tolerance):
    """They join pairs at distance <= tolerance in float64, Lisco at < tolerance in float32: no pair is that near it."""
    points = clumps(rng, 3000, np.float32)
    assert oracles.margin(points, tolerance) > 1e-6
    assert oracles.same_partition(lisco.cluster(points, tolerance), oracle(points, tolerance))


@pytest.mark.parametrize("tolerance", [0.1, 0.3])
def test_clusters_of_a_kitti_rotation_are_those_of_scipy(kitti, tolerance):
    """Clusters of pairs < tolerance lie between those of SciPy for a tolerance a little smaller and a little larger."""
    labels = lisco.cluster(kitti, tolerance)
    below, above = (oracles.kd_tree(kitti[:, :3], tolerance * scale) for scale in (1 - 1e-5, 1 + 1e-5))
    assert len(np.unique(np.stack([below, labels]), axis=1).T) == below.max() + 1  # each is part of one cluster
    assert len(np.unique(np.stack([labels, above]), axis=1).T) == labels.max() + 1


def test_a_pair_at_the_tolerance_is_apart_where_scikit_learn_joins_it():
    points = np.array([[1, 0, 0], [1.5, 0, 0]], dtype=np.float32)
    assert lisco.cluster(points, 0.5).tolist() == [0, 1]  # d2 < tolerance2
    assert oracles.dbscan(points, 0.5).tolist() == [0, 0]  # d <= tolerance
    assert lisco.cluster(points, np.nextafter(np.float32(0.5), np.float32(1))).tolist() == [0, 0]


@pytest.mark.parametrize("sizes", [(1, None), (2, None), (3, 20), (1, 1), (5, 5)])
def test_sizes_bound_clusters(rng, sizes):
    points = clumps(rng, 900)
    expected = oracles.keep_sizes(oracles.brute_force(points, 0.3), sizes[0], sizes[1] or len(points))
    assert oracles.same_partition(lisco.cluster(points, 0.3, *sizes), expected)


def test_labels_are_numbered_by_size(rng):
    labels = lisco.cluster(clumps(rng, 2000), 0.2, min_size=2)
    counts = np.bincount(labels[labels >= 0])
    assert (np.diff(counts) <= 0).all() and counts[0] > counts[-1] > 0


@pytest.mark.parametrize("threads", [0, 2, 3, 1000])
def test_labels_do_not_depend_on_threads(rng, threads):
    scan = clumps(rng, 64 * 1000).reshape(64, 1000, 3)
    assert np.array_equal(lisco.cluster(scan, 0.05, threads=threads), lisco.cluster(scan, 0.05))


def test_an_organized_scan_has_the_labels_of_its_points(rng):
    scan = clumps(rng, 16 * 100).reshape(16, 100, 3)
    labels = lisco.cluster(scan, 0.3)
    assert labels.shape == (16, 100)
    assert np.array_equal(labels.ravel(), lisco.cluster(scan.reshape(-1, 3), 0.3))


def test_a_clusterer_has_the_labels_of_single_calls(rng):
    clusterer = lisco.Clusterer(0.3, min_size=2)
    for count in (1000, 10, 0, 2000):
        points = clumps(rng, count)
        assert np.array_equal(clusterer.cluster(points), lisco.cluster(points, 0.3, 2))


def test_threads_share_a_clusterer(rng):
    scans = [clumps(rng, count) for count in (500, 1500, 2500)]
    clusterer = lisco.Clusterer(0.3)
    expected = [lisco.cluster(scan, 0.3) for scan in scans]
    wrong = []

    def work(place):
        for _ in range(30):
            if not np.array_equal(clusterer.cluster(scans[place]), expected[place]):
                wrong.append(place)

    threads = [threading.Thread(target=work, args=(place,)) for place in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


@settings(max_examples=150)
@given(
    points=hnp.arrays(
        st.sampled_from([np.float32, np.float64]),
        st.tuples(st.integers(0, 40), st.integers(3, 5)),
        elements=st.one_of(
            st.floats(-2, 2, width=32),
            st.sampled_from([0.0, -0.0, 1.0, np.nan, np.inf, -np.inf, 2.0**127, -(2.0**127)]),
        ),
    ),
    tolerance=st.one_of(st.floats(0, 2), st.sampled_from([0.5, 1.0, 1e-30, 1e30])),
)
def test_any_points_have_the_clusters_of_all_pairs(points, tolerance):
    assert oracles.same_partition(lisco.cluster(points, tolerance), oracles.brute_force(points[:, :3], tolerance))
