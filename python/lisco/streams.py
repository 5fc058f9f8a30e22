# SPDX-License-Identifier: BSD-3-Clause
"""Streams of columns, as generators."""

import os
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional, Tuple

import numpy as np

from ._checks import Array, count_of
from .clusterer import Clusterer
from .columns import ColumnClusterer, EndlessCluster, EndlessClusterer
from .reading import is_recording, open_packets, read


class Rotation(NamedTuple):
    """A rotation and its clusters."""

    points: Array
    """(lasers, columns, 3 or more): the columns' points side by side."""
    labels: Array
    """int32 (lasers, columns): 0 is the largest cluster and so on, -1 is no cluster."""


def stream(
    source: Any,
    tolerance: float,
    columns_per_rotation: Optional[int] = None,
    min_size: int = 1,
    max_size: Optional[int] = None,
    **recording: Any,
) -> Iterator[Rotation]:
    """Clusters rotation after rotation.

    Parameters
    ----------
    source : iterable of array_like, or path
        Columns, each of shape (lasers, 3 or more), as many lasers in each column of a rotation: they are clustered as
        they come. Or a recording: see `lisco.read`.
    tolerance, min_size, max_size
        See `lisco.cluster`.
    columns_per_rotation : int
        Of columns: after which a rotation ends. The last one may have fewer.
    **recording
        `sensor`, `calibration`, `metadata`, `topic` and `port` of `lisco.read`.

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
    if isinstance(source, (str, os.PathLike)):
        if columns_per_rotation is not None:
            raise ValueError("columns_per_rotation is of columns; a recording has rotations of its own")
        whole = Clusterer(tolerance, min_size, max_size)
        return (Rotation(points, whole.cluster(points)) for points in _scans(source, recording))
    if recording:
        raise ValueError(f"{', '.join(recording)}: only a recording has these")
    if columns_per_rotation is None:
        raise ValueError("a stream of columns needs columns_per_rotation")
    per_rotation = count_of(columns_per_rotation, "columns_per_rotation", least=1)
    return _rotations(source, ColumnClusterer(tolerance, min_size, max_size), per_rotation)


def _scans(source: Any, recording: Dict[str, Any]) -> Iterable[Array]:
    if os.path.exists(source) and not is_recording(source):
        raise ValueError(f"{os.fspath(source)}: is no recording")
    return read(source, **recording)


def _rotations(columns: Iterable[Any], clusterer: ColumnClusterer, per_rotation: int) -> Iterator[Rotation]:
    held: List[Array] = []
    for column in columns:
        clusterer.add_column(column)
        held.append(np.array(column))
        if len(held) == per_rotation:
            yield Rotation(np.stack(held, axis=1), clusterer.labels())
            held.clear()
            clusterer.begin()
    if held:
        yield Rotation(np.stack(held, axis=1), clusterer.labels())


def endless(
    source: Any,
    tolerance: float,
    columns_per_turn: Optional[float] = None,
    min_size: int = 1,
    max_size: Optional[int] = None,
    **sensor: Any,
) -> Iterator[EndlessCluster]:
    """Clusters a stream without rotations: yields each cluster as soon as no later column can reach it.

    Parameters
    ----------
    source : iterable of array_like, or path
        Columns, each of shape (lasers, 3 or more). Or a recording: see `lisco.read`.
    tolerance, min_size, max_size
        See `lisco.cluster`.
    columns_per_turn : float
        Of columns: those of a whole turn of the sensor.
    **sensor
        Of columns: `clockwise`, `start_azimuth`, `origin` and `stagger` of `EndlessClusterer`. Of a recording of
        packets: `sensor`, `calibration`, `metadata`, `topic` and `port` of `lisco.read`.

    Yields
    ------
    EndlessCluster
    """
    if isinstance(source, (str, os.PathLike)):
        if columns_per_turn is not None:
            raise ValueError("columns_per_turn is of columns; a recording has azimuths")
        packets = open_packets(source, **sensor)
        clusterer = EndlessClusterer(tolerance, min_size, max_size, clockwise=True, stagger=packets.stagger)
        placed = (
            (turn.points[:, column], position)
            for turn in packets.turns()
            for column, position in enumerate(turn.positions)
        )
        return _endless_clusters(placed, clusterer)
    if columns_per_turn is None:
        raise ValueError("a stream of columns needs columns_per_turn")
    clusterer = EndlessClusterer(tolerance, min_size, max_size, columns_per_turn=columns_per_turn, **sensor)
    return _endless_clusters(((column, None) for column in source), clusterer)


def _endless_clusters(
    columns: Iterable[Tuple[Any, Optional[float]]], clusterer: EndlessClusterer
) -> Iterator[EndlessCluster]:
    for column, position in columns:
        yield from clusterer.add_column(column, position)
    yield from clusterer.finish()
