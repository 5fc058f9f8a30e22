# SPDX-License-Identifier: BSD-3-Clause
"""Columns while the sensor turns."""

import lisco
import numpy as np
import oracles
import pytest

LASERS, STEPS = 8, 360


def turn(rng, steps=STEPS, turns=1.0):
    """Columns (steps, LASERS, 3) of a room with objects, turning counter-clockwise."""
    azimuths = 2 * np.pi * turns * np.arange(steps) / steps
    ranges = 6 + 4 * np.floor(3 * np.sin(5 * azimuths))[:, np.newaxis] * rng.choice([1, 1.02], (steps, LASERS))
    ranges = np.where(rng.random((steps, LASERS)) < 0.1, 0, np.abs(ranges) + 1)
    elevations = np.radians(np.linspace(10, -10, LASERS))
    directions = np.stack(
        [
            np.cos(azimuths)[:, np.newaxis] * np.cos(elevations),
            np.sin(azimuths)[:, np.newaxis] * np.cos(elevations),
            np.broadcast_to(np.sin(elevations), (steps, LASERS)),
        ],
        axis=2,
    )
    return (ranges[..., np.newaxis] * directions).astype(np.float32)


def test_labels_are_those_of_the_scan_so_far(rng):
    columns = turn(rng)
    clusterer = lisco.ColumnClusterer(0.5, min_size=2, max_size=300)
    assert clusterer.labels().shape == (0, 0)
    for step, column in enumerate(columns):
        clusterer.add_column(column)
        if step % 60 == 7 or step == STEPS - 1:
            scan = columns[: step + 1].transpose(1, 0, 2)
            labels = clusterer.labels()
            assert np.array_equal(labels, lisco.cluster(scan, 0.5, 2, 300))
            assert clusterer.cluster_count == labels.max() + 1
    assert clusterer.column_count == STEPS


def test_columns_together_are_columns_one_by_one(rng):
    scan = turn(rng).transpose(1, 0, 2)
    clusterer = lisco.ColumnClusterer(0.5)
    clusterer.add_columns(scan[:, :100])
    clusterer.add_columns(scan[:, 100:100])
    for column in range(100, 200):
        clusterer.add_column(scan[:, column])
    clusterer.add_columns(scan[:, 200:])
    assert np.array_equal(clusterer.labels(), lisco.cluster(scan, 0.5))


def test_begin_forgets_the_rotation(rng):
    clusterer = lisco.ColumnClusterer(0.5)
    clusterer.add_columns(turn(rng).transpose(1, 0, 2))
    clusterer.begin()
    assert clusterer.column_count == clusterer.cluster_count == 0
    clusterer.add_column([[1.0, 2.0, 3.0]])  # of another size
    assert clusterer.labels().tolist() == [[0]]


def test_columns_of_different_sizes_are_a_value_error():
    clusterer = lisco.ColumnClusterer(0.5)
    clusterer.add_column(np.ones((4, 3)))
    with pytest.raises(ValueError, match="a column of 3 points follows columns of 4"):
        clusterer.add_column(np.ones((3, 3)))
    with pytest.raises(ValueError, match=r"a column must be an array of shape \(lasers, 3 or more\)"):
        clusterer.add_column(np.ones((4, 1, 3)))
    with pytest.raises(ValueError, match="points must be an array of shape"):
        clusterer.add_columns(np.ones((4, 3)))
    assert clusterer.column_count == 1


def test_streams_yield_rotations(rng):
    columns = turn(rng, 2 * STEPS + 10, 2.0)
    rotations = list(lisco.stream(iter(columns), 0.5, columns_per_rotation=STEPS, min_size=3))
    assert [rotation.labels.shape for rotation in rotations] == [(LASERS, STEPS), (LASERS, STEPS), (LASERS, 10)]
    for number, rotation in enumerate(rotations):
        scan = columns[number * STEPS : (number + 1) * STEPS].transpose(1, 0, 2)
        assert np.array_equal(rotation.points, scan)
        assert np.array_equal(rotation.labels, lisco.cluster(scan, 0.5, 3))


