#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Rate of lisco.archive with one worker and more, and what a call costs the scheduler.

PYTHONPATH=build/release/python python/benchmarks/archive.py INPUT... [--workers 1 2] [options of lisco.archive]
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("inputs", nargs="+", metavar="INPUT")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2], metavar="N")
    parser.add_argument("--calls", type=int, default=5000, metavar="N", help="empty calls given to the scheduler")
    given, options = parser.parse_known_args()
    first = None
    print("| workers | scans | seconds | of one worker |\n|---|---|---|---|")
    for workers in given.workers:
        with tempfile.TemporaryDirectory() as out:
            command = [sys.executable, "-m", "lisco.archive", *given.inputs, "-o", out, *options]
            command += ["--workers", str(workers)]
            done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        scans, seconds = re.match(r"([0-9]+) scans, .* in ([0-9.]+) s", done.stdout).groups()
        first = first or float(seconds)
        print(f"| {workers} | {scans} | {seconds} | {first / float(seconds):.2f} |", flush=True)
    print(f"\nscheduler: {scheduler_rate(given.calls):.0f} calls per second")


def scheduler_rate(calls):
    """Empty calls per second that an embedded scheduler and two workers get through."""
    from lisco.archive.executors import Distributed

    executor = Distributed(None, 2, 60)
    try:
        list(executor.map(abs, [(1,)] * 100))
        start = time.perf_counter()
        futures = executor._client.map(abs, range(calls), pure=False)
        executor._distributed.wait(futures)
        return calls / (time.perf_counter() - start)
    finally:
        executor.close()


if __name__ == "__main__":
    main()
