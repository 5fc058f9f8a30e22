# SPDX-License-Identifier: BSD-3-Clause
"""Clusters while a sensor turns, column by column."""

from typing import Any, List, NamedTuple, Optional, Sequence

import numpy as np

from . import _core
from ._checks import Array, axes_of, column_of, number_of, origin_of, sizes_of, tolerance_of


class ColumnClusterer:
    """Clusters one rotation column by column; labels may be asked for at any time.

    Parameters
    ----------
    tolerance, min_size, max_size
        See `lisco.cluster`.

    Examples
    --------
    >>> import numpy as np
    >>> clusterer = ColumnClusterer(tolerance=0.4)
    >>> clusterer.add_column(np.array([[5.0, 0, 0], [5, 0, 9]]))
    >>> clusterer.labels()
    array([[0],
           [1]], dtype=int32)
    >>> clusterer.add_column(np.array([[5.0, 0.1, 0], [5, 0.1, 3]]))
    >>> clusterer.labels()
    array([[0, 0],
           [1, 2]], dtype=int32)
    """

    def __init__(self, tolerance: float, min_size: int = 1, max_size: Optional[int] = None) -> None:
        self._columns = _core.Columns(tolerance_of(tolerance), *sizes_of(min_size, max_size))

    def begin(self) -> None:
        """Starts a new rotation and forgets the last one; keeps its memory."""
        self._columns.begin()

    def add_column(self, points: Any) -> None:
        """Adds what all lasers measured in one step.

        Parameters
        ----------
        points : array_like
            (lasers, 3 or more) in the same order of lasers, and as many, in each column of a rotation; see
            `lisco.cluster`.
        """
        axes = column_of(points)
        self._columns.add(axes.x, axes.y, axes.z)

    def add_columns(self, points: Any) -> None:
        """Adds several columns: an array of shape (lasers, columns, 3 or more)."""
        axes = axes_of(points)
        if len(axes.shape) != 2:
            raise ValueError(f"points must be an array of shape (lasers, columns, 3 or more), not {np.shape(points)}")
        self._columns.add(axes.x, axes.y, axes.z)

    def labels(self) -> Array:
        """Labels of all columns so far, of shape (lasers, columns): those of `lisco.cluster` for these columns."""
        return self._columns.labels()

    @property
    def cluster_count(self) -> int:
        """Number of clusters in the columns so far."""
        return self._columns.cluster_count

    @property
    def column_count(self) -> int:
        """Number of columns so far."""
        return self._columns.column_count


class EndlessCluster(NamedTuple):
    """A cluster of an endless stream, delivered when no later column can reach it."""

    points: Array
    """float32 (N, 3): its returns, metres."""
    columns: Array
    """int64 (N,): the number of each return's column, from 0."""
    lasers: Array
    """int32 (N,): each return's place in its column."""
    first_position: float
    """Of its first column, turns."""
    last_position: float
    """Of its last column, turns."""
    is_cut: bool
    """Whether it was delivered for having lasted a whole turn, perhaps before its end."""
    is_continued: bool
    """Whether it goes on from a cut one."""


class EndlessClusterer:
    """Clusters a stream without end; each cluster is delivered once, whole across the borders of rotations.

    Positions are turns of the sensor, counted from any moment. Memory is bounded by two turns.

    Parameters
    ----------
    tolerance, min_size, max_size
        See `lisco.cluster`.
    columns_per_turn : float, optional
        For columns that are added without a position.
    clockwise : bool
        Sense of rotation, seen from above.
    start_azimuth : float
        Of position 0, radians, counter-clockwise from the x axis.
    origin : sequence of 3 floats
        Position of the sensor, metres.
    stagger : float, optional
        Largest difference between the azimuths of a return and of its column, radians, 0 to pi / 8 (the default). A
        return beyond it is a cluster of its own.

    Examples
    --------
    >>> import numpy as np
    >>> clusterer = EndlessClusterer(tolerance=0.4, columns_per_turn=360)
    >>> clusters = []
    >>> for step in range(720):
    ...     azimuth = np.radians(step)
    ...     near = 100 <= step % 360 < 110
    ...     point = [5 * np.cos(azimuth), 5 * np.sin(azimuth), 0] if near else [0.0, 0, 0]
    ...     clusters += clusterer.add_column(np.array([point]))
    >>> [len(cluster.points) for cluster in clusters + clusterer.finish()]
    [10, 10]
    """

    def __init__(
        self,
        tolerance: float,
        min_size: int = 1,
        max_size: Optional[int] = None,
        *,
        columns_per_turn: Optional[float] = None,
        clockwise: bool = False,
        start_azimuth: float = 0.0,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        stagger: Optional[float] = None,
    ) -> None:
        low, high = sizes_of(min_size, max_size)
        per_turn = 0.0 if columns_per_turn is None else number_of(columns_per_turn, "columns_per_turn")
        if columns_per_turn is not None and per_turn <= 0:
            raise ValueError(f"columns_per_turn must be more than 0, not {columns_per_turn}")
        place = origin_of(origin)
        widest = _core.MAX_STAGGER if stagger is None else number_of(stagger, "stagger")
        if not 0 <= widest <= _core.MAX_STAGGER:
            raise ValueError(f"stagger must be 0 to {_core.MAX_STAGGER} radians, not {stagger}")
        start = number_of(start_azimuth, "start_azimuth")
        self._positions_known = per_turn > 0
        self._endless = _core.Endless(
            tolerance_of(tolerance), low, high, per_turn, bool(clockwise), start, place, widest
        )

    def add_column(self, points: Any, position: Optional[float] = None) -> List[EndlessCluster]:
        """Adds what all lasers measured in one step.

        Parameters
        ----------
        points : array_like
            (lasers, 3 or more); see `lisco.cluster`.
        position : float, optional
            Turns, not less than that of the column before; by default, the last one and 1 / columns_per_turn.

        Returns
        -------
        list of EndlessCluster
            Those that neither this column nor a later one can reach.
        """
        if position is None and not self._positions_known:
            raise ValueError("a column needs a position unless columns_per_turn is given")
        axes = column_of(points)
        turns = None if position is None else number_of(position, "position")
        return _clusters(self._endless.add(axes.x, axes.y, axes.z, turns))

    def update(self) -> List[EndlessCluster]:
        """Delivers what can be delivered now, without waiting for the next columns (up to 15)."""
        return _clusters(self._endless.update())

    def finish(self) -> List[EndlessCluster]:
        """Ends the stream: delivers all. More columns may follow; they are not compared with those before."""
        return _clusters(self._endless.finish())

    @property
    def columns_held(self) -> int:
        """Number of columns in memory."""
        return self._endless.columns_held


def _clusters(delivered: "List[_core.Cluster]") -> List[EndlessCluster]:
    return [
        EndlessCluster(c.points, c.columns, c.lasers, c.first_position, c.last_position, c.is_cut, c.is_continued)
        for c in delivered
    ]
