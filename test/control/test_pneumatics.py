"""The inverted chambers and valve against the plant's own: the computed opening gives the wanted rate of force."""

import numpy as np
import pytest

from pneumo_ros.control import Machine
from pneumo_ros.control.pneumatics import chambers, opening
from pneumo_ros.plant import Model, load_model

AXIS = load_model("axis")
EFFECTS = {
    "axis": AXIS,
    "leaking": AXIS.with_effects([*AXIS.effects, "cross_piston_leakage"]),
    "choked": AXIS.with_effects([*AXIS.effects, "choked_flow"], {"choked_flow.blend": 0.7}),
}


def rate_of_force(model: Model, y: float, v: float, p_a: float, p_b: float, opened: float) -> float:
    """F' [N/s] of the plant with that opening, by a difference over a microsecond."""
    voltage = opened + np.copysign(0.78, opened) if opened else 0.0
    dt, start = 1e-6, model.state(y=y, v=v, p_a=p_a, p_b=p_b)
    end = model.simulate([voltage], start, sample_time=dt, step=dt)[0]
    return float((model.effort(end[None])[0] - model.effort(start[None])[0]) / dt)


@pytest.mark.parametrize("name", EFFECTS)
@pytest.mark.parametrize("rate", [-250.0, -20.0, 30.0, 250.0])
@pytest.mark.parametrize("state", [(0.0, 0.1, 4e5, 3e5), (0.4, -0.05, 2e5, 5e5), (-0.6, 0.0, 3e5, 3.1e5)])
def test_the_plant_does_what_the_inverse_asks(name: str, rate: float, state: tuple[float, ...]) -> None:
    model = EFFECTS[name]
    machine = Machine.of(model.effects, model.parameters)
    y, v, p_a, p_b = state
    opened = opening(machine, chambers(machine, y, p_a, p_b), v, rate)
    assert rate_of_force(model, y, v, p_a, p_b, opened) == pytest.approx(rate, abs=0.5)


def test_the_force_is_that_of_the_plant() -> None:
    state = AXIS.state(p_a=3.3e5, p_b=4.1e5)
    assert chambers(Machine(), 0.0, 3.3e5, 4.1e5).force == pytest.approx(AXIS.effort(state[None])[0])


def test_what_cannot_be_reached_opens_the_valve_as_far_as_it_goes() -> None:
    now = chambers(Machine(), 0.0, 3e5, 3e5)
    assert opening(Machine(), now, 0.0, 1e9) == pytest.approx(-opening(Machine(), now, 0.0, -1e9))
    assert opening(Machine(), now, 0.0, 1e9) > 5.0
