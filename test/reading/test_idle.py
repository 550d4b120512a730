"""A sensor that hangs, and a counter at rest, which repeats its value as well."""

import numpy as np
import pytest

from pneumo_ros.plant import load_model
from pneumo_ros.reading.idle import idle_notes
from pneumo_ros.runs.run import PARTS, Run

STEP, COUNT = 1e-3, 2e-5  # s, m of a counter
TIME = STEP * np.arange(6000)


def run(position: np.ndarray) -> Run:
    """A machine driven by a force, with that position."""
    force = np.zeros((len(TIME) - 1) * PARTS)
    return Run("run", STEP, position, None, None, force, np.ones(len(TIME), dtype=bool), True)


def counted(moving: np.ndarray) -> np.ndarray:
    """A counter, read at an uneven clock and laid on an even one: in motion its values are no multiples any more."""
    uneven = TIME + 2e-5 * np.random.default_rng(3).standard_normal(len(TIME))
    read = COUNT * np.round(np.interp(uneven, TIME, moving) / COUNT)
    return np.interp(TIME, uneven, read)


@pytest.mark.parametrize("rest", [slice(0, 2000), slice(3000, 5000)])
def test_a_counter_at_rest_did_not_hang(rest: slice) -> None:
    speed = 0.2 * np.sin(2.0 * np.pi * TIME) * np.minimum(TIME % 3.0, 1.0)
    speed[rest] = 0.0
    speed[rest.stop : rest.stop + 300] *= np.linspace(0.0, 1.0, 300)
    position = counted(STEP * np.cumsum(speed))
    assert np.ptp(position[rest.start + 2 : rest.stop - 2]) == 0.0
    assert not [note for note in idle_notes(load_model("emps"), run(position)) if "hung" in note]


@pytest.mark.parametrize("stop", [4500, 6000])
def test_a_sensor_that_hangs_in_motion_is_named(stop: int) -> None:
    position = counted(0.05 * np.sin(4.0 * TIME))
    position[2000:stop] = position[2000]
    (note,) = (note for note in idle_notes(load_model("emps"), run(position)) if "hung" in note)
    assert "the position repeats" in note
    assert f"for {STEP * (stop - 2000):.1f} s" in note
