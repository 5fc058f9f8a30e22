#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Rate of lisco.archive with one worker and more, and the load of a piece on the scheduler.

PYTHONPATH=build/release/python python/benchmarks/archive.py INPUT... [--repeat 20] [options of lisco.archive]
"""

import argparse
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("inputs", nargs="*", metavar="INPUT", help="scans or recordings; none: only the scheduler")
    parser.add_argument("--repeat", type=int, default=1, metavar="N", help="the inputs this often, by links")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2], metavar="N")
    parser.add_argument("--runs", type=int, default=1, metavar="N", help="in turns, of which the fastest counts")
    parser.add_argument("--piece", type=int, default=200, metavar="N", help="scans of a piece")
    parser.add_argument("--calls", type=int, default=2000, metavar="N", help="pieces given to the scheduler")
    given, options = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as folder:
        if given.inputs:
            rates(given, options, Path(folder))
        scheduler_load(given.calls, given.piece)


def rates(given, options, folder):
    """Prints a row for each number of workers."""
    source = folder / "source"
    source.mkdir()
    for number in range(given.repeat):
        for name in map(Path, given.inputs):
            os.symlink(name.resolve(), source / f"{number:06d}_{name.name}")

    def clustered(out, workers):
        command = [sys.executable, "-m", "lisco.archive", str(source), "-o", str(out), *options]
        command += ["--workers", str(workers), "--piece", str(given.piece)]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        found = re.match(r"([0-9]+) scans, ([0-9]+) clusters in ([0-9.]+) s", done.stdout)
        return int(found[1]), int(found[2]), float(found[3])

    seconds = {}
    for run in range(given.runs):
        for workers in given.workers:
            scans, clusters, passed = clustered(folder / f"out_{run}_{workers}", workers)
            seconds[workers] = min(passed, seconds.get(workers, float("inf")))
    print("| workers | scans | clusters | seconds | scans per second | times the first |\n|---|---|---|---|---|---|")
    for workers in given.workers:
        passed, first = seconds[workers], seconds[given.workers[0]]
        print(f"| {workers} | {scans} | {clusters} | {passed} | {scans / passed:.1f} | {first / passed:.2f} |")
    _, _, passed = clustered(folder / f"out_0_{given.workers[0]}", 0)  # all is done but the table
    print(f"\ntable: {clusters} clusters in {passed} s, {clusters / max(passed, 0.05):.0f} per second\n")


def scheduler_load(calls, files):
    """Prints what a piece of so many files costs a scheduler, by the processor time of its process."""
    import distributed
    import psutil
    from lisco.archive.executors import call_packed, packed

    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
    with tempfile.TemporaryDirectory() as folder:
        scheduler = dask("scheduler", folder, "--host", "127.0.0.1", "--port", address.rsplit(":", 1)[1])
        workers = [dask("worker", folder, address, "--nthreads", "1", "--no-nanny") for _ in range(2)]
        try:
            with distributed.Client(address, timeout=60) as client:
                client.wait_for_workers(2)
                names = tuple(f"/shared/archive/drives/2026-01-01/{number:06d}.pcd" for number in range(files))

                def submit(count):
                    return [client.submit(call_packed, length_of, packed((names,)), pure=False) for _ in range(count)]

                client.run_on_scheduler(count_messages)
                distributed.wait(submit(100))
                before, messages = psutil.Process(scheduler.pid).cpu_times(), client.run_on_scheduler(counted)
                start = time.perf_counter()
                distributed.wait(submit(calls))
                passed = time.perf_counter() - start
                after = psutil.Process(scheduler.pid).cpu_times()
                messages = [b - a for a, b in zip(messages, client.run_on_scheduler(counted))]
                beats, beat = heartbeats(client, psutil.Process(scheduler.pid))
        finally:
            for process in [*workers, scheduler]:
                process.kill()
                process.wait()
    seconds = after.user + after.system - before.user - before.system
    print(f"scheduler, {calls} pieces of {files} files: {1e3 * seconds / calls:.2f} ms of processor time and "
          f"{sum(messages) / calls:.1f} messages a piece\n"
          f"({messages[0] / calls:.1f} received, {messages[1] / calls:.1f} sent); "
          f"at most {calls / seconds:.0f} pieces, {sum(messages) / seconds:.0f} messages per second "
          f"({calls / passed:.0f} pieces per second in this run)")
    print(f"{beats} heartbeats: {1e3 * beat / beats:.2f} ms of processor time each")


def heartbeats(client, process):
    """Number of heartbeats in some seconds, 200 a second wanted, and their processor time."""

    def hasten(dask_scheduler):
        from distributed import scheduler

        scheduler.heartbeat_interval = lambda workers: 0.01
        handler = dask_scheduler.handlers["heartbeat_worker"]

        def counting(*arguments, **options):
            dask_scheduler.lisco_messages[0] += 1
            return handler(*arguments, **options)

        dask_scheduler.handlers["heartbeat_worker"] = counting

    client.run_on_scheduler(hasten)
    time.sleep(2)
    first, before = client.run_on_scheduler(counted)[0], process.cpu_times()
    time.sleep(5)
    last, after = client.run_on_scheduler(counted)[0], process.cpu_times()
    return last - first, after.user + after.system - before.user - before.system


def dask(what, folder, *arguments):
    command = [sys.executable, "-m", f"distributed.cli.dask_{what}", *arguments, "--no-dashboard"]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)


def length_of(names):
    return len(names)


def count_messages(dask_scheduler):
    """In the scheduler's process: counts the messages of its streams from now on."""
    from distributed.batched import BatchedSend

    dask_scheduler.lisco_messages = [0, 0]

    def counting(handler):
        def handle(*arguments, **options):
            dask_scheduler.lisco_messages[0] += 1
            return handler(*arguments, **options)

        return handle

    for name, handler in list(dask_scheduler.stream_handlers.items()):
        dask_scheduler.stream_handlers[name] = counting(handler)
    send = BatchedSend.send

    def counted_send(stream, *messages):
        dask_scheduler.lisco_messages[1] += len(messages)
        return send(stream, *messages)

    BatchedSend.send = counted_send


def counted(dask_scheduler):
    return list(dask_scheduler.lisco_messages)


if __name__ == "__main__":
    main()
