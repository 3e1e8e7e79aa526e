"""Who does the chunks: threads or processes on this machine, or a Dask cluster."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from multiprocessing import get_context, parent_process
from typing import Any

import pyarrow as pa

from ..errors import Failure, UsageError
from .job import Job

Pool = Callable[[Job, Iterable[int]], Iterator[tuple[int, pa.Table]]]
AHEAD = 2  # chunks given out for each worker: one at work, one waiting


def here(workers: int) -> Pool:
    """All chunks on this machine, `workers` at once: in threads where the job is for these, which need no time to start, else
    in processes."""

    def chunks(job: Job, numbers: Iterable[int]) -> Iterator[tuple[int, pa.Table]]:
        pool, do = _threads(job, workers) if job.by_threads else _processes(job, workers)
        waiting: dict[Future[pa.Table], int] = {}
        rest = iter(numbers)
        try:
            while True:
                waiting |= {pool.submit(do, n): n for n in islice(rest, AHEAD * workers - len(waiting))}
                if not waiting:
                    return
                for done in wait(waiting, return_when=FIRST_COMPLETED).done:
                    yield waiting.pop(done), done.result()
        except BrokenProcessPool as error:
            raise Failure(
                "a worker process was killed, perhaps for want of memory; run the same command again to go on, "
                "with fewer --workers if it happens again"
            ) from error
        finally:
            pool.shutdown(cancel_futures=True)

    return chunks


def _threads(job: Job, workers: int) -> tuple[Executor, Callable[[int], pa.Table]]:
    return ThreadPoolExecutor(workers), job.table


def _processes(job: Job, workers: int) -> tuple[Executor, Callable[[int], pa.Table]]:
    """Spawned, not forked: this process has threads."""
    return ProcessPoolExecutor(workers, get_context("spawn"), _begin, (job,)), _chunk


_job: Job | None = None


def _begin(job: Job) -> None:
    global _job
    _job = job
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that gives the work out
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _chunk(number: int) -> pa.Table:
    assert _job is not None
    return _job.table(number)


def dask(address: str, wait_seconds: float = 60.0) -> Pool:
    """All chunks on the Dask cluster whose scheduler is at `address`.

    A chunk whose worker dies is given to another one. Raises UsageError without Dask, Failure where there is no cluster.
    """
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError:
        raise UsageError("--dask needs Dask; install it with pip install 'wheelchair-fmu[dask]'") from None

    def chunks(job: Job, numbers: Iterable[int]) -> Iterator[tuple[int, pa.Table]]:
        rest = iter(numbers)
        with _connected(Client, address, wait_seconds) as client:
            given = client.submit(_same, job, pure=False)  # not scattered: what a dead worker held is made again

            def submit(n: int) -> list[tuple[int, object]]:
                return [client.submit(_numbered, given, number, pure=False) for number in islice(rest, n)]

            done = as_completed(submit(AHEAD * sum(client.nthreads().values())), with_results=True)
            try:
                for _, result in done:
                    yield result
                    for future in submit(1):
                        done.add(future)
            except (KilledWorker, CancelledError) as error:
                raise Failure(
                    "the cluster lost its workers again and again; see their logs, and run the same command again to go on"
                ) from error

    return chunks


def _same(job: Job) -> Job:
    return job


def _numbered(job: Job, number: int) -> tuple[int, pa.Table]:
    return number, job.table(number)


def _connected(client: Callable[..., Any], address: str, seconds: float) -> Any:
    try:
        connection = client(address, timeout=seconds)
        connection.wait_for_workers(1, timeout=seconds)
    except (OSError, TimeoutError, ValueError) as error:
        raise Failure(
            f"no Dask cluster with a worker at {address} ({error}); give its scheduler, as in tcp://127.0.0.1:8786"
        ) from error
    return connection
