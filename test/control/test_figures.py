"""Figures of runs with known results."""

import numpy as np
import pytest

from pneumo_ros.control import Record
from pneumo_ros.control.figures import arrivals, breakaways, tracking


def record(reference: np.ndarray, position: np.ndarray, voltage: np.ndarray | None = None) -> Record:
    states = np.column_stack([position, np.gradient(position, 1e-3)])
    return Record(1e-3 * np.arange(len(position)), reference, states, voltage if voltage is not None else 0 * position)


def test_errors_and_activity_count_from_the_time_given() -> None:
    error = np.where(np.arange(2000) < 1000, 1.0, 3e-3)
    seen = tracking(record(error, np.zeros(2000), np.tile([0.0, 2.0], 1000)), 1.0)
    assert (seen.rms, seen.peak) == (pytest.approx(3e-3), pytest.approx(3e-3))
    assert seen.activity == pytest.approx(2000.0)


def test_a_breakaway_is_a_stop_and_a_restart_and_noise_is_no_breakaway() -> None:
    speed = np.concatenate([np.full(50, v) for v in (0.0, 2e-3, 0.02, 3e-3, 0.03, 0.0, -0.02, 1e-4)])
    assert breakaways(speed) == 2


def test_settling_is_when_it_enters_for_good_and_motion_is_that_of_the_last_quarter() -> None:
    wanted = np.concatenate([np.zeros(1000), np.full(1000, 0.06)])
    position = wanted.copy()
    position[1000:1300], position[1350:1400], position[1800:] = 0.0, 0.061, 0.0601
    (end,) = arrivals(record(wanted, position), 1.0)
    assert end.settling == pytest.approx(0.4)
    assert end.error == pytest.approx(1e-4)
    assert end.motion == pytest.approx(1e-4)
