# SPDX-License-Identifier: BSD-3-Clause
"""Scans on file, by the readers of the programs."""

import os
from typing import Any, Iterator, Optional, Union

import numpy as np

CAPTURES = (".pcap", ".pcapng")


class Capture:
    """The rotations of a sensor's packets on file."""

    def __init__(self, path: str, sensor: str, calibration: str, metadata: str, port: Optional[int]) -> None:
        self._path = path
        reading = _readers()
        try:
            self._capture = reading.Capture(path, sensor, calibration, metadata, port)
        except RuntimeError as error:
            raise ValueError(str(error)) from None

    @property
    def stagger(self) -> float:
        """Largest difference between the azimuths of a return and of its column, radians."""
        return self._capture.stagger

    def turns(self) -> "Iterator[Any]":
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


def sensors() -> "list[str]":
    """The sensors whose packets can be read."""
    return list(_readers().sensors())


def open_capture(
    path: Any, sensor: Optional[str] = None, calibration: Any = None, metadata: Any = None, port: Optional[int] = None
) -> Capture:
    """Opens a capture of packets; see `read`."""
    name = _existing(path)
    if not name.lower().endswith(CAPTURES):
        raise ValueError(f"{name}: is no capture (known: pcap, pcapng)")
    if sensor is None:
        raise ValueError(f"{name}: a capture needs the sensor that sent it: one of {', '.join(sensors())}")
    files = [os.fspath(file) if file is not None else "" for file in (calibration, metadata)]
    if port is not None and not 0 < port < 65536:
        raise ValueError(f"port must be 1 to 65535, not {port}")
    return Capture(name, sensor, files[0], files[1], port)


def read(
    path: Any, sensor: Optional[str] = None, calibration: Any = None, metadata: Any = None, port: Optional[int] = None
) -> Union[np.ndarray, Iterator[np.ndarray]]:
    """Reads a scan, or the rotations of a recording, in all formats of the programs.

    Parameters
    ----------
    path : str or os.PathLike
        A cloud (see `lisco_cluster --help`), or a capture of packets (pcap, pcapng).
    sensor : str, optional
        That sent the packets: one of `lisco.sensors()`.
    calibration, metadata : str or os.PathLike, optional
        Files that some sensors need.
    port : int, optional
        Reads only packets to it.

    Returns
    -------
    ndarray or iterator of ndarray
        Of a cloud: float32 (N, 3), or (H, W, 3) if it is organized. Of a recording: an iterator of rotations, float32
        (lasers, columns, 4), x, y, z and intensity, NaN where there is no return.

    Raises
    ------
    FileNotFoundError, ValueError
        With one line that names the file and what is wrong with it.
    """
    name = _existing(path)
    if name.lower().endswith(CAPTURES):
        capture = open_capture(name, sensor, calibration, metadata, port)
        return (turn.points for turn in capture.turns())
    if not (sensor is None and calibration is None and metadata is None and port is None):
        raise ValueError(f"{name}: only a capture has a sensor, calibration, metadata and port")
    try:
        return _readers().read_file(name)
    except RuntimeError as error:
        raise ValueError(str(error)) from None
