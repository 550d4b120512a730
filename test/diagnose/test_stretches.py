"""The part of the recordings that ranks candidates: it includes every run and both directions."""

import numpy as np
import pytest

from pneumo_ros.diagnose.stretches import LEAST, SETTLING, stretches
from pneumo_ros.runs.run import PARTS, Run

SAMPLE = 0.01  # s


def sliding(name: str, speed: float, seconds: float, period: float = np.inf) -> Run:
    """A run at constant speed [m/s], back and forth with `period` [s]."""
    time = np.arange(round(seconds / SAMPLE) + 1) * SAMPLE
    way = np.where((time / period) % 1.0 < 0.5, speed, -speed)
    position, held = np.cumsum(way) * SAMPLE, np.repeat(way[1:], PARTS)
    return Run(name, SAMPLE, position, position, position, held, np.ones(len(time), dtype=bool), False)


def seconds_by_direction(runs: list[Run]) -> tuple[float, float]:
    """How long the judged parts extend and retract [s]."""
    way = [np.diff(run.position)[run.measured[1:]] for run in runs]
    return tuple(SAMPLE * sum(int(np.sum(sign * each > 0.0)) for each in way) for sign in (1.0, -1.0))


def test_every_run_and_both_directions_take_part() -> None:
    """Three constant voltages of one direction, which alone once ranked candidates, and the other recordings."""
    runs = [sliding(f"constant_p{k}", 0.1, 20.0) for k in range(3)]
    runs += [sliding(f"constant_m{k}", -0.1, 20.0) for k in range(3)]
    runs += [sliding("train_slow", 0.1, 60.0, period=10.0)]
    part = stretches(runs, 50.0)
    assert {run.name for run in part} == {run.name for run in runs}
    assert sum(run.time[-1] for run in part) == pytest.approx(50.0, abs=1.0)
    extending, retracting = seconds_by_direction(part)
    assert 0.5 < extending / retracting < 2.0


def test_one_long_run_is_met_at_every_phase_of_its_motion() -> None:
    extending, retracting = seconds_by_direction(stretches([sliding("long", 0.1, 600.0, period=47.0)], 50.0))
    assert 0.5 < extending / retracting < 2.0


def test_short_recordings_are_taken_whole() -> None:
    runs = [sliding("one", 0.1, 20.0), sliding("two", -0.1, 29.0)]
    assert stretches(runs, 50.0) == []


def test_a_short_run_beside_long_ones_keeps_enough_to_be_judged() -> None:
    runs = [sliding("long", 0.1, 300.0), sliding("short", -0.1, 6.0)]
    (short,) = (run for run in stretches(runs, 50.0) if run.name == "short")
    assert short.time[-1] == pytest.approx(LEAST, abs=SAMPLE)
    assert short.measured.sum() == len(short) - round(SETTLING / SAMPLE)
    assert len(short.input) == (len(short) - 1) * PARTS
