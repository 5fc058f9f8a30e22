# SPDX-License-Identifier: BSD-3-Clause
"""What a worker does: clusters the scans of a piece, and publishes the results all at once."""

import io
import json
import os
import shutil
import uuid
import zipfile
from typing import Any, Dict, Iterator, List, Optional

import numpy as np

from .._checks import Array
from ..clusterer import Clusterer
from ..ground import remove_ground
from ..reading import RecordedScan, read, recorded_scans, sensors
from .memory import keep_memory
from .pieces import Piece, Settings, canonical

LABELS, CLUSTERS, REPORT = "labels.npz", "clusters.npy", "piece.json"
ROW = np.dtype(
    [("scan", "<i4"), ("cluster", "<i4"), ("size", "<i8")]
    + [(f"centroid_{axis}", "<f8") for axis in "xyz"]
    + [(f"{end}_{axis}", "<f4") for end in ("min", "max") for axis in "xyz"]
)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # of all members of the archives of labels


def write_whole(path: str, content: str) -> None:
    """Writes a file under a temporary name, then renames it."""
    temporary = f"{path}.{uuid.uuid4().hex}.tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise


def prepare() -> None:
    """Loads the readers, which takes some tenths of a second."""
    try:
        sensors()
    except ImportError:
        pass  # each input says so


def report_of(out: str, piece: Piece) -> Optional[Dict[str, Any]]:
    """The report of a piece that is complete, without failures; None if it is not."""
    report = published(out, piece)
    return report if report is not None and not report["failures"] else None


def published(out: str, piece: Piece) -> Optional[Dict[str, Any]]:
    """The report of a piece, with or without failures; None if there is none."""
    try:
        with open(os.path.join(out, "pieces", piece.name, REPORT), encoding="utf-8") as file:
            report: Dict[str, Any] = json.load(file)
            return report
    except FileNotFoundError:
        return None


def count_rotations(file: str, settings: Settings) -> int:
    """Scans of a recording, up to where it breaks off; 0 if it cannot be read."""
    count = 0
    try:
        for _ in recorded_scans(file, **settings.recording()):
            count += 1
    except (ValueError, FileNotFoundError):
        pass  # reported by the last piece
    return count


def do_piece(out: str, piece: Piece, settings: Settings) -> Dict[str, Any]:
    """Clusters a piece, unless its results are there, and returns its report. May run on several workers at once."""
    done = report_of(out, piece)
    if done is not None:
        return done
    keep_memory()
    final = os.path.join(out, "pieces", piece.name)
    temporary = f"{final}.{uuid.uuid4().hex}.tmp"
    os.mkdir(temporary)
    try:
        report = _write_results(temporary, piece, settings)
        _publish(temporary, final)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    return report


def _publish(temporary: str, final: str) -> None:
    """Renames a folder. One that is there already stays if it is complete, and is replaced if it has failures."""
    for _ in range(100):
        try:
            os.rename(temporary, final)
            return
        except OSError:
            if not os.path.isdir(final):
                raise
        with open(os.path.join(final, REPORT), encoding="utf-8") as file:
            if not json.load(file)["failures"]:
                return
        old = f"{final}.{uuid.uuid4().hex}.tmp"
        try:
            os.rename(final, old)
        except FileNotFoundError:
            continue  # another worker was faster
        shutil.rmtree(old, ignore_errors=True)
    raise OSError(f"{final}: cannot be replaced")


def _scans(piece: Piece, settings: Settings) -> Iterator[RecordedScan]:
    """The scans of a piece, one at a time; those that cannot be read as errors."""
    if not piece.is_recording:
        for file in piece.files:
            try:
                yield RecordedScan(file, 0.0, np.asarray(read(file)), "")
            except (ValueError, FileNotFoundError) as error:
                yield RecordedScan(file, 0.0, None, str(error))
        return
    (file,) = piece.files
    try:
        for number, scan in enumerate(recorded_scans(file, **settings.recording())):
            if number >= piece.first + piece.count and not piece.is_last:
                return
            if piece.first <= number < piece.first + piece.count:
                yield scan
    except (ValueError, FileNotFoundError) as error:
        yield RecordedScan(file, 0.0, None, str(error))


def _write_results(folder: str, piece: Piece, settings: Settings) -> Dict[str, Any]:
    clusterer = Clusterer(settings.tolerance, settings.min_size, settings.max_size)
    scans: List[Dict[str, Any]] = []
    failures: List[str] = []
    rows: List[Array] = []
    with zipfile.ZipFile(os.path.join(folder, LABELS), "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, seconds, points, error in _scans(piece, settings):
            if points is None:
                failures.append(error)
                continue
            labels = _cluster(clusterer, points, settings)
            number = len(scans)
            member = zipfile.ZipInfo(f"{number:06d}.npy", _EPOCH)
            member.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(member, "w", force_zip64=True) as file:
                np.lib.format.write_array(file, labels, allow_pickle=False)  # type: ignore[no-untyped-call]
            found = measure(points, labels, number)
            rows.append(found)
            scans.append({"name": name, "time": seconds, "points": int(labels.size), "clusters": len(found)})
    with open(os.path.join(folder, CLUSTERS), "wb") as table:
        content = io.BytesIO()  # of a file on a full disk, NumPy does not say why it cannot be written
        np.save(content, np.concatenate([np.empty(0, ROW)] + rows))
        table.write(content.getbuffer())
    report = {"scans": scans, "failures": failures}
    write_whole(os.path.join(folder, REPORT), canonical(report))
    return report


def _cluster(clusterer: Clusterer, points: Array, settings: Settings) -> Array:
    if settings.remove_ground:
        points = remove_ground(points)
    if settings.ground_z is not None:
        with np.errstate(invalid="ignore"):
            low = points[..., 2] < settings.ground_z
        points = np.array(points)
        points[low] = np.nan
    return clusterer.cluster(points)


def measure(points: Array, labels: Array, scan: int) -> Array:
    """A row of ROW for each cluster. Sums are taken in the order of the points: equal on every machine."""
    xyz = points.reshape(-1, points.shape[-1])[:, :3].astype(np.float32, copy=False)
    label = labels.ravel()
    clustered = np.flatnonzero(label >= 0)
    order = clustered[np.argsort(label[clustered], kind="stable")]
    count = int(label[order[-1]]) + 1 if len(order) else 0
    rows = np.zeros(count, ROW)
    if count == 0:
        return rows
    sizes = np.bincount(label[order], minlength=count)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    rows["scan"], rows["cluster"], rows["size"] = scan, np.arange(count), sizes
    for axis, name in enumerate("xyz"):
        values = xyz[order, axis]
        rows[f"centroid_{name}"] = np.bincount(label[order], weights=values, minlength=count) / sizes
        rows[f"min_{name}"] = np.minimum.reduceat(values, starts)
        rows[f"max_{name}"] = np.maximum.reduceat(values, starts)
    return rows
