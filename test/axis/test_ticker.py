"""The ticker: one tick per period; late ticks are made up for, very late ones dropped; an error ends it."""

import threading
from collections.abc import Callable
from itertools import pairwise

from pneumo_ros.axis.ticker import Ticker

PERIOD = 2_000_000  # ns


class Clock:
    """A clock that only moves when somebody sleeps or works."""

    def __init__(self) -> None:
        self.time = 5_000_000_000

    def now(self) -> int:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.time += round(seconds * 1e9)


def deadlines_of(ticks: int, work: Callable[[int], int]) -> tuple[Ticker, list[int]]:
    """A ticker after some ticks, of which number k took work(k) [ns], and its deadlines."""
    clock, deadlines, done = Clock(), [], threading.Event()

    def tick(deadline: int) -> None:
        clock.time += work(len(deadlines))
        deadlines.append(deadline)
        if len(deadlines) == ticks:
            ticker.stop_soon()
            done.set()

    ticker = Ticker(PERIOD, tick, lambda failure: None, now=clock.now, sleep=clock.sleep)
    ticker.start()
    assert done.wait(20.0)
    ticker.stop()
    return ticker, deadlines


def test_deadlines_are_one_period_apart() -> None:
    ticker, deadlines = deadlines_of(100, lambda k: 30_000)
    assert {b - a for a, b in pairwise(deadlines)} == {PERIOD}
    assert (ticker.ticks, ticker.late, ticker.dropped_ns) == (100, 0, 0)


def test_a_short_delay_is_made_up_for_and_counted() -> None:
    ticker, deadlines = deadlines_of(100, lambda k: 20_000_000 if k == 10 else 30_000)
    assert {b - a for a, b in pairwise(deadlines)} == {PERIOD}
    assert ticker.late == 9  # it starts 18 ms late, and each tick makes up for 1.97 ms
    assert ticker.dropped_ns == 0


def test_what_is_too_late_is_dropped_and_counted() -> None:
    ticker, deadlines = deadlines_of(20, lambda k: 300_000_000 if k == 4 else 0)
    gaps = [b - a for a, b in pairwise(deadlines)]
    assert gaps[4] == 300_000_000
    assert gaps[:4] + gaps[5:] == [PERIOD] * 18
    assert ticker.dropped_ns == 298_000_000
    assert ticker.late == 1


def test_work_that_takes_longer_than_a_period_does_not_spiral() -> None:
    _, deadlines = deadlines_of(1000, lambda k: 3 * PERIOD)
    spent = 1000 * 3 * PERIOD
    assert abs(deadlines[-1] - deadlines[0] - spent) < 0.12e9  # never more than 0.1 s behind


def test_an_error_ends_it_and_is_reported() -> None:
    failures: list[Exception] = []
    done = threading.Event()

    def tick(deadline: int) -> None:
        raise RuntimeError("broken")

    def ended(failure: Exception) -> None:
        failures.append(failure)
        done.set()

    ticker = Ticker(PERIOD, tick, ended)
    ticker.start()
    assert done.wait(20.0)
    ticker.stop()
    assert [str(failure) for failure in failures] == ["broken"]
