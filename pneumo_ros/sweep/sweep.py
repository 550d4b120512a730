"""The same work for many keys over any executor; workers may die, and the sweep itself may stop and go on."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from typing import Any, NamedTuple

from pneumo_ros.errors import PneumoError
from pneumo_ros.sweep.executors import Pool
from pneumo_ros.sweep.journal import Journal

TRIES = 3  # deaths of a worker with only this work, before the work is given up
_LOST = ("KilledWorker", "CommClosedError", "FutureCancelledError")  # of Dask, which need not be installed


class Done(NamedTuple):
    """Result of one key, or the message of its PneumoError (then `result` is None)."""

    key: str
    result: Any
    problem: str
    fresh: bool  # computed now; else taken from the journal


def sweep(
    work: Callable[..., Any], jobs: Mapping[str, tuple[Any, ...]], pool: Pool, journal: Journal | None = None
) -> Iterator[Done]:
    """Results of `work(*jobs[key])` as they are done; those in the `journal` come first and are not repeated.

    `work` is a function of a module with a JSON-compatible result. Work of a worker that died is repeated; work that
    kills three workers in a row, alone, is given up with a problem. Exceptions other than PneumoError end the sweep.
    Results do not depend on the executor; their order does.
    """
    known = journal.results if journal else {}
    for key in jobs:
        if key in known:
            yield Done(key, known[key]["result"], known[key]["problem"], False)
    course = _Course(work, {key: given for key, given in jobs.items() if key not in known}, pool)
    for key, result, problem in course.run():
        if journal:
            journal.put(key, {"result": result, "problem": problem})
        yield Done(key, result, problem, True)


class _Course:
    """Work in progress. After a death all work in progress is suspect, and repeated one at a time."""

    def __init__(self, work: Callable[..., Any], jobs: Mapping[str, tuple[Any, ...]], pool: Pool) -> None:
        self._work, self._jobs, self._pool = work, jobs, pool
        self._waiting, self._suspects = deque(jobs), deque[str]()
        self._deaths = dict.fromkeys(jobs, 0)
        self._under_way: dict[Future[Any], str] = {}

    def run(self) -> Iterator[tuple[str, Any, str]]:
        """Key, result and problem of each job."""
        while self._waiting or self._suspects or self._under_way:
            self._submit()
            if not self._under_way:
                continue
            done, _ = wait(self._under_way, return_when=FIRST_COMPLETED)
            died = False
            for future in done:
                key = self._under_way.pop(future)
                try:
                    yield key, future.result(), ""
                except PneumoError as error:
                    yield key, None, str(error)
                except Exception as error:
                    if not _is_death(error):
                        raise
                    died = True
                    self._suspects.append(key)
            if died:
                yield from self._bury()

    def _submit(self) -> None:
        """Keep the workers busy; a suspect runs alone."""
        try:
            if self._suspects:
                if not self._under_way:
                    self._start(self._suspects.popleft())
                return
            while self._waiting and len(self._under_way) < 2 * self._pool.workers:
                self._start(self._waiting.popleft())
        except BrokenExecutor:  # it broke between two submissions
            self._pool.renew()

    def _start(self, key: str) -> None:
        try:
            self._under_way[self._pool.executor.submit(self._work, *self._jobs[key])] = key
        except BrokenExecutor:
            self._waiting.appendleft(key)
            raise

    def _bury(self) -> Iterator[tuple[str, Any, str]]:
        """After a death: a new executor; all work in progress becomes suspect."""
        alone = len(self._suspects) == 1 and not self._under_way
        self._suspects.extend(self._under_way.values())
        self._under_way.clear()
        self._pool.renew()
        if alone:
            key = self._suspects[0]
            self._deaths[key] += 1
            if self._deaths[key] >= TRIES:
                self._suspects.clear()
                yield key, None, f"its worker died {TRIES} times, possibly for lack of memory"


def _is_death(error: Exception) -> bool:
    """Whether a worker died, rather than its work failed."""
    return isinstance(error, BrokenExecutor | CancelledError) or type(error).__name__ in _LOST
