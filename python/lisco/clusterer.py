# SPDX-License-Identifier: BSD-3-Clause
"""Clusters of whole scans."""

from typing import Any, Optional

from . import _core
from ._checks import Array, axes_of, count_of, sizes_of, tolerance_of

_MAX_THREADS = 256


class Clusterer:
    """Clusters scan after scan, as `cluster` does, and keeps its memory between them.

    Parameters
    ----------
    tolerance, min_size, max_size, threads
        See `cluster`.

    Notes
    -----
    Several Python threads may share a clusterer: their calls wait for each other. With a clusterer each they run side
    by side, since the global interpreter lock is released while points are clustered.

    Examples
    --------
    >>> import numpy as np
    >>> clusterer = Clusterer(tolerance=0.4, min_size=2)
    >>> for shift in (0, 100):
    ...     print(clusterer.cluster(np.array([[1.0, 0, 0], [1.1, 0, 0], [9, 0, 0]]) + shift))
    [ 0  0 -1]
    [ 0  0 -1]
    """

    def __init__(self, tolerance: float, min_size: int = 1, max_size: Optional[int] = None, threads: int = 1) -> None:
        self._tolerance = tolerance_of(tolerance)
        self._min_size, self._max_size = sizes_of(min_size, max_size)
        self._threads = min(count_of(threads, "threads"), _MAX_THREADS)
        self._labeller = _core.Labeller()

    def cluster(self, points: Any) -> Array:
        """Labels the points of a scan; see `lisco.cluster`.

        Parameters
        ----------
        points : array_like
            The points of a scan, metres.

        Returns
        -------
        ndarray of int32
            Labels of shape (N,) or (H, W).
        """
        axes = axes_of(points)
        labels = self._labeller.label(
            axes.x, axes.y, axes.z, self._tolerance, self._min_size, self._max_size, self._threads
        )
        return labels.reshape(axes.shape)


def cluster(
    points: Any, tolerance: float, min_size: int = 1, max_size: Optional[int] = None, threads: int = 1
) -> Array:
    """Labels points by their Euclidean clusters.

    Two points are neighbours if they are less than `tolerance` apart, computed in float32 as PCL does: squared
    distances are compared, d2 < tolerance2. Clusters are the connected components.

    Parameters
    ----------
    points : array_like
        float32 or float64 of shape (N, 3 or more), or (H, W, 3 or more) for an organized scan, whose rows are lasers
        and whose columns are firings: x, y, z in metres, further values are ignored. Or records with fields x, y and z.
        Any strides; nothing is copied unless the byte order is foreign. float64 is rounded to float32. Points with a
        NaN or infinite coordinate, and points at exactly (0, 0, 0), are no returns.
    tolerance : float
        Metres, 0 or more.
    min_size, max_size : int
        Clusters of fewer or more points get no label.
    threads : int
        Threads that share the work; 0: one for each core. The labels do not depend on it.

    Returns
    -------
    ndarray of int32
        Of shape (N,) or (H, W). 0 is the largest cluster and so on, in the order of PCL's vector of clusters; -1 is no
        cluster.

    Raises
    ------
    ValueError
        If points have another shape or type, or are 2^31 or more, or a parameter is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> scan = np.array([[[1, 0, 0], [1.1, 0, 0]], [[0, 0, 0], [5, 0, 0]]], dtype=np.float32)
    >>> cluster(scan, 0.4)
    array([[ 0,  0],
           [-1,  1]], dtype=int32)
    """
    return Clusterer(tolerance, min_size, max_size, threads).cluster(points)
