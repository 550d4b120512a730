"""The inverse of the dead zone undoes the plant's dead zone, and does not chatter."""

import numpy as np
import pytest

from pneumo_ros.control import ValveInverse
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

CROOKED = {"right_limit": 0.9, "left_limit": 0.5, "right_slope": 1.5, "left_slope": 0.7}


def opening_of_plant(voltage: np.ndarray) -> np.ndarray:
    """Opening from a voltage by the plant's own dead_zone effect."""
    model = load_model("axis").with_parameters({f"dead_zone.{name}": value for name, value in CROOKED.items()})
    states = np.tile(model.state(), (len(voltage), 1))
    return model.outputs(states, voltage)["opening"]


def test_beyond_the_smoothing_the_plant_opens_as_wanted() -> None:
    valve = ValveInverse(**CROOKED, smoothing=0.02)
    wanted = np.concatenate([np.linspace(-3.0, -0.02, 50), np.linspace(0.02, 3.0, 50)])
    voltage = np.array([valve.voltage(float(u)) for u in wanted])
    assert opening_of_plant(voltage) == pytest.approx(wanted, abs=1e-12)


def test_the_voltage_rises_without_jumps() -> None:
    valve = ValveInverse(**CROOKED, smoothing=0.02)
    wanted = np.linspace(-0.1, 0.1, 2001)
    voltage = np.array([valve.voltage(float(u)) for u in wanted])
    steps = np.diff(voltage)
    assert steps.min() > 0.0
    assert steps.max() < 1e-4 * (0.9 / 0.02 + 2.0)
    assert valve.voltage(0.0) == 0.0


def test_without_smoothing_it_is_the_exact_inverse() -> None:
    valve = ValveInverse(smoothing=0.0)
    assert valve.voltage(1e-9) == pytest.approx(0.78)
    assert valve.voltage(-1e-9) == pytest.approx(-0.78)
    assert valve.voltage(0.0) == 0.0


def test_voltage_and_opening_stay_within_the_limits() -> None:
    valve = ValveInverse(**CROOKED, max_voltage=5.0)
    assert valve.voltage(100.0) == 5.0
    assert valve.voltage(-100.0) == -5.0
    high, low = valve.clip(100.0), valve.clip(-100.0)
    assert valve.voltage(high) == pytest.approx(5.0)
    assert valve.voltage(low) == pytest.approx(-5.0)
    assert valve.clip(0.3) == 0.3


@pytest.mark.parametrize("bad", [{"right_limit": -1.0}, {"left_slope": 0.0}, {"smoothing": float("nan")}])
def test_what_is_no_valve_is_refused(bad: dict[str, float]) -> None:
    with pytest.raises(UsageError, match=next(iter(bad))):
        ValveInverse(**bad)


def test_a_limit_inside_the_dead_zone_is_refused() -> None:
    with pytest.raises(UsageError, match="would never open"):
        ValveInverse().with_values(max_voltage=0.5)
