# SPDX-License-Identifier: BSD-3-Clause
"""Clusters by independent implementations, and how to compare them."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def is_return(points):
    """Which points are returns, of float32 (N, 3)."""
    return np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)


def brute_force(points, tolerance):
    """Component of each point: pairs with d2 < tolerance2, in float32, in the order of PCL's sum."""
    with np.errstate(over="ignore"):
        points = np.asarray(points, dtype=np.float32)
    tolerance = np.float32(tolerance)
    labels = np.full(len(points), -1)
    valid = np.flatnonzero(is_return(points))
    with np.errstate(over="ignore", invalid="ignore"):
        limit = np.float32(np.float64(tolerance) * np.float64(tolerance))
        d = points[valid, np.newaxis] - points[np.newaxis, valid]
        squared = (d[..., 0] * d[..., 0] + d[..., 1] * d[..., 1]) + d[..., 2] * d[..., 2]
    labels[valid] = connected_components(squared < limit, directed=False)[1]
    return labels


def kd_tree(points, tolerance):
    """Component of each point by SciPy's kd-tree: pairs at most the tolerance apart, in float64."""
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    return connected_components(graph, directed=False)[1]


def dbscan(points, tolerance):
    """Component of each point by scikit-learn: pairs at most the tolerance apart, in float64."""
    from sklearn.cluster import DBSCAN

    return DBSCAN(eps=tolerance, min_samples=1, algorithm="kd_tree").fit(points).labels_


def margin(points, tolerance):
    """Smallest relative difference between a pair's distance and the tolerance, of pairs within twice the tolerance."""
    points = np.asarray(points, dtype=np.float64)
    pairs = cKDTree(points).query_pairs(2 * tolerance, output_type="ndarray")
    if len(pairs) == 0:
        return np.inf
    distances = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    return np.abs(distances / tolerance - 1).min()


def same_partition(a, b):
    """Whether two labellings have the same clusters, and the same points in none (-1)."""
    a, b = np.asarray(a).ravel(), np.asarray(b).ravel()
    if not np.array_equal(a == -1, b == -1):
        return False
    pairs = np.unique(np.stack([a, b]), axis=1)
    return len(np.unique(pairs[0])) == pairs.shape[1] == len(np.unique(pairs[1]))


def keep_sizes(labels, min_size, max_size):
    """-1 instead of labels of clusters of fewer or more points."""
    labels = np.array(labels)
    values, inverse, counts = np.unique(labels, return_inverse=True, return_counts=True)
    wrong = (counts < min_size) | (counts > max_size)
    labels[wrong[inverse.reshape(labels.shape)]] = -1
    return labels
