# SPDX-License-Identifier: BSD-3-Clause
"""The ground filter on arrays."""

import lisco
import numpy as np
import pytest


@pytest.fixture(scope="module")
def scene():
    """A scan (32, 900, 3) of a flat ground 1.8 m below the sensor with four pillars, and which returns are pillars'."""
    azimuths = 2 * np.pi * np.arange(900) / 900
    elevations = np.radians(np.linspace(5, -25, 32))[:, np.newaxis]
    ground = np.where(elevations < -0.02, 1.8 / np.tan(np.maximum(-elevations, 1e-3)), 0) * np.ones(900)
    pillar = np.ones((32, 1)) * (np.abs(np.sin(2 * azimuths)) < 0.1) * 8.0
    is_pillar = (pillar > 0) & ((ground == 0) | (ground > pillar))
    rho = np.where(is_pillar, pillar, ground)
    z = rho * np.tan(elevations)
    return np.stack([rho * np.cos(azimuths), rho * np.sin(azimuths), z], axis=2).astype(np.float32), is_pillar


@pytest.mark.parametrize("height", [None, 1.8])
def test_ground_is_told_from_pillars(scene, height):
    scan, is_pillar = scene
    mask = lisco.ground(scan, sensor_height=height)
    is_return = (scan != 0).any(axis=2)
    assert mask.dtype == bool and mask.shape == is_pillar.shape
    assert mask[is_return & ~is_pillar].mean() > 0.98
    assert mask[is_pillar & (scan[..., 2] > -1.4)].mean() < 0.01
    assert not mask[~is_return].any()


def test_order_of_points_is_free(scene, rng):
    points = scene[0].reshape(-1, 3)
    mask = lisco.ground(points)
    order = rng.permutation(len(points))
    assert (lisco.ground(points[order]) == mask[order]).mean() > 0.99
    assert (mask == lisco.ground(scene[0]).ravel()).mean() > 0.97


def test_removed_points_are_no_returns(scene):
    scan = np.concatenate([scene[0], np.ones((32, 900, 1), np.float32)], axis=2)
    left = lisco.remove_ground(scan)
    mask = lisco.ground(scan)
    assert np.isnan(left[mask, :3]).all() and (left[..., 3] == 1).all()
    assert np.array_equal(left[~mask], scan[~mask])
    records = np.zeros((32, 900), dtype=[("x", "f4"), ("y", "f4"), ("z", "f4")])
    for axis, field in enumerate("xyz"):
        records[field] = scan[..., axis]
    assert np.array_equal(np.isnan(lisco.remove_ground(records)["z"]), mask)
    assert not np.isnan(records["x"]).any()


def test_pillars_are_clusters_without_the_ground(scene):
    labels = lisco.cluster(lisco.remove_ground(scene[0]), 0.8, min_size=20)
    assert labels.max() + 1 == 4


@pytest.mark.parametrize("shape", [(0, 3), (0, 5, 3), (5, 0, 3), (1, 3), (1, 1, 3)])
def test_small_scans_have_a_mask(shape):
    assert lisco.ground(np.ones(shape)).shape == shape[:-1]


@pytest.mark.parametrize("arguments", [{"sensor_height": np.inf}, {"max_slope": 0}, {"max_slope": 61}])
def test_arguments_are_checked(scene, arguments):
    with pytest.raises(ValueError, match="must"):
        lisco.ground(scene[0], **arguments)
