# SPDX-License-Identifier: BSD-3-Clause
"""Calls of a function, in this process or on Dask's workers."""

import collections
import json
import logging
import pickle
import tempfile
import time
import uuid
import zlib
from typing import Any, Callable, Deque, Dict, Iterator, List, Optional, Tuple

Arguments = Tuple[Any, ...]


def packed(arguments: Arguments) -> bytes:
    """Arguments in few bytes: the load on a scheduler grows with the size of messages."""
    return zlib.compress(pickle.dumps(arguments, protocol=4), 1)


def call_packed(function: Callable[..., Any], arguments: bytes) -> Any:
    """Calls a function with arguments as `packed` gives them."""
    return function(*pickle.loads(zlib.decompress(arguments)))


class Serial:
    """Calls one after the other."""

    description = "this process"

    def map(self, function: Callable[..., Any], calls: List[Arguments]) -> Iterator[Any]:
        """Yields the results."""
        for arguments in calls:
            yield function(*arguments)

    def close(self) -> None:
        """Does nothing."""


class Distributed:
    """Calls on the workers of a Dask scheduler: one at an address, or an embedded one with worker processes.

    A call whose worker dies or stalls is repeated by the scheduler; when the scheduler itself is lost, calls without a
    result are submitted again once it is back. Calls must therefore be repeatable.

    Parameters
    ----------
    address : str, optional
        Of a scheduler, such as tcp://host:8786, or the file that it writes with --scheduler-file (NAME.json); by
        default, an embedded one is started.
    workers : int
        Processes of the embedded scheduler.
    patience : float
        Seconds to wait for a lost scheduler.
    prepare : callable, optional
        Called on each worker of an embedded scheduler before the first piece.
    """

    _CALLS_PER_THREAD = 2  # in the scheduler: one at work and one that waits
    _TTL = "60s"  # without a heartbeat, until a worker's calls are given to others; 5 minutes by Dask's default
    _OBSERVATION = {  # of an embedded cluster, to load it less: Dask's defaults take 3 % of a core for each process
        "distributed.admin.system-monitor.interval": "5s",
        "distributed.admin.tick.interval": "200ms",
        "distributed.worker.memory.monitor-interval": "1s",
        "distributed.worker.profile.enabled": False,
    }

    def __init__(
        self, address: Optional[str], workers: int, patience: float, prepare: Optional[Callable[[], None]] = None
    ) -> None:
        import dask

        dask.config.set({"logging": {"distributed": "critical"}})  # read when distributed is imported
        import distributed

        self._distributed: Any = distributed
        self._patience = patience
        self._cluster: Any = None
        self._client: Any = None
        for name in ("distributed", "asyncio"):  # the latter reports Dask's futures that time out when a run ends early
            logging.getLogger(name).setLevel(logging.CRITICAL)
        if address is None:
            dask.config.set(self._OBSERVATION)
            if dask.config.get("distributed.scheduler.worker-ttl") == "5 minutes":
                dask.config.set({"distributed.scheduler.worker-ttl": self._TTL})
            self._folder = tempfile.TemporaryDirectory(prefix="lisco-archive-")
            self._cluster = self._distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
                local_directory=self._folder.name,
            )
        self._address = address if self._cluster is None else self._cluster.scheduler_address
        self.description = address if address is not None else f"{workers} worker processes"
        self._connect()
        if self._cluster is not None and prepare is not None:
            self._client.run(prepare)

    def map(self, function: Callable[..., Any], calls: List[Arguments]) -> Iterator[Any]:
        """Yields the results as they come.

        Raises
        ------
        OSError
            If the scheduler is lost for longer than the patience.
        Exception
            What a call raises.
        """
        waiting: Deque[Arguments] = collections.deque(calls)
        pending: Dict[Any, Arguments] = {}
        try:
            while waiting or pending:
                if self._client.status != "running":
                    waiting.extendleft(pending.values())
                    pending.clear()
                    self._connect()
                while waiting and len(pending) < self._window():
                    arguments = waiting.popleft()
                    key = f"lisco-{uuid.uuid4().hex}"
                    future = self._client.submit(call_packed, function, packed(arguments), key=key, pure=False)
                    pending[future] = arguments
                for future in self._finished(pending):
                    arguments = pending.pop(future)
                    if future.status == "finished":
                        try:
                            result = future.result(timeout=self._patience)
                        except (OSError, TimeoutError, self._distributed.CancelledError):
                            waiting.append(arguments)  # the worker or the scheduler was lost with the result
                            continue
                        yield result
                    elif future.status == "error":
                        error = future.exception(timeout=self._patience)
                        if not isinstance(error, self._distributed.scheduler.KilledWorker):
                            raise error
                        raise OSError(f"a piece ended several workers, perhaps for want of memory: {error}")
                    else:  # lost or cancelled with the scheduler
                        waiting.append(arguments)
        finally:
            for future in pending:
                future.release()

    def close(self) -> None:
        """Ends the embedded scheduler and its workers."""
        self._close_client(timeout=10)
        if self._cluster is not None:
            self._cluster.close(timeout=10)
            self._folder.cleanup()

    def _window(self) -> int:
        workers = self._client.scheduler_info()["workers"].values()
        return max(2, self._CALLS_PER_THREAD * sum(int(worker["nthreads"]) for worker in workers))

    def _finished(self, pending: Dict[Any, Arguments]) -> List[Any]:
        """Futures that are not pending any more; waits for one, for at most a second."""
        try:
            self._distributed.wait(list(pending), timeout=1, return_when="FIRST_COMPLETED")
        except (OSError, TimeoutError, self._distributed.TimeoutError, self._distributed.CancelledError):
            pass
        return [future for future in pending if future.status != "pending"]

    def _current_address(self) -> str:
        if not str(self._address).endswith(".json"):
            return str(self._address)
        with open(str(self._address), encoding="utf-8") as file:
            return str(json.load(file)["address"])

    def _close_client(self, timeout: float) -> None:
        """Leaves the scheduler; a lost one may not answer in time."""
        if self._client is None:
            return
        try:
            self._client.close(timeout=timeout)
        except (OSError, TimeoutError, self._distributed.TimeoutError):
            pass

    def _connect(self) -> None:
        self._close_client(timeout=5)
        deadline = time.monotonic() + self._patience
        while True:
            try:
                self._client = self._distributed.Client(self._current_address(), timeout=5)
                return
            except (OSError, ValueError, TimeoutError, self._distributed.TimeoutError) as error:
                if time.monotonic() > deadline:
                    raise OSError(f"{self._address}: no scheduler answers: {error}") from None
                time.sleep(1)
