"""Work that a first Ctrl-C does not stop, and work that has a deadline."""

import math
import os
import signal
import time

import pytest

from pneumo_ros.command.patience import deadline, finishing
from pneumo_ros.errors import OutOfTimeError


def press() -> None:
    os.kill(os.getpid(), signal.SIGINT)


def long_work() -> None:
    """Twenty seconds. Python looks for signals between short sleeps; one just before a long sleep would wait for it."""
    for _ in range(2000):
        time.sleep(0.01)


def test_the_first_interrupt_is_answered_and_the_second_ends() -> None:
    said: list[str] = []
    with finishing(lambda: said.append("finishing")):
        press()
        said.append("went on")
        with pytest.raises(KeyboardInterrupt):
            press()
    assert said == ["finishing", "went on"]


def test_afterwards_an_interrupt_is_one_again() -> None:
    with finishing(lambda: None):
        press()
    with pytest.raises(KeyboardInterrupt):
        press()


@pytest.mark.parametrize("seconds", [0.1, 0.0, -3.0])
def test_a_deadline_ends_work_and_is_gone_afterwards(seconds: float) -> None:
    begun, before = time.monotonic(), signal.getsignal(signal.SIGALRM)
    with pytest.raises(OutOfTimeError), deadline(seconds):
        long_work()
    assert time.monotonic() - begun < 10.0
    assert signal.getsignal(signal.SIGALRM) is before


@pytest.mark.parametrize("seconds", [math.inf, 1000.0])
def test_work_that_is_done_in_time_is_not_disturbed(seconds: float) -> None:
    before = signal.getsignal(signal.SIGALRM)
    with deadline(seconds):
        done = True
    assert done
    assert signal.getsignal(signal.SIGALRM) is before


def test_a_deadline_that_comes_while_the_compiler_calls_back_is_kept_right_after() -> None:
    """What is raised in a callback of the compiler is printed and lost."""
    done: list[str] = []

    def _raw_object_cache_notify() -> None:  # as the compiler's own is named
        end = time.monotonic() + 0.3
        while time.monotonic() < end:
            pass
        done.append("kept")

    def work() -> None:
        _raw_object_cache_notify()
        long_work()

    with pytest.raises(OutOfTimeError), deadline(0.1):
        work()
    assert done == ["kept"]
