# SPDX-License-Identifier: BSD-3-Clause
"""An archive, cut into pieces of work whose results do not depend on each other."""

import dataclasses
import json
import os
from typing import Any, Dict, Iterator, List, Optional, Tuple

from ..reading import is_recording, results_and_clouds

STATE = "archive.json"  # of an archive's results, in their folder
MOST_PIECES_OF_A_RECORDING = 8  # each reads the recording from its beginning


@dataclasses.dataclass(frozen=True)
class Settings:
    """How scans are read and clustered."""

    tolerance: float
    min_size: int
    max_size: Optional[int]
    ground_z: Optional[float]
    remove_ground: bool
    sensor: Optional[str]
    calibration: Optional[str]
    metadata: Optional[str]
    topic: Optional[str]
    port: Optional[int]
    piece: int  # scans of a piece

    def recording(self) -> Dict[str, Any]:
        """The arguments of `lisco.read` for recordings."""
        return {
            "sensor": self.sensor,
            "calibration": self.calibration,
            "metadata": self.metadata,
            "topic": self.topic,
            "port": self.port,
        }


@dataclasses.dataclass(frozen=True)
class Piece:
    """Scan files, or whole rotations of a recording."""

    number: int
    files: Tuple[str, ...]  # one, if it is a recording
    is_recording: bool
    first: int = 0  # rotation
    count: int = 0  # of rotations
    is_last: bool = False  # of the recording: reads it to its end

    @property
    def name(self) -> str:
        """Of its results."""
        return f"{self.number:08d}"

    @property
    def scans(self) -> int:
        """Number of scans, if all can be read."""
        return self.count if self.is_recording else len(self.files)


def expand(inputs: List[str]) -> List[str]:
    """Files as given, and those in folders and the folders in them, sorted by name.

    Raises
    ------
    ValueError
        If an input does not exist, or a folder holds no scans.
    """
    files: List[str] = []
    for given in inputs:
        path = os.path.abspath(given)
        if not os.path.exists(path):
            raise ValueError(f"{given}: does not exist")
        if os.path.isdir(path) and not is_recording(path):
            found = list(_inside(path))
            if not found:
                raise ValueError(f"{given}: holds no scans or recordings")
            files += found
        else:
            files.append(path)
    return list(dict.fromkeys(files))


def _inside(folder: str) -> Iterator[str]:
    """Scans and recordings in a folder, by their endings; a bag's folder is one recording.

    Results of `lisco_cluster` and of this program are none, nor are tables.
    """
    if os.path.exists(os.path.join(folder, STATE)):
        return
    results, clouds = results_and_clouds(folder)
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        if entry.name.startswith(".") or entry.name in results:
            continue
        if is_recording(entry.path):
            yield entry.path
        elif entry.is_dir():
            yield from _inside(entry.path)
        elif entry.name in clouds:
            yield entry.path


def identity(files: List[str], settings: Settings) -> Dict[str, Any]:
    """What results depend on: the settings, and each file's path, size and time of change."""
    parts = [
        part
        for file in files
        for part in (sorted(entry.path for entry in os.scandir(file)) if os.path.isdir(file) else [file])
    ]
    states = [(part, os.stat(part)) for part in parts]
    return {
        "settings": dataclasses.asdict(settings),
        "files": [[part, state.st_size, state.st_mtime_ns] for part, state in states],
    }


def cut(files: List[str], rotations: Dict[str, int], settings: Settings) -> Iterator[Piece]:
    """The pieces of an archive: files in groups, and recordings into equal parts.

    Parameters
    ----------
    files : list of str
        See `expand`.
    rotations : dict
        Number of rotations of each recording that can be read.
    settings : Settings
    """
    number = 0
    group: List[str] = []
    for file in files + [""]:  # the end of the last group
        if group and (not file or is_recording(file) or len(group) == settings.piece):
            yield Piece(number, tuple(group), is_recording=False)
            number += 1
            group = []
        if file and not is_recording(file):
            group.append(file)
        elif file:
            total = rotations[file]
            parts = max(1, min(MOST_PIECES_OF_A_RECORDING, -(-total // settings.piece)))
            ends = [total * (part + 1) // parts for part in range(parts)]
            for part, end in enumerate(ends):
                first = ends[part - 1] if part else 0
                yield Piece(number, (file,), True, first, end - first, part == parts - 1)
                number += 1


def canonical(value: Any) -> str:
    """JSON that is equal for equal values."""
    return json.dumps(value, sort_keys=True, indent=1) + "\n"
