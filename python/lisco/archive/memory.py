# SPDX-License-Identifier: BSD-3-Clause
"""The memory of a worker."""

import ctypes
import functools

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # of glibc's mallopt
_KEPT = 256 << 20  # bytes at most that a worker keeps between scans
_MAPPED = 32 << 20  # bytes from which an array has pages of its own; glibc's limit


@functools.lru_cache(maxsize=None)
def keep_memory() -> None:
    """Keeps the memory of a scan for the next one, where the C library is glibc.

    Dask starts workers with MALLOC_TRIM_THRESHOLD_=65536: arrays go back to the system at once, and each page of the
    next scan is a page fault. Measured on scans of 210,000 points: a third of a worker's processor time.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError):
        return
    mallopt(_TRIM_THRESHOLD, _KEPT)
    mallopt(_MMAP_THRESHOLD, _MAPPED)
