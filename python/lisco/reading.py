# SPDX-License-Identifier: BSD-3-Clause
"""Scans on file, by the readers of the programs."""

import os
from typing import Any, Iterator, List, NamedTuple, Optional, Set, Tuple, Union

from ._checks import Array


class RecordedScan(NamedTuple):
    """A scan of a recording, or why it cannot be read."""

    name: str
    time: float
    """Seconds since 1970."""
    points: Optional[Array]
    """None if the scan cannot be read."""
    error: str
    """One line; empty if the scan can be read."""


class Packets:
    """The turns of a sensor whose packets are in a recording."""

    def __init__(self, path: str, reading: Any) -> None:
        try:
            self._capture = _readers().Capture(path, reading)
        except RuntimeError as error:
            raise ValueError(str(error)) from None
        self._path = path

    @property
    def stagger(self) -> float:
        """Largest difference between the azimuths of a return and of its column, radians."""
        return float(self._capture.stagger)

    def turns(self) -> Iterator[Any]:
        """Turns with points (lasers, columns, 4), azimuths (degrees clockwise), positions (turns) and a time."""
        while True:
            try:
                turn = self._capture.next()
            except RuntimeError as error:
                raise ValueError(str(error)) from None
            if turn is None:
                break
            yield turn
        if self._capture.data_packets == 0:
            raise ValueError(f"{self._path}: no packets of this sensor")


def _readers() -> Any:
    try:
        from . import _reading
    except ImportError as error:
        raise ImportError(f"this build of lisco reads no files: it was made without the programs ({error})") from None
    return _reading


def _existing(path: Any) -> str:
    name = os.fspath(path)
    if not isinstance(name, str):
        raise TypeError(f"a path must be a string or a pathlib.Path, not {type(name).__name__}")
    if not os.path.exists(name):
        raise FileNotFoundError(f"{name}: does not exist")
    return name


def sensors() -> List[str]:
    """The sensors whose packets can be read."""
    return list(_readers().sensors())


def is_recording(path: Any) -> bool:
    """Whether a path is a recording of many scans: a capture (pcap, pcapng), or a bag (db3, mcap, bag, or a folder)."""
    name = os.fspath(path)
    return bool(_readers().is_capture(name) or _readers().is_recording(name))


def results_and_clouds(folder: str) -> Tuple[Set[str], Set[str]]:
    """Names of what `lisco_cluster` has written into a folder, and of the clouds that it would read there."""
    try:
        clouds = _readers().cloud_files_in(folder)
    except RuntimeError as error:
        raise ValueError(str(error)) from None
    return {name.split("/")[0] for name in _readers().results_in(folder)}, {os.path.basename(file) for file in clouds}


def _reading(sensor: Optional[str], calibration: Any, metadata: Any, topic: Optional[str], port: Optional[int]) -> Any:
    if port is not None and not 0 < port < 65536:
        raise ValueError(f"port must be 1 to 65535, not {port}")
    files = [os.fspath(file) if file is not None else "" for file in (calibration, metadata)]
    return _readers().Reading(sensor or "", files[0], files[1], topic or "", port)


def open_packets(
    path: Any,
    sensor: Optional[str] = None,
    calibration: Any = None,
    metadata: Any = None,
    topic: Optional[str] = None,
    port: Optional[int] = None,
) -> Packets:
    """Opens a recording of packets; see `read`."""
    return Packets(_existing(path), _reading(sensor, calibration, metadata, topic, port))


def recorded_scans(
    path: Any,
    sensor: Optional[str] = None,
    calibration: Any = None,
    metadata: Any = None,
    topic: Optional[str] = None,
    port: Optional[int] = None,
) -> Iterator[RecordedScan]:
    """The scans of a recording, with their names and times; those that cannot be read as errors. See `read`."""
    name = _existing(path)
    reading = _reading(sensor, calibration, metadata, topic, port)
    if _readers().is_capture(name):
        packets = Packets(name, reading)
        return (RecordedScan(f"{name}#{number}", t.time, t.points, "") for number, t in enumerate(packets.turns()))
    return _clouds(_readers().Scans(name, reading))


def _clouds(scans: Any) -> Iterator[RecordedScan]:
    while True:
        scan = scans.next()
        if scan is None:
            return
        yield RecordedScan(*scan)


def read(
    path: Any,
    sensor: Optional[str] = None,
    calibration: Any = None,
    metadata: Any = None,
    topic: Optional[str] = None,
    port: Optional[int] = None,
) -> Union[Array, Iterator[Array]]:
    """Reads a scan, or the scans of a recording, in all formats of the programs.

    Parameters
    ----------
    path : str or os.PathLike
        A cloud (see `lisco_cluster --help`), a capture of packets (pcap, pcapng), or a bag (db3, mcap, bag, or a bag's
        folder) of clouds or packets.
    sensor : str, optional
        That sent the packets: one of `lisco.sensors()`; by default, found by the packets.
    calibration, metadata : str or os.PathLike, optional
        Files that some sensors need.
    topic : str, optional
        Of a bag, if it has several of clouds or packets.
    port : int, optional
        Of a capture: reads only packets to it.

    Returns
    -------
    ndarray or iterator of ndarray
        Of a cloud: float32 (N, 3), or (H, W, 3) if it is organized. Of a recording: an iterator of these; rotations of
        a capture are (lasers, columns, 4), x, y, z and intensity, NaN where there is no return.

    Raises
    ------
    FileNotFoundError, ValueError
        With one line that names the file and what is wrong with it; of a recording, perhaps in mid-iteration.
    """
    name = _existing(path)
    if is_recording(name):
        return _points(recorded_scans(name, sensor, calibration, metadata, topic, port))
    if any(option is not None for option in (sensor, calibration, metadata, topic, port)):
        raise ValueError(f"{name}: only a recording has a sensor, calibration, metadata, topic and port")
    try:
        points: Array = _readers().read_file(name)
        return points
    except RuntimeError as error:
        raise ValueError(str(error)) from None


def _points(scans: Iterator[RecordedScan]) -> Iterator[Array]:
    for scan in scans:
        if scan.points is None:
            raise ValueError(scan.error)
        yield scan.points
