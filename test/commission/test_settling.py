"""Two estimates become one: its interval reaches both, and what predictions tell nothing of is not determined."""

import math

import pytest

from pneumo_ros.commission.settling import _joined
from pneumo_ros.shooting.estimates import Estimate


def estimate(value: float, std: float) -> Estimate:
    """A static friction [N] known to 20 N before."""
    return Estimate(value, std, value - 1.96 * std, value + 1.96 * std, 35.0, 20.0)


def test_where_predictions_are_believed_they_give_the_value() -> None:
    found = _joined(estimate(32.0, 0.1), estimate(43.0, 0.2), believed=True)
    assert found.value == 43.0
    assert found.std == pytest.approx(math.hypot(0.2, 5.5, 0.043))


def test_where_they_are_not_the_interval_reaches_them_nevertheless() -> None:
    """Half of the difference would end at 98 % of the way, and mostly the predictions are nearer."""
    found = _joined(estimate(32.0, 0.1), estimate(41.0, 0.2), believed=False)
    assert found.value == 32.0
    assert found.low < 41.0 < found.high
    assert found.std == pytest.approx(math.hypot(0.1, 9.0, 0.032))


def test_what_predictions_tell_nothing_of_is_not_determined() -> None:
    along = estimate(0.5, 0.1)
    assert not _joined(along, estimate(0.5, math.inf), believed=True).determined
    assert _joined(along, estimate(0.5, 0.1), believed=True).determined
