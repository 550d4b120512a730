"""Clocks a little apart are laid on one sample time; the motion stays where it was."""

from dataclasses import replace

import numpy as np
import pytest

from pneumo_ros.runs.clock import lowered, on_one_clock
from pneumo_ros.runs.run import PARTS, Run


def sine(step: float, seconds: float = 2.0) -> Run:
    """A sine of 1 Hz, its rate as the input, a gap from 0.5 to 0.6 s, and a pressure that is twice the position."""
    t = step * np.arange(round(seconds / step) + 1)
    parts = (np.arange((len(t) - 1) * PARTS) + 0.5) * step / PARTS
    y, held = np.sin(2.0 * np.pi * t), np.cos(2.0 * np.pi * parts)
    return Run(f"{step}", step, y, 2.0 * y, None, held, (t < 0.5) | (t > 0.6), True, {"p_a": 2.0 * held})


def test_runs_a_little_apart_come_to_their_median_sample_time() -> None:
    found = on_one_clock([sine(5.0e-3), sine(5.1e-3), sine(4.5e-3)])
    assert {run.sample_time for run in found} == {5.0e-3}
    for run in found:
        exact = sine(5.0e-3)
        n = min(len(run), len(exact))
        assert n > 395
        assert len(run.input) == (len(run) - 1) * PARTS
        assert np.abs(run.position - exact.position[:n])[:n].max() < 2e-4
        assert np.abs(run.pressure_a - 2.0 * run.position).max() < 1e-12
        assert np.abs(run.input - exact.input[: len(run.input)]).max() < 5e-3
        assert run.further["p_a"].tobytes() == (2.0 * run.input).tobytes()
        assert abs(float(run.time[~run.measured][0]) - 0.5) < 6e-3


def test_runs_of_equal_rates_stay_as_they_are() -> None:
    given = [sine(5e-3), sine(5e-3)]
    assert all(one is other for one, other in zip(on_one_clock(given), given, strict=True))
    assert on_one_clock([]) == []
    assert lowered(given) == lowered([sine(5.0e-3), sine(5.1e-3)]) == ""


@pytest.mark.parametrize("fast", [1e-3, 3.1e-3, 2e-4])
def test_runs_of_other_rates_come_to_that_of_the_slowest(fast: float) -> None:
    """Without what is too fast for it: 160 Hz would show as 40 Hz at 200 Hz. An input keeps its mean."""
    slow, quick = sine(5e-3), sine(fast)
    ripple = 0.1 * np.sin(2.0 * np.pi * 160.0 * quick.time)
    kicks = np.where(np.arange(len(quick.input)) % 7 == 0, 0.7, 0.0)  # their mean is 0.1
    found = on_one_clock([slow, replace(quick, position=quick.position + ripple, input=quick.input + kicks)])
    assert found[0] is slow
    assert {run.sample_time for run in found} == {5e-3}
    n, inside = min(map(len, found)), slice(20, -20)
    assert np.abs(found[1].position[:n] - slow.position[:n])[inside].max() < 0.02
    assert np.abs(found[1].pressure_a[:n] - slow.pressure_a[:n])[inside].max() < 0.02
    assert np.abs(found[1].held[: n - 1] - slow.held[: n - 1] - 0.1).max() < 0.05
    said = lowered([slow, quick])
    assert f"of {1.0 / fast:.4g} Hz count at the 200 Hz of the slowest" in said


def test_runs_are_never_farther_apart_than_segments_allow() -> None:
    """Two clocks 0.18 % apart: each is 0.09 % from the mean of both, and segments allow 0.1 % between runs."""
    found = on_one_clock([sine(5.0e-3), sine(5.009e-3)])
    steps = [run.sample_time for run in found]
    assert max(steps) / min(steps) - 1.0 < 1e-9
