# SPDX-License-Identifier: BSD-3-Clause
"""Streams of columns, as generators."""

from typing import Any, Iterable, Iterator, List, NamedTuple, Optional

import numpy as np

from ._checks import count_of
from .columns import ColumnClusterer, EndlessCluster, EndlessClusterer


class Rotation(NamedTuple):
    """A rotation and its clusters."""

    points: np.ndarray
    """(lasers, columns, 3 or more): the columns' points side by side."""
    labels: np.ndarray
    """int32 (lasers, columns): 0 is the largest cluster and so on, -1 is no cluster."""


def stream(
    columns: Iterable[Any],
    tolerance: float,
    columns_per_rotation: int,
    min_size: int = 1,
    max_size: Optional[int] = None,
) -> Iterator[Rotation]:
    """Clusters rotation after rotation, each while its columns come.

    Parameters
    ----------
    columns : iterable of array_like
        Each of shape (lasers, 3 or more), as many lasers in each column of a rotation.
    tolerance, min_size, max_size
        See `lisco.cluster`.
    columns_per_rotation : int
        Columns after which a rotation ends. The last one may have fewer.

    Yields
    ------
    Rotation

    Examples
    --------
    >>> import numpy as np
    >>> columns = ([[5.0, 0.1 * step, 0]] for step in range(6))
    >>> for rotation in stream(columns, tolerance=0.4, columns_per_rotation=4):
    ...     print(rotation.points.shape, rotation.labels)
    (1, 4, 3) [[0 0 0 0]]
    (1, 2, 3) [[0 0]]
    """
    per_rotation = count_of(columns_per_rotation, "columns_per_rotation", least=1)
    clusterer = ColumnClusterer(tolerance, min_size, max_size)

    def rotations() -> Iterator[Rotation]:
        held: List[np.ndarray] = []
        for column in columns:
            clusterer.add_column(column)
            held.append(np.array(column))
            if len(held) == per_rotation:
                yield Rotation(np.stack(held, axis=1), clusterer.labels())
                held.clear()
                clusterer.begin()
        if held:
            yield Rotation(np.stack(held, axis=1), clusterer.labels())

    return rotations()


def endless(
    columns: Iterable[Any],
    tolerance: float,
    columns_per_turn: float,
    min_size: int = 1,
    max_size: Optional[int] = None,
    **sensor: Any,
) -> Iterator[EndlessCluster]:
    """Clusters a stream without rotations: yields each cluster as soon as no later column can reach it.

    Parameters
    ----------
    columns : iterable of array_like
        Each of shape (lasers, 3 or more).
    tolerance, min_size, max_size
        See `lisco.cluster`.
    columns_per_turn : float
        Columns of a whole turn of the sensor.
    **sensor
        `clockwise`, `start_azimuth`, `origin` and `stagger` of `EndlessClusterer`.

    Yields
    ------
    EndlessCluster
    """
    clusterer = EndlessClusterer(tolerance, min_size, max_size, columns_per_turn=columns_per_turn, **sensor)

    def clusters() -> Iterator[EndlessCluster]:
        for column in columns:
            yield from clusterer.add_column(column)
        yield from clusterer.finish()

    return clusters()
