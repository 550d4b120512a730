"""Calls a function at a steady rate, against absolute deadlines."""

import threading
import time
from collections.abc import Callable

LATE = 1_000_000  # ns; a tick this much behind its deadline counts as late
BACKLOG = 100_000_000  # ns; older work is dropped: a slow machine would never catch up


class Ticker:
    """A thread that calls `tick(deadline_ns)` once per period; deadlines are of CLOCK_MONOTONIC and do not drift.

    Late ticks follow at once; a delay of more than 0.1 s is dropped and counted in `dropped_ns`.
    """

    def __init__(
        self,
        period_ns: float,
        tick: Callable[[int], None],
        ended: Callable[[Exception], None],
        *,
        now: Callable[[], int] = time.monotonic_ns,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """`ended` gets the exception if one ends the thread; `now` [ns] and `sleep` [s] are the clock."""
        self.ticks = self.late = self.dropped_ns = 0
        self._period, self._tick, self._ended = period_ns, tick, ended
        self._now, self._sleep = now, sleep
        self._stop = False
        self._thread = threading.Thread(target=self._run, name="ticker", daemon=True)

    def start(self) -> None:
        """The first tick comes one period from now."""
        self._thread.start()

    def stop_soon(self) -> None:
        """End the thread after the present tick."""
        self._stop = True

    def stop(self) -> None:
        """End the thread and wait for it."""
        self._stop = True
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            self._loop()
        except Exception as failure:  # the main thread reports it
            self._ended(failure)

    def _loop(self) -> None:
        origin, count = self._now(), 0
        while not self._stop:
            count += 1
            deadline = origin + round(count * self._period)
            behind = self._now() - deadline
            if behind < 0:
                self._sleep(-behind * 1e-9)
                behind = self._now() - deadline
            self.ticks += 1
            self.late += behind > LATE
            if behind > BACKLOG:
                self.dropped_ns += behind
                origin, count, deadline = deadline + behind, 0, deadline + behind
            self._tick(deadline)
