# SPDX-License-Identifier: BSD-3-Clause
from typing import Any, List, Optional, Sequence

import numpy as np

from ._checks import Array

__version__: str
BOX: np.dtype[Any]
MAX_STAGGER: float

def simd_level() -> str: ...

def ground(
    x: Array, y: Array, z: Array, sensor_height: float, max_slope: float
) -> Array: ...

def boxes(
    x: Array, y: Array, z: Array, labels: Array, origin: Sequence[float]
) -> Array: ...

class Labeller:
    def __init__(self) -> None: ...
    def label(
        self,
        x: Array,
        y: Array,
        z: Array,
        tolerance: float,
        min_size: int,
        max_size: int,
        threads: int,
    ) -> Array: ...

class Columns:
    def __init__(self, tolerance: float, min_size: int, max_size: int) -> None: ...
    def begin(self) -> None: ...
    def add(self, x: Array, y: Array, z: Array) -> None: ...
    def labels(self) -> Array: ...
    @property
    def cluster_count(self) -> int: ...
    @property
    def column_count(self) -> int: ...

class Cluster:
    @property
    def points(self) -> Array: ...
    @property
    def columns(self) -> Array: ...
    @property
    def lasers(self) -> Array: ...
    @property
    def first_position(self) -> float: ...
    @property
    def last_position(self) -> float: ...
    @property
    def is_cut(self) -> bool: ...
    @property
    def is_continued(self) -> bool: ...

class Endless:
    def __init__(
        self,
        tolerance: float,
        min_size: int,
        max_size: int,
        columns_per_turn: float,
        clockwise: bool,
        start_azimuth: float,
        origin: Sequence[float],
        stagger: float,
    ) -> None: ...
    def add(self, x: Array, y: Array, z: Array, position: Optional[float]) -> List[Cluster]: ...
    def update(self) -> List[Cluster]: ...
    def finish(self) -> List[Cluster]: ...
    @property
    def columns_held(self) -> int: ...
