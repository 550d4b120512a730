"""Executors (concurrent.futures) for work: this process, other processes, or a Dask cluster."""

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import suppress
from typing import Any, ParamSpec, TypeVar

from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name

FORMS = "one, processes, processes=N, or dask=tcp://HOST:PORT"
_P = ParamSpec("_P")
_T = TypeVar("_T")


class Here(Executor):
    """Runs submitted work at once in this process: for debugging, and as the reference for the others."""

    def submit(self, work: Callable[_P, _T], /, *given: _P.args, **named: _P.kwargs) -> "Future[_T]":
        """The future of work that is done already."""
        future: Future[_T] = Future()
        try:
            future.set_result(work(*given, **named))
        except Exception as error:
            future.set_exception(error)
        return future


class Pool:
    """An executor that can be replaced when it breaks, and its number of workers."""

    def __init__(self, make: Callable[[], Executor], workers: int) -> None:
        """`make` returns a new executor of concurrent.futures with `workers` workers."""
        self._make, self.workers = make, workers
        self.executor = make()

    def renew(self) -> None:
        """Replace an executor whose workers died."""
        self.close()
        self.executor = self._make()

    def close(self) -> None:
        """Cancel waiting work and shut the executor down."""
        with suppress(Exception):  # a broken one may raise again
            self.executor.shutdown(wait=False, cancel_futures=True)

    def __enter__(self) -> "Pool":
        return self

    def __exit__(self, *failure: object) -> None:
        self.close()


def open_pool(name: str = "processes") -> Pool:
    """The pool for `name`, one of FORMS.

    Raises UsageError for another name or without the package `distributed`, DataError when no scheduler answers.
    """
    kind, _, value = name.partition("=")
    if kind == "one" and not value:
        return Pool(Here, 1)
    if kind == "processes":
        return _processes(value or str(os.cpu_count() or 1))
    if kind == "dask":
        return _dask(value)
    raise UsageError(f"{unknown_name('executor', kind, ('one', 'processes', 'dask'))} --executor takes {FORMS}")


def _processes(count: str) -> Pool:
    if not count.isdecimal() or not 0 < int(count) <= 4096:
        raise UsageError(f"processes={count} takes a number of processes from 1 on, such as processes=4")
    # spawned, not forked: compiled code and its threads do not survive a fork
    context = multiprocessing.get_context("spawn")
    return Pool(lambda: ProcessPoolExecutor(int(count), mp_context=context), int(count))


def _dask(address: str) -> Pool:
    require_libraries(("distributed",))
    from distributed import Client

    if "://" not in address:
        raise UsageError(f"dask={address} takes the address of a scheduler, such as dask=tcp://localhost:8786")
    try:
        connect: Any = Client  # of a package that is only partly typed
        client = connect(address, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        raise DataError(f"no Dask scheduler answers at {address}; start one: dask scheduler") from error
    workers = len(client.scheduler_info(n_workers=-1)["workers"])
    if not workers:
        client.close()
        raise DataError(f"the Dask scheduler at {address} has no workers; start some: dask worker {address}")
    # results are lost with their worker, so the cluster must not merge equal calls
    return Pool(lambda: client.get_executor(pure=False, retries=2), 2 * workers)
