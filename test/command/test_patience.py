"""Work that a first Ctrl-C does not stop."""

import os
import signal

import pytest

from pneumo_ros.command.patience import finishing


def press() -> None:
    os.kill(os.getpid(), signal.SIGINT)


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
