"""What every control law promises: gains with units and ranges, all or nothing, and answers that repeat."""

import math

import pytest

from pneumo_ros.control import Law, Measurement, Pid, Setpoint, ValveInverse
from pneumo_ros.errors import UsageError

LAWS = [Pid]


@pytest.mark.parametrize("kind", LAWS)
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


@pytest.mark.parametrize("kind", LAWS)
def test_a_bad_gain_changes_none(kind: type[Law]) -> None:
    law = kind()
    first, second = list(kind.gains)[:2]
    before = getattr(law, first)
    with pytest.raises(UsageError, match=second):
        law.tune({first: kind.gains[first].high, second: math.nan})
    assert getattr(law, first) == before


def test_an_unknown_gain_is_named_with_its_nearest() -> None:
    with pytest.raises(UsageError, match="did you mean proportional"):
        Pid({"proportionl": 1.0})


@pytest.mark.parametrize("kind", LAWS)
def test_a_repeated_measurement_gets_the_same_answer_and_changes_nothing(kind: type[Law]) -> None:
    one, other = kind(), kind()
    for k in range(20):
        sample = Measurement(1e-3 * k, 1e-4 * k)
        answer = one.step(Setpoint(0.05), sample)
        assert one.step(Setpoint(0.05), sample) == answer
        assert other.step(Setpoint(0.05), sample) == answer


@pytest.mark.parametrize("kind", LAWS)
def test_reset_forgets_everything_but_the_gains(kind: type[Law]) -> None:
    law, fresh = kind(), kind()
    for k in range(50):
        law.step(Setpoint(0.2), Measurement(1e-3 * k, 1e-3 * k))
    law.reset()
    assert [law.step(Setpoint(0.1), Measurement(1e-3 * k, 0.0)) for k in range(5)] == [
        fresh.step(Setpoint(0.1), Measurement(1e-3 * k, 0.0)) for k in range(5)
    ]


@pytest.mark.parametrize("kind", LAWS)
def test_voltages_stay_within_the_limits(kind: type[Law]) -> None:
    law = kind(valve=ValveInverse(max_voltage=4.0))
    answers = [law.step(Setpoint(r), Measurement(1e-3 * k, 0.0)) for k, r in enumerate([10.0] * 50 + [-10.0] * 50)]
    assert max(answers) == 4.0
    assert min(answers) == -4.0
