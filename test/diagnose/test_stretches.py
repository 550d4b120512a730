"""The part of the recordings that ranks candidates: it includes both directions, and what happens rarely."""

import numpy as np

from pneumo_ros.diagnose.stretches import SETTLING, stretches
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


def test_both_directions_take_part() -> None:
    """Three constant voltages of one direction, which alone once ranked candidates, and the other recordings."""
    runs = [sliding(f"constant_p{k}", 0.1, 20.0) for k in range(3)]
    runs += [sliding(f"constant_m{k}", -0.1, 20.0) for k in range(3)]
    runs += [sliding("train_slow", 0.1, 60.0, period=10.0)]
    part = stretches(runs, 50.0)
    assert 50.0 <= sum(run.time[-1] - run.time[0] for run in part) <= 54.0
    extending, retracting = seconds_by_direction(part)
    assert 0.5 < extending / retracting < 2.0


def test_running_time_goes_on() -> None:
    """A machine that warms up is warm in a late stretch."""
    whole = sliding("long", 0.1, 600.0, period=47.0)
    part = stretches([whole], 50.0)
    assert part[-1].time[0] > 100.0
    for run in part:
        rows = np.searchsorted(whole.time, run.time - 1e-9)
        assert np.abs(run.time - whole.time[rows]).max() < 1e-9
        assert run.position.tobytes() == whole.position[rows].tobytes()


def test_one_long_run_is_met_in_both_directions() -> None:
    extending, retracting = seconds_by_direction(stretches([sliding("long", 0.1, 600.0, period=47.0)], 50.0))
    assert 0.5 < extending / retracting < 2.0


def test_what_happens_once_in_a_long_time_takes_part() -> None:
    """A valve that opens once in each run shows its dynamics there and nowhere else."""
    runs, opened = [], (3.0, 61.0, 33.0)
    for k, begin in enumerate(opened):
        run = sliding(f"run {k}", 0.1, 100.0)
        run.input[: round(begin / SAMPLE) * PARTS] = 0.0
        runs.append(run)
    part = stretches(runs, 30.0)
    for k in range(len(opened)):
        own = [run.input for run in part if run.name == f"run {k}"]
        assert any(voltage[0] == 0.0 and voltage[-1] > 0.0 for voltage in own)


def test_neighbours_are_one_stretch_and_only_its_start_settles() -> None:
    runs = [sliding("one", 0.1, 40.0, period=3.0), sliding("other", -0.1, 40.0, period=9.0)]
    part = stretches(runs, 70.0)
    assert len(part) < 10
    for run in part:
        settling = len(run) - run.measured.sum()
        assert settling in (0, round(SETTLING / SAMPLE))  # the start of a run is judged
        assert len(run.input) == (len(run) - 1) * PARTS
    assert any(run.time[-1] > 10.0 for run in part)


def test_the_order_of_recordings_does_not_matter() -> None:
    runs = [sliding(f"run {k}", 0.02 * (k + 1), 30.0, period=3.0 + k) for k in range(4)]
    forward, backward = (stretches(given, 40.0) for given in (runs, runs[::-1]))
    assert {(run.name, run.position[0]) for run in forward} == {(run.name, run.position[0]) for run in backward}


def test_short_recordings_are_taken_whole() -> None:
    runs = [sliding("one", 0.1, 20.0), sliding("two", -0.1, 29.0)]
    assert stretches(runs, 50.0) == []
