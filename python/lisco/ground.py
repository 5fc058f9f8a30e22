# SPDX-License-Identifier: BSD-3-Clause
"""The ground in a scan."""

from typing import Any, Optional

import numpy as np

from . import _core
from ._checks import Array, axes_of, number_of


def ground(points: Any, sensor_height: Optional[float] = None, max_slope: float = 17.0) -> Array:
    """Which points lie on the ground.

    Parameters
    ----------
    points : array_like
        A scan, z up to within about 10 degrees and the sensor near x = y = 0; see `lisco.cluster` for shapes. Of an
        organized scan, rows are lasers. An unorganized one is sorted by azimuth first.
    sensor_height : float, optional
        Of the sensor above the ground beneath it, metres; by default estimated from the points.
    max_slope : float
        Steepest ground, degrees, 1 to 60.

    Returns
    -------
    ndarray of bool
        Of shape (N,) or (H, W); False for no returns.

    Examples
    --------
    >>> import numpy as np
    >>> azimuth, range_ = np.meshgrid(np.radians(np.arange(0, 360, 2)), np.arange(4.0, 20, 0.5))
    >>> flat = np.stack([range_ * np.cos(azimuth), range_ * np.sin(azimuth), np.full_like(range_, -1.7)], axis=2)
    >>> scan = np.concatenate([flat, flat + [0, 0, 1.5]])  # the ground, and what is above it
    >>> mask = ground(scan, sensor_height=1.7)
    >>> bool(mask[:32].all()), bool(mask[32:].any())
    (True, False)
    """
    height = np.nan if sensor_height is None else number_of(sensor_height, "sensor_height")
    slope = number_of(max_slope, "max_slope")
    if not 1 <= slope <= 60:
        raise ValueError(f"max_slope must be 1 to 60 degrees, not {max_slope}")
    axes = axes_of(points)
    return _core.ground(axes.x, axes.y, axes.z, height, slope).astype(bool).reshape(axes.shape)


def remove_ground(points: Any, sensor_height: Optional[float] = None, max_slope: float = 17.0) -> Array:
    """A copy of a scan whose ground points are no returns: their x, y and z are NaN.

    The shape stays, so that labels of the result are labels of the scan.

    Parameters
    ----------
    points, sensor_height, max_slope
        See `ground`.

    Returns
    -------
    ndarray
        Of the shape and type of `points`.
    """
    mask = ground(points, sensor_height, max_slope)
    left = np.array(points)
    if left.dtype.names is None:
        left[mask, :3] = np.nan
    else:
        for field in "xyz":
            left[field][mask] = np.nan
    return left
