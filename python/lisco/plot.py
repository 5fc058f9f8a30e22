# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of clusters, by matplotlib."""

from typing import Any, Optional

import numpy as np

from ._checks import Array, axes_of, labels_of, number_of
from .boxes import corners

GREY = "0.75"


def _colors(number: Array) -> Array:
    """Colours that differ clearly from those before and after: hues a golden section of the circle apart."""
    from matplotlib.colors import hsv_to_rgb

    hue = number * (np.sqrt(5) - 1) / 2 % 1
    rgb: Array = hsv_to_rgb(np.stack([hue, 0.65 + 0.35 * (number % 2), 0.9 - 0.25 * (number // 2 % 2)], axis=1))
    return rgb


def plot(points: Any, labels: Any, boxes: Any = None, ax: Any = None, extent: Optional[float] = None) -> Any:
    """Draws the top view of a scan: a colour for each cluster, grey for points in none.

    Parameters
    ----------
    points : array_like
        See `lisco.cluster`.
    labels : array_like of int
        Of shape (N,) or (H, W).
    boxes : ndarray, optional
        What `lisco.boxes` returns; drawn as outlines.
    ax : matplotlib.axes.Axes, optional
        To draw on; by default a new figure's.
    extent : float, optional
        Metres from the origin to each border of the picture; by default all points are in it.

    Returns
    -------
    matplotlib.axes.Axes
    """
    axes = axes_of(points)
    label = labels_of(labels, axes.shape)
    if extent is not None and number_of(extent, "extent") <= 0:
        raise ValueError(f"extent must be more than 0, not {extent}")
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.figure(figsize=(7, 7), constrained_layout=True).add_subplot()
    label = label.ravel()
    x, y = axes.x.ravel(), axes.y.ravel()
    shown = np.isfinite(x) & np.isfinite(y) & ((x != 0) | (y != 0))
    alone = shown & (label < 0)
    clustered = shown & (label >= 0)
    ax.scatter(x[alone], y[alone], s=1, color=GREY, linewidths=0, rasterized=True)
    if clustered.any():
        colors = _colors(label[clustered])
        ax.scatter(x[clustered], y[clustered], s=2, c=colors, linewidths=0, rasterized=True)
    if boxes is not None:
        for base in corners(boxes)[:, [0, 1, 2, 3, 0], :2]:
            ax.plot(*base.T, color="black", linewidth=0.8)
    ax.set_aspect("equal")
    if extent is not None:
        ax.set_xlim(-extent, extent)
        ax.set_ylim(-extent, extent)
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")
    return ax
