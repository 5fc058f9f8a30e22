# SPDX-License-Identifier: BSD-3-Clause
"""Arguments as the engine expects them, or an error that says what is wrong and what is wanted."""

import math
import operator
from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Tuple

import numpy as np

if TYPE_CHECKING:
    Array = np.ndarray[Any, np.dtype[Any]]
else:
    Array = np.ndarray  # which older versions cannot subscript

MAX_POINTS = 2**31 - 1
NO_LIMIT = 2**64 - 1
WANTED = "an array of shape (N, 3 or more) or (H, W, 3 or more), or of records with fields x, y and z"


class Axes(NamedTuple):
    """The coordinates of points, as views of two axes: rows and columns."""

    x: Array
    y: Array
    z: Array
    shape: Tuple[int, ...]  # of the points, as given


def _float_view(values: Array, name: str) -> Array:
    if values.dtype.kind != "f" or values.dtype.itemsize not in (4, 8):
        raise ValueError(f"{name} must be float32 or float64, not {values.dtype}; points.astype(np.float32) converts")
    return values if values.dtype.isnative else values.astype(values.dtype.newbyteorder("="))


def axes_of(points: Any, name: str = "points") -> Axes:
    """The coordinates of points, without copying what is native float32 or float64."""
    if isinstance(points, np.ma.MaskedArray):
        raise ValueError(f"{name} must not be a masked array; points.filled(np.nan) makes no returns of what is masked")
    array = np.asarray(points)
    if array.dtype.names is not None:
        missing = [field for field in "xyz" if field not in array.dtype.names]
        if missing or array.ndim not in (1, 2):
            raise ValueError(f"{name} must be {WANTED}, not of shape {array.shape} with fields {array.dtype.names}")
        fields = [array[field] for field in "xyz"]
        if any(field.shape != array.shape for field in fields):
            raise ValueError(f"the fields x, y and z of {name} must be single numbers")
        shape = array.shape
    else:
        if array.ndim not in (2, 3) or array.shape[-1] < 3:
            raise ValueError(f"{name} must be {WANTED}, not of shape {array.shape}")
        array = _float_view(array, name)
        fields = [array[..., axis] for axis in range(3)]
        shape = array.shape[:-1]
    if math.prod(shape) > MAX_POINTS:
        raise ValueError(f"{name} must be fewer than 2^31, not {math.prod(shape)}")
    x, y, z = (_float_view(field, name).reshape(shape) for field in fields)
    if len(shape) == 1:
        x, y, z = x[np.newaxis], y[np.newaxis], z[np.newaxis]
    return Axes(x, y, z, shape)


def labels_of(labels: Any, shape: Tuple[int, ...]) -> Array:
    """Labels of points of a shape, int64."""
    label = np.asarray(labels)
    if label.shape != shape:
        raise ValueError(f"labels must be of the shape of points, {shape}, not {label.shape}")
    if label.dtype.kind not in "iu":
        raise ValueError(f"labels must be whole numbers, not {label.dtype}")
    if label.dtype.kind == "u" and label.size and label.max() >= 2**63:
        raise ValueError(f"labels must be less than 2^63, not {label.max()}")
    return np.ascontiguousarray(label.astype(np.int64, copy=False)).reshape(shape)


def column_of(points: Any) -> Axes:
    """The coordinates of one column: its points as rows."""
    axes = axes_of(points, "a column's points")
    if len(axes.shape) != 1:
        raise ValueError(f"a column must be an array of shape (lasers, 3 or more), not {np.shape(points)}")
    return Axes(axes.x.T, axes.y.T, axes.z.T, axes.shape)


def _float_of(value: Any) -> float:
    """NaN if it is no number."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def number_of(value: Any, name: str) -> float:
    """A finite number."""
    number = _float_of(value)
    if not math.isfinite(number):
        raise ValueError(f"{name} must be a finite number, not {value!r}")
    return number


def origin_of(origin: Any) -> List[float]:
    """x, y and z, finite numbers that a float32 can hold."""
    try:
        place = [number_of(value, "origin") for value in origin]
    except TypeError:
        raise ValueError(f"origin must be x, y and z, not {origin!r}") from None
    if len(place) != 3:
        raise ValueError(f"origin must be x, y and z, not {len(place)} numbers")
    if any(abs(value) > np.finfo(np.float32).max for value in place):
        raise ValueError(f"origin must be numbers that a float32 can hold, not {origin!r}")
    return place


def tolerance_of(tolerance: Any) -> float:
    """A distance in metres that a float32 can hold."""
    number = _float_of(tolerance)
    if not 0 <= number <= np.finfo(np.float32).max:
        raise ValueError(f"tolerance must be a finite number of metres, 0 or more, not {tolerance!r}")
    return number


def count_of(value: Any, name: str, least: int = 0) -> int:
    """A whole number, `least` or more."""
    try:
        count = operator.index(value)
    except TypeError:
        raise ValueError(f"{name} must be a whole number, not {value!r}") from None
    if count < least:
        raise ValueError(f"{name} must be {least} or more, not {value}")
    return min(count, NO_LIMIT)


def sizes_of(min_size: Any, max_size: Optional[Any]) -> Tuple[int, int]:
    """The smallest and the largest size of a cluster."""
    low = count_of(min_size, "min_size")
    high = NO_LIMIT if max_size is None else count_of(max_size, "max_size")
    if low > high:
        raise ValueError(f"min_size must not exceed max_size, but {low} > {high}")
    return low, high