def test_streams_check_arguments_at_once():
    for arguments in ({"columns_per_rotation": 0}, {"columns_per_rotation": 5, "min_size": -1}):
        with pytest.raises(ValueError):
            lisco.stream([], 0.5, **arguments)
    with pytest.raises(ValueError):
        lisco.endless([], 0.5, columns_per_turn=0)


def test_endless_clusters_are_those_of_all_columns_within_half_a_turn(rng):
    columns = turn(rng, STEPS // 3, 1 / 3)  # less than half a turn: each pair of returns is compared
    clusters = list(lisco.endless(columns, 0.5, columns_per_turn=STEPS))
    labels = np.full((len(columns), LASERS), -1)
    for number, cluster in enumerate(clusters):
        assert (labels[cluster.columns, cluster.lasers] == -1).all()
        labels[cluster.columns, cluster.lasers] = number
        assert np.array_equal(cluster.points, columns[cluster.columns, cluster.lasers])
        assert cluster.first_position == pytest.approx(cluster.columns.min() / STEPS)
        assert cluster.last_position == pytest.approx(cluster.columns.max() / STEPS)
    assert oracles.same_partition(labels, oracles.brute_force(columns.reshape(-1, 3), 0.5))


def test_endless_clusters_hold_each_return_of_many_turns_once(rng):
    turns = 12
    columns = turn(rng, turns * STEPS, turns)
    clusterer = lisco.EndlessClusterer(0.5, columns_per_turn=STEPS)
    counts = np.zeros(columns.shape[:2], dtype=int)
    clusters, most_held = [], 0
    for column in columns:
        clusters += clusterer.add_column(column)
        most_held = max(most_held, clusterer.columns_held)
    before_finish = len(clusters)
    clusters += clusterer.finish()
    for cluster in clusters:
        np.add.at(counts, (cluster.columns, cluster.lasers), 1)
        assert np.array_equal(cluster.points, columns[cluster.columns, cluster.lasers])
    assert np.array_equal(counts, (columns != 0).any(axis=2))
    assert before_finish > len(clusters) / 2  # delivered while the stream goes on
    assert most_held < 2 * STEPS


def test_endless_positions_may_jump(rng):
    columns = turn(rng)
    clusterer = lisco.EndlessClusterer(0.5)
    clusters, position = [], 0.0
    for step, column in enumerate(columns):
        position += 1 / STEPS + (100.25 if step % 40 == 39 else 0)
        clusters += clusterer.add_column(column, position)
    clusters += clusterer.finish()
    assert sum(len(cluster.points) for cluster in clusters) == (columns != 0).any(axis=2).sum()
    for cluster in clusters:
        assert np.array_equal(cluster.points, columns[cluster.columns, cluster.lasers])


def test_endless_columns_may_have_any_number_of_lasers(rng):
    clusterer = lisco.EndlessClusterer(0.5, columns_per_turn=100)
    sizes = rng.integers(0, 5, size=1000)
    clusters = []
    for size in sizes:
        clusters += clusterer.add_column(np.full((size, 3), 3.0))
    clusters += clusterer.finish()
    assert sum(len(cluster.points) for cluster in clusters) == sizes.sum()


def test_endless_arguments_are_checked():
    for wrong in (
        {"columns_per_turn": -1},
        {"columns_per_turn": np.nan},
        {"origin": (1, 2)},
        {"origin": (1, 2, np.inf)},
        {"origin": 5},
        {"stagger": 1},
        {"start_azimuth": np.inf},
        {"start_azimuth": 1e9},
    ):
        with pytest.raises(ValueError):
            lisco.EndlessClusterer(0.4, **wrong)
    clusterer = lisco.EndlessClusterer(0.4)
    with pytest.raises(ValueError, match="needs a position"):
        clusterer.add_column(np.ones((4, 3)))
    clusterer.add_column(np.ones((4, 3)), 1.0)
    for position in (0.5, np.nan, 1e13):
        with pytest.raises(ValueError):
            clusterer.add_column(np.ones((4, 3)), position)
    assert sum(len(cluster.points) for cluster in clusterer.finish()) == 4
