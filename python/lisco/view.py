# SPDX-License-Identifier: BSD-3-Clause
"""Clusters in a browser or a notebook: the page of the programs."""

import html
import os
import uuid
from typing import Any, Optional

import numpy as np

from ._checks import Array, axes_of, labels_of, tolerance_of
from .boxes import boxes

_BEGINNING = 1000  # bytes of a file, in which a page has its signature


class View:
    """A page that shows a scan and its clusters; a notebook shows it in place.

    Attributes
    ----------
    page : str
        The page, HTML that loads nothing else.
    """

    def __init__(self, page: str) -> None:
        self.page = page

    def save(self, path: Any) -> None:
        """Writes the page, for a browser.

        Parameters
        ----------
        path : str or os.PathLike
            Such as view.html. An earlier page is replaced.

        Raises
        ------
        FileExistsError
            If there is a file that is no such page.
        """
        name = os.fspath(path)
        if os.path.lexists(name) and not _is_page(name):
            raise FileExistsError(f"{name}: exists, and is no page of lisco")
        temporary = f"{name}.{uuid.uuid4().hex}.tmp"
        try:
            with open(temporary, "w", encoding="utf-8", newline="") as file:
                file.write(self.page)
            os.replace(temporary, name)
        finally:
            if os.path.exists(temporary):
                os.remove(temporary)

    def __repr__(self) -> str:
        return f"<lisco.View: a page of {len(self.page)} characters; save(path) writes it>"

    def _repr_html_(self) -> str:
        style = "width: 100%; height: 600px; border: 0"
        return f'<iframe srcdoc="{html.escape(self.page)}" style="{style}" allowfullscreen></iframe>'


def view(
    points: Any,
    labels: Any,
    path: Any = None,
    *,
    ground: Any = None,
    intensity: Any = None,
    tolerance: Optional[float] = None,
    name: str = "scan",
    camera: bool = False,
) -> View:
    """Shows a scan and its clusters in three dimensions: the page `view.html` of the programs (doc/view.md).

    Parameters
    ----------
    points : array_like
        See `lisco.cluster`. Rows of an organized scan are shown as rings.
    labels : array_like of int
        Of shape (N,) or (H, W); each less than the number of points. The page numbers clusters from 1: label + 1.
    path : str or os.PathLike, optional
        File to write the page to, such as view.html. A file that is no such page is not replaced.
    ground : array_like of bool, optional
        Of the shape of labels: points on the ground, as `lisco.ground` returns them.
    intensity : array_like, optional
        Of the shape of labels.
    tolerance : float, optional
        Of the clusters, metres: shown beside distances that are measured.
    name : str
        Of the scan.
    camera : bool
        Points are in a camera's frame: z ahead and y down, instead of x ahead and z up.

    Returns
    -------
    View
        Which a notebook shows in place.

    Raises
    ------
    ValueError
        If arrays have another shape or type.
    FileExistsError
        If the path is that of another file.

    Examples
    --------
    >>> import numpy as np
    >>> points = np.random.default_rng(1).uniform(0, 1, size=(100, 3))
    >>> page = view(points, np.zeros(100, dtype=int), name="a cube").page
    >>> page[:15], page.count("http://"), page.count("https://")
    ('<!doctype html>', 0, 0)
    """
    module = _page_writer()
    axes = axes_of(points)
    label = labels_of(labels, axes.shape)
    count = label.size
    if count and label.max() >= count:
        raise ValueError(f"labels must be less than the number of points, {count}, not {label.max()}")
    found = boxes(points, label)
    table = np.zeros((int(found["label"].max()) + 1 if len(found) else 0, 9))
    sides = ("length", "width", "height", "yaw", "nearest_range")
    columns = [found["size"], *found["center"].T, *(found[side] for side in sides)]
    table[found["label"]] = np.stack(columns, axis=1)
    page = module.page(
        axes.x,
        axes.y,
        axes.z,
        (np.maximum(label, -1) + 1).astype(np.uint32).ravel(),
        table,
        _of_points(ground, axes.shape, "ground", np.uint8),
        _of_points(intensity, axes.shape, "intensity", np.float32),
        bool(camera),
        0.0 if tolerance is None else tolerance_of(tolerance),
        str(name).encode("utf-8", "replace").decode(),
    )
    shown = View(page)
    if path is not None:
        shown.save(path)
    return shown


def _of_points(values: Any, shape: Any, name: str, dtype: Any) -> Array:
    """An element for each point, or none."""
    if values is None:
        return np.empty(0, dtype)
    array = np.asarray(values)
    if array.shape != shape:
        raise ValueError(f"{name} must be of the shape of points, {shape}, not {array.shape}")
    if array.dtype.kind not in "biuf":
        raise ValueError(f"{name} must be numbers, not {array.dtype}")
    if dtype is np.uint8:
        array = array != 0
    with np.errstate(over="ignore", invalid="ignore"):
        return np.ascontiguousarray(array.astype(dtype)).ravel()


def _is_page(path: str) -> bool:
    signature = _page_writer().SIGNATURE.encode()
    try:
        with open(path, "rb") as file:
            return signature in file.read(_BEGINNING)
    except OSError:
        return False


def _page_writer() -> Any:
    try:
        from . import _view
    except ImportError as error:
        raise ImportError(f"this build of lisco writes no pages: zlib or nlohmann-json was missing ({error})") from None
    return _view
