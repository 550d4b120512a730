"""A cylinder that knows only the motion of its rod moves a mass as the whole machine would."""

import numpy as np
import pytest

from pneumo_ros.couple import Cylinder
from pneumo_ros.couple.remote import Remote
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

AXIS = load_model("axis")
STEP = 1e-3  # s of the other simulator


def moved(mass: float, guess: float, seconds: float = 1.5) -> np.ndarray:
    """Positions of a free mass that another simulator moves by explicit steps; the cylinder gets `guess` [kg]."""
    remote = Remote(Cylinder(AXIS), guess, STEP)
    y = v = 0.0
    found = []
    for k in range(round(seconds / STEP)):
        v += remote.answer(k * STEP, y, v, 2.5) / mass * STEP
        y += v * STEP
        found.append(y)
    return np.array(found)


@pytest.mark.parametrize("mass", [2.0, 5.0, 40.0])
def test_a_free_mass_moves_as_the_machine(mass: float) -> None:
    model = AXIS.with_parameters({"piston.mass": mass})
    whole = model.simulate(np.full(1500, 2.5), model.state())[:, 0]
    assert np.abs(moved(mass, mass) - whole).max() < 0.01 * np.ptp(whole)


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_wrong_mass_moves_the_same_way(factor: float) -> None:
    right = moved(5.0, 5.0)
    assert np.abs(moved(5.0, 5.0 * factor) - right).max() < 0.02 * np.ptp(right)


def test_a_pause_and_a_clock_that_goes_back_begin_a_new_motion() -> None:
    remote = Remote(Cylinder(AXIS), 5.0, STEP)
    for time in (0.0, 0.001, 60.0, 60.001, 1.0, 1.001):
        assert abs(remote.answer(time, 0.0, 0.0, 0.0)) < 200.0
    assert remote.cylinder.time < 0.1


@pytest.mark.parametrize(
    ("position", "velocity", "said"), [(1.2, 0.0, "outside of its stroke"), (0.0, np.nan, "finite")]
)
def test_what_no_rod_does_is_refused(position: float, velocity: float, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        Remote(Cylinder(AXIS), 5.0, STEP).answer(0.0, position, velocity, 0.0)
