"""Every law in the control loop, on the plant: usual gains reach the goal, the worst ones stay within the stroke."""

import math

import pytest

from pneumo_ros.axis.controller.guiding import set_guide
from pneumo_ros.axis.controller.loop import Loop
from pneumo_ros.axis.controller.settings import SETTINGS, gains_of, machine_of, valve_of
from pneumo_ros.control import LAWS
from pneumo_ros.plant import Stepper, load_model

DEFAULTS = {setting.name: setting.default for setting in SETTINGS}
PERIOD = 2_000_000  # ns


class Axis:
    """Loop and plant in lockstep."""

    def __init__(self, law: str) -> None:
        made = LAWS[law](gains_of(law, DEFAULTS), valve_of(DEFAULTS), machine_of(DEFAULTS))
        self.loop, self.stamp = Loop(made, 0.1), 10**18
        set_guide(self.loop.guide, DEFAULTS, 0.0)
        model = load_model("axis")
        self.plant = Stepper(model, model.state(), sample_time=PERIOD * 1e-9)

    def run(self, seconds: float, pressures: bool = True) -> float:
        """Farthest position [m] from the middle; every voltage must be one."""
        farthest = 0.0
        for _ in range(round(seconds / (PERIOD * 1e-9))):
            self.stamp += PERIOD
            y, v, p_a, p_b = (float(value) for value in self.plant.state[:4])
            if pressures:
                self.loop.press("a", p_a)
                self.loop.press("b", p_b)
            volts = self.loop.measure(self.stamp, y, v)
            assert volts is not None
            assert math.isfinite(volts)
            assert abs(volts) <= 10.0
            self.plant.advance(volts)
            farthest = max(farthest, abs(y))
        return farthest


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("end", ["low", "high"])
def test_gains_at_either_end_of_their_ranges_under_way(law: str, end: str) -> None:
    axis = Axis(law)
    axis.run(0.1)
    axis.loop.guide.aim(0.1, None, axis.loop.time)
    axis.run(0.5)
    kind = LAWS[law]
    axis.loop.law.tune({name: getattr(gain, end) for name, gain in kind.gains.items()})
    assert axis.run(1.5) < 0.9
    axis.loop.law.tune({name: gain.default for name, gain in kind.gains.items()})
    axis.loop.guide.aim(0.0, None, axis.loop.time)
    axis.run(4.0)
    assert abs(axis.plant.state[0]) < 2e-2  # it is on its way back, however exact the law is


@pytest.mark.parametrize("law", LAWS)
def test_a_law_that_loses_its_pressures_stays_on_the_stroke(law: str) -> None:
    axis = Axis(law)
    axis.run(0.1)
    axis.loop.guide.aim(0.1, None, axis.loop.time)
    axis.run(0.5)
    assert axis.run(2.0, pressures=False) < 0.3
