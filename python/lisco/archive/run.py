# SPDX-License-Identifier: BSD-3-Clause
"""A run over an archive: what is missing is made, then the table is merged."""

import contextlib
import fcntl
import glob
import json
import os
import shutil
import sys
import time
from typing import Any, Dict, List, NamedTuple, TextIO

from ..reading import is_recording
from . import pieces as cutting
from .pieces import STATE, Piece, Settings, canonical
from .table import merge
from .work import count_rotations, do_piece, report_of, write_whole

COUNTS, LOCK = "rotations.json", ".lock"


class Summary(NamedTuple):
    """What a run has made."""

    scans: int
    clusters: int
    failures: List[str]
    seconds: float


class Progress:
    """A line on a terminal, or one every half minute: scans done, rate, time left."""

    _INTERVAL = 30.0  # seconds

    def __init__(self, total: int, stream: TextIO) -> None:
        self._total, self._stream = total, stream
        self._start = self._shown = time.monotonic()
        self._done = self._before = 0

    def add(self, scans: int, is_new: bool) -> None:
        """Counts the scans of a piece; those of a run before do not count for the rate."""
        self._done += scans
        self._before += 0 if is_new else scans
        is_terminal = self._stream.isatty()
        now = time.monotonic()
        if now - self._shown < (0.2 if is_terminal else self._INTERVAL):
            return
        self._shown = now
        rate = (self._done - self._before) / max(now - self._start, 1e-9)
        left = (self._total - self._done) / rate if rate > 0 else 0
        line = f"{self._done} of {self._total} scans, {rate:.1f} per second, {left:.0f} s left"
        self._stream.write(f"\r\033[K{line}" if is_terminal else f"{line}\n")
        self._stream.flush()

    def clear(self) -> None:
        """Empties the line."""
        if self._stream.isatty():
            self._stream.write("\r\033[K")


class Locked:
    """Holds an output folder, so that a second run on it ends at once."""

    def __init__(self, out: str) -> None:
        self._file = open(os.path.join(out, LOCK), "w", encoding="utf-8")
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._file.close()
            raise ValueError(f"{out}: another run is writing into it") from None

    def __enter__(self) -> "Locked":
        return self

    def __exit__(self, *_: Any) -> None:
        self._file.close()


def run(
    inputs: List[str], out: str, settings: Settings, executor: Any, stream: TextIO = sys.stderr, table: bool = True
) -> Summary:
    """Clusters all scans of the inputs into a folder; goes on where an earlier run stopped.

    Parameters
    ----------
    inputs, out, settings
        Paths, the folder, and how scans are read and clustered.
    executor
        Of `lisco.archive.executors`.
    stream
        For the progress.
    table
        Merge the tables of the pieces into one.

    Raises
    ------
    ValueError
        If an input or the folder cannot be used.
    OSError
        If results cannot be written, or the scheduler is lost.
    """
    start = time.monotonic()
    files = cutting.expand(inputs)
    _claim(out)
    with Locked(out):
        _check_state(out, cutting.identity(files, settings))
        _remove_temporary(out)
        plan = list(cutting.cut(files, _counts(out, files, settings, executor), settings))
        done: Dict[int, Dict[str, Any]] = {}
        for piece in plan:
            earlier = report_of(out, piece)
            if earlier is not None:
                done[piece.number] = earlier
        progress = Progress(sum(piece.scans for piece in plan), stream)
        failures: Dict[int, List[str]] = {}
        scans = sum(len(report["scans"]) for report in done.values())
        clusters = sum(map(_clusters, done.values()))
        progress.add(scans, is_new=False)
        missing = [(out, piece, settings) for piece in plan if piece.number not in done]
        for number, report in executor.map(_numbered, missing):
            scans += len(report["scans"])
            clusters += _clusters(report)
            progress.add(len(report["scans"]), is_new=True)
            if report["failures"]:
                failures[number] = report["failures"]
        progress.clear()
        if table:
            merge(out, plan)
        _remove_temporary(out)
    lines = [line for number in sorted(failures) for line in failures[number]]
    return Summary(scans, clusters, lines, time.monotonic() - start)


def _clusters(report: Dict[str, Any]) -> int:
    return sum(int(scan["clusters"]) for scan in report["scans"])


def _numbered(out: str, piece: Piece, settings: Settings) -> Any:
    return piece.number, do_piece(out, piece, settings)


def _counted(file: str, settings: Settings) -> Any:
    return file, count_rotations(file, settings)


def _counts(out: str, files: List[str], settings: Settings, executor: Any) -> Dict[str, int]:
    """Rotations of each recording, counted once."""
    path = os.path.join(out, COUNTS)
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            known: Dict[str, int] = json.load(file)
            return known
    recordings = [(file, settings) for file in files if is_recording(file)]
    counts = dict(executor.map(_counted, recordings))
    write_whole(path, canonical(counts))
    return counts


def _claim(out: str) -> None:
    """Makes the folder, or takes one that is empty or holds a run's results."""
    if os.path.isdir(out) and not os.path.exists(os.path.join(out, STATE)) and set(os.listdir(out)) - {LOCK}:
        raise ValueError(f"{out}: holds files that no run has made")
    if os.path.exists(out) and not os.path.isdir(out):
        raise ValueError(f"{out}: is no folder")
    os.makedirs(out, exist_ok=True)


def _check_state(out: str, identity: Dict[str, Any]) -> None:
    path = os.path.join(out, STATE)
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            before = json.load(file)
        now = json.loads(canonical(identity))
        if before["settings"] != now["settings"]:
            raise ValueError(f"{out}: holds results of other settings: {before['settings']}")
        if before["files"] != now["files"]:
            raise ValueError(f"{out}: holds results of other inputs, or inputs have changed since")
    else:
        write_whole(path, canonical(identity))
    os.makedirs(os.path.join(out, "pieces"), exist_ok=True)


def _remove_temporary(out: str) -> None:
    """What killed workers have left."""
    for path in glob.glob(os.path.join(glob.escape(out), "**", "*.tmp"), recursive=True):
        if os.path.isdir(path):
            shutil.rmtree(path, ignore_errors=True)
        else:
            with contextlib.suppress(FileNotFoundError):  # was in a folder that is gone already
                os.remove(path)
