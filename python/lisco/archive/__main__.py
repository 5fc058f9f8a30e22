# SPDX-License-Identifier: BSD-3-Clause
"""`python3 -m lisco.archive`."""

import argparse
import os
import sys
from typing import Any, Callable, List, Optional

from .. import __version__
from .._checks import number_of, sizes_of, tolerance_of
from .executors import Distributed, Serial
from .pieces import Settings
from .run import run
from .work import prepare

_NOTES = """
Writes into the folder: pieces/NUMBER/labels.npz (an array of labels for each scan or rotation, numbered as in
lisco.cluster), clusters.sqlite (the tables scans and clusters), and files of its own. Results are written under
temporary names and renamed. The same command again goes on where the last run stopped, and repeats pieces with
unreadable inputs. The results depend on nothing but the inputs and options: not on workers, their number or restarts.

exit status: 0 if all is done, 1 if inputs could not be read (all others are done), 2 on errors
"""


def _count(least: int) -> Callable[[str], int]:
    def count(text: str) -> int:
        value = int(text)
        if value < least:
            raise argparse.ArgumentTypeError(f"must be {least} or more, not {text}")
        return value

    return count


def _number(text: str) -> float:
    try:
        return number_of(text, "the value")
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _tolerance(text: str) -> float:
    try:
        tolerance = tolerance_of(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    if tolerance == 0:
        raise argparse.ArgumentTypeError("must be more than 0")
    return tolerance


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python3 -m lisco.archive",
        description="Clusters the scans of archives on many processes or machines.",
        epilog=_NOTES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("inputs", nargs="+", metavar="INPUT", help="a scan, a recording (capture or bag), or a folder of these")
    add("-o", "--output", required=True, metavar="OUT", help="folder for the results")
    add("--tolerance", required=True, type=_tolerance, metavar="M", help="of clusters, metres")
    add("--min-size", type=_count(0), default=10, metavar="N", help="smallest cluster (default: 10)")
    add("--max-size", type=_count(0), metavar="N", help="largest cluster (default: no limit)")
    add("--ground-z", type=_number, metavar="M", help="leave out points below this height, metres")
    add("--remove-ground", action="store_true", help="leave out the ground, as lisco.remove_ground finds it")
    add("--sensor", help="that sent the packets of recordings")
    add("--calibration", metavar="FILE", help="of the sensor")
    add("--metadata", metavar="FILE", help="of the sensor")
    add("--topic", help="of bags, if they have several of clouds or packets")
    add("--port", type=_count(1), metavar="N", help="of captures: only packets to it")
    add("--piece", type=_count(1), default=200, metavar="N", help="scans of a piece of work (default: 200)")
    add("--no-table", action="store_true", help="do not merge the clusters of the pieces (clusters.npy) into one table")
    add("--scheduler", metavar="ADDRESS", help="of Dask, such as tcp://host:8786, or its scheduler file, "
        "NAME.json (default: an embedded one)")
    add("--workers", type=_count(0), default=os.cpu_count() or 1, metavar="N", help="processes of the embedded "
        "scheduler (default: one for each core); 0: no scheduler, all in this process")
    add("--patience", type=_number, default=300.0, metavar="S", help="seconds to wait for a scheduler (default: 300)")
    add("--version", action="version", version=f"lisco.archive {__version__}")
    return parser


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the program; returns the exit status."""
    given = _parser().parse_args(arguments)
    executor: Any = None
    try:
        sizes_of(given.min_size, given.max_size)
        settings = Settings(
            given.tolerance, given.min_size, given.max_size, given.ground_z, given.remove_ground, given.sensor,
            _absolute(given.calibration), _absolute(given.metadata), given.topic, given.port, given.piece,
        )
        if given.scheduler is None and given.workers == 0:
            executor = Serial()
        else:
            executor = Distributed(given.scheduler, given.workers, given.patience, prepare)
        done = run(given.inputs, os.path.abspath(given.output), settings, executor, table=not given.no_table)
    except KeyboardInterrupt:
        print("lisco.archive: interrupted; the same command goes on", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"lisco.archive: {error}", file=sys.stderr)
        return 2
    except (ValueError, OSError) as error:
        print(f"lisco.archive: {error}".splitlines()[0], file=sys.stderr)
        return 2
    finally:
        if executor is not None:
            executor.close()
    print(f"{done.scans} scans, {done.clusters} clusters in {done.seconds:.1f} s by {executor.description}")
    for failure in done.failures:
        print(f"lisco.archive: {failure}", file=sys.stderr)
    return 1 if done.failures else 0


def _absolute(path: Optional[str]) -> Optional[str]:
    return None if path is None else os.path.abspath(path)


if __name__ == "__main__":
    sys.exit(main())
