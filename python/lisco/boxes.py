# SPDX-License-Identifier: BSD-3-Clause
"""Clusters as objects."""

from typing import Any, Sequence

import numpy as np

from . import _core
from ._checks import Array, axes_of, labels_of, origin_of


def boxes(points: Any, labels: Any, origin: Sequence[float] = (0.0, 0.0, 0.0)) -> Array:
    """Measures clusters: sizes, boxes, ranges.

    Parameters
    ----------
    points : array_like
        See `lisco.cluster`.
    labels : array_like of int
        Of shape (N,) or (H, W). Each value of 0 or more is a cluster, as in what `lisco.cluster` returns; no returns
        are left out.
    origin : sequence of 3 floats
        Position of the sensor, metres.

    Returns
    -------
    ndarray
        An element for each cluster, in the order of the labels, with these fields (metres and radians):

        label : int64
        size : int64, number of returns
        centroid : float64 (3,), their mean
        min, max : float32 (3,), the axis-aligned box; exact
        center : float64 (3,), of the oriented box: upright, turned about the z axis, around all returns
        length, width : float64, its horizontal sides, length >= width
        height : float64, along z
        yaw : float64, of the length, counter-clockwise from the x axis, -pi / 2 <= yaw < pi / 2
        nearest_range : float64, from the origin to the nearest return
        density : float64, returns per square metre of three adjacent sides of the oriented box

    Raises
    ------
    ValueError
        If points, labels or origin have another shape or type.

    See Also
    --------
    corners : the corners of these boxes.

    Examples
    --------
    >>> import numpy as np
    >>> points = np.array([[4, 1, 0], [6, 1, 0], [8, 1, 0], [4, 2, 1]], dtype=np.float32)
    >>> found = boxes(points, np.zeros(4, dtype=np.int32))
    >>> found[["label", "size", "length", "width", "height", "yaw"]].tolist()
    [(0, 4, 4.0, 1.0, 1.0, 0.0)]
    >>> found["center"][found["height"] > 0.5]
    array([[6. , 1.5, 0.5]])
    """
    axes = axes_of(points)
    return _core.boxes(axes.x, axes.y, axes.z, labels_of(labels, axes.shape), origin_of(origin))


def corners(boxes: Any) -> Array:
    """The corners of oriented boxes.

    Parameters
    ----------
    boxes : ndarray
        What `lisco.boxes` returns, or a part of it.

    Returns
    -------
    ndarray of float64
        (N, 8, 3), metres: the base counter-clockwise as seen from above, then the top likewise.

    Examples
    --------
    >>> import numpy as np
    >>> points = np.array([[4, 1, 0], [6, 1, 0], [8, 1, 0], [4, 2, 1]], dtype=np.float32)
    >>> corners(boxes(points, np.zeros(4, dtype=np.int32)))[0, :4]
    array([[4., 1., 0.],
           [8., 1., 0.],
           [8., 2., 0.],
           [4., 2., 0.]])
    """
    box = np.asarray(boxes)
    if box.dtype.names is None or not set(_core.BOX.names or ()) <= set(box.dtype.names):
        raise ValueError(f"boxes must be what lisco.boxes returns, not an array of {box.dtype}")
    box = box.reshape(-1, 1)
    along = box["length"] / 2 * np.array([-1, 1, 1, -1, -1, 1, 1, -1])
    across = box["width"] / 2 * np.array([-1, -1, 1, 1, -1, -1, 1, 1])
    up = box["height"] / 2 * np.array([-1, -1, -1, -1, 1, 1, 1, 1])
    sine, cosine = np.sin(box["yaw"]), np.cos(box["yaw"])
    offsets = np.stack([cosine * along - sine * across, sine * along + cosine * across, up], axis=2)
    found: Array = box["center"] + offsets
    return found
