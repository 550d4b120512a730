"""Promises of every control law: gains with units and ranges, all set or none, and repeatable answers."""

import math

import pytest

from pneumo_ros.control import LAWS, Law, Machine, Measurement, Pid, Setpoint, ValveInverse
from pneumo_ros.errors import UsageError

KINDS = list(LAWS.values())


def seen(k: int, position: float) -> Measurement:
    """Sample k at 1 kHz."""
    return Measurement(1e-3 * k, position, None, 3e5, 4e5)


@pytest.mark.parametrize("kind", KINDS)
def test_gains_are_numbers_with_unit_meaning_and_range(kind: type[Law]) -> None:
    assert kind.gains
    law = kind()
    for name, gain in kind.gains.items():
        assert getattr(law, name) == gain.default
        assert gain.low <= gain.default <= gain.high
        assert math.isfinite(gain.low)
        assert math.isfinite(gain.high)
        assert gain.unit
        assert gain.meaning


@pytest.mark.parametrize("kind", KINDS)
def test_a_bad_gain_changes_no_gain(kind: type[Law]) -> None:
    law = kind()
    first, second = list(kind.gains)[:2]
    before = getattr(law, first)
    with pytest.raises(UsageError, match=second):
        law.tune({first: kind.gains[first].high, second: math.nan})
    assert getattr(law, first) == before


def test_an_unknown_gain_is_named_with_its_nearest() -> None:
    with pytest.raises(UsageError, match="did you mean proportional"):
        Pid({"proportionl": 1.0})


@pytest.mark.parametrize("kind", KINDS)
def test_a_repeated_measurement_gets_the_same_answer_and_changes_nothing(kind: type[Law]) -> None:
    one, other = kind(), kind()
    for k in range(20):
        sample = seen(k, 1e-4 * k)
        answer = one.step(Setpoint(0.05), sample)
        assert one.step(Setpoint(0.05), sample) == answer
        assert other.step(Setpoint(0.05), sample) == answer


@pytest.mark.parametrize("kind", KINDS)
def test_reset_forgets_everything_but_the_gains(kind: type[Law]) -> None:
    law, fresh = kind(), kind()
    for k in range(50):
        law.step(Setpoint(0.2), seen(k, 1e-3 * k))
    law.reset()
    assert [law.step(Setpoint(0.1), seen(k, 0.0)) for k in range(5)] == [
        fresh.step(Setpoint(0.1), seen(k, 0.0)) for k in range(5)
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_voltages_stay_within_the_limits(kind: type[Law]) -> None:
    strongest = kind.tuned[0]
    law = kind({strongest: kind.gains[strongest].high}, ValveInverse(max_voltage=4.0))
    answers = [law.step(Setpoint(r), seen(k, 0.0)) for k, r in enumerate([10.0] * 50 + [-10.0] * 50)]
    assert max(answers) == 4.0
    assert min(answers) == -4.0


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_tuned_are_gains(kind: type[Law]) -> None:
    assert kind.tuned
    assert set(kind.tuned) <= set(kind.gains)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.reads_pressures])
def test_without_pressures_the_valve_stays_closed(kind: type[Law]) -> None:
    law = kind()
    assert [law.step(Setpoint(0.3), Measurement(1e-3 * k, 0.0)) for k in range(20)] == [0.0] * 20
    assert law.step(Setpoint(0.3), Measurement(0.1, 0.0, None, 3e5, math.nan)) == 0.0
    assert law.step(Setpoint(0.3), Measurement(0.2, 0.0, None, math.inf, 3e5)) == 0.0
    assert law.step(Setpoint(0.3), Measurement(0.201, 0.0, None, 3e5, 3e5)) > 0.5  # and forgets it at once


WORST = [
    {"mass": 0.01, "static_friction": 1e5, "volume_a": 1e-8, "volume_b": 1e-8},
    {"stribeck_velocity": 1e-5, "bristle_stiffness": 5e7, "static_friction": 0.0, "coulomb_friction": 1e-3},
    {"filling_coefficient": 0.0, "exhaust_coefficient": 0.0, "voltage_gain": 0.01},
    {"choked_share": 1.0, "critical_ratio": 0.9, "leakage": 1e-6, "supply_pressure": 1e4, "mass_added": 1e4},
    {"spool_frequency": 5.0, "spool_damping": 5.0},
]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("values", WORST)
@pytest.mark.parametrize("end", ["low", "high"])
def test_the_worst_that_is_allowed_leaves_the_voltage_finite(kind: type[Law], values: dict, end: str) -> None:
    """Gains and machine parameters at their limits, set during motion, with measurements beyond the stroke."""
    law = kind()
    law.step(Setpoint(0.0), seen(0, 0.0))
    law.machine = Machine(**values)
    law.tune({name: getattr(gain, end) for name, gain in kind.gains.items()})
    for k in range(1, 200):
        voltage = law.step(Setpoint(0.3, -1e3, 1e4, 1e6), Measurement(1e-3 * k, (-1.0) ** k * 3.0, None, 1e4, 5e6))
        assert math.isfinite(voltage)
        assert abs(voltage) <= law.valve.max_voltage


@pytest.mark.parametrize("kind", KINDS)
def test_no_law_looks_into_the_future_or_keeps_a_past_run(kind: type[Law]) -> None:
    """After a reset, time may restart."""
    law = kind()
    first = [law.step(Setpoint(0.1), seen(k, 1e-5 * k)) for k in range(30)]
    law.reset()
    assert [law.step(Setpoint(0.1), seen(k, 1e-5 * k)) for k in range(30)] == first
