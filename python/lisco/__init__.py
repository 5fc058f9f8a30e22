# SPDX-License-Identifier: BSD-3-Clause
"""Euclidean clusters of LiDAR scans, exactly those of PCL's EuclideanClusterExtraction.

>>> import numpy as np, lisco
>>> points = np.array([[1, 0, 0], [1.1, 0, 0], [9, 0, 0]], dtype=np.float32)
>>> lisco.cluster(points, tolerance=0.4)
array([0, 0, 1], dtype=int32)

Points with a NaN or infinite coordinate, and points at exactly (0, 0, 0), are no returns: they are in no cluster.
"""

from ._core import __version__
from .boxes import boxes, corners
from .clusterer import Clusterer, cluster
from .columns import ColumnClusterer, EndlessCluster, EndlessClusterer
from .ground import ground, remove_ground
from .plot import plot
from .reading import read, sensors
from .streams import Rotation, endless, stream
from .view import View, view

__all__ = [
    "Clusterer",
    "ColumnClusterer",
    "EndlessCluster",
    "EndlessClusterer",
    "Rotation",
    "View",
    "__version__",
    "boxes",
    "cluster",
    "corners",
    "endless",
    "ground",
    "plot",
    "read",
    "remove_ground",
    "sensors",
    "stream",
    "view",
]
