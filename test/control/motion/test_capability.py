"""Speed and acceleration that the supply pressure allows, against the machine itself."""

from dataclasses import replace

import pytest

from pneumo_ros.control import Machine, ValveInverse
from pneumo_ros.control.motion import Capability, Limits
from pneumo_ros.plant import load_model

ABLE = Capability(Machine(), ValveInverse(max_voltage=7.0))


@pytest.mark.parametrize(
    ("side", "volts", "pressures"), [(1.0, 7.0, (6.446e5, 1.051e5)), (-1.0, -7.0, (1.056e5, 6.664e5))]
)
def test_top_speed_and_force_are_those_of_the_plant(side: float, volts: float, pressures: tuple[float, float]) -> None:
    """Simulated until steady; the pressures are those that the model page states for 7 V."""
    model = load_model("axis")
    rows = model.simulate([volts] * 4000, model.state(y=-0.3 * side))
    assert ABLE.top_speed(side) == pytest.approx(abs(rows[-1, 1]), rel=1e-3)
    assert rows[-1, 2:4] == pytest.approx(pressures, rel=2e-3)
    force = side * (4.1e-4 * pressures[0] - 3.0e-4 * pressures[1] - 11.0)
    assert ABLE.force(ABLE.top_speed(side), side) == pytest.approx(force, rel=1e-2)


def test_less_supply_does_less() -> None:
    half = replace(ABLE, supply_pressure=3.5e5)
    assert 0.0 < half.top_speed(1.0) < ABLE.top_speed(1.0)
    assert half.force(0.0, 1.0) == pytest.approx(4.1e-4 * 2.5e5)
    dead = replace(ABLE, supply_pressure=0.0)  # a faulty sensor: no less than the atmosphere
    assert dead.supply == 1e5
    assert dead.top_speed(1.0) < 1e-9
    assert dead.fit(Limits()) == Limits()


def test_shortfall_is_force_over_what_there_is() -> None:
    assert ABLE.shortfall(0.05, 0.0) < 0.0
    assert ABLE.shortfall(0.2, 0.0) > 0.0
    assert ABLE.shortfall(1e-6, 100.0) == pytest.approx(5.0 * 100.0 + 70.0 - 246.0, abs=0.1)
    assert ABLE.shortfall(0.0, 100.0) == pytest.approx(5.0 * 100.0 - 70.0 - 246.0)  # or the end of a retraction
    assert ABLE.shortfall(0.1, -100.0) == pytest.approx(500.0 - 70.0 - 45.467 - 180.0)  # braking
    assert ABLE.shortfall(0.1, -20.0) < 0.0


def test_limits_are_made_to_fit() -> None:
    fitted = ABLE.fit(Limits(speed=10.0, acceleration=1e3))
    assert fitted.speed == pytest.approx(0.95 * 0.1465, rel=1e-3)
    for velocity in (fitted.speed, -fitted.speed):
        assert ABLE.shortfall(velocity, fitted.acceleration * velocity / fitted.speed) <= 0.0
    assert ABLE.fit(Limits()) == Limits()


def test_without_flow_coefficients_the_pressures_alone_decide() -> None:
    free = Capability(Machine(filling_coefficient=0.0, exhaust_coefficient=0.0), ValveInverse())
    assert free.top_speed(1.0) == pytest.approx(((246.0 - 70.0) / 4546.7) ** 0.5)
