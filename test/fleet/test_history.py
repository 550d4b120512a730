"""The scatter of machines from campaign to campaign, beyond their intervals."""

from typing import Any

import numpy as np
import pytest

from pneumo_ros.fleet.history import ENOUGH, unrepeated

RNG = np.random.default_rng(0)


def track(values: np.ndarray, half: float) -> list[dict[str, Any]]:
    """A parameter over campaigns, each value with an interval of that half width."""
    return [{"value": float(v), "low": float(v) - half, "high": float(v) + half} for v in values]


@pytest.mark.parametrize("known", [0.0, 0.02])
def test_it_is_the_deviation_of_one_campaign_beyond_its_interval(known: float) -> None:
    """Values scatter by 3 % and by their intervals; only the difference of two values scatters by more."""
    values = 70.0 * (1.0 + RNG.normal(0.0, np.hypot(0.03, known), (100, 10)))
    scatter = unrepeated([track(row, 1.96 * 70.0 * known) for row in values])
    assert scatter == pytest.approx(0.03, rel=0.1)


def test_machines_that_repeat_as_their_intervals_say_do_not_scatter() -> None:
    assert unrepeated([track(70.0 * (1.0 + RNG.normal(0.0, 0.01, 10)), 1.96 * 0.03 * 70.0) for _ in range(50)]) == 0.0


def test_a_few_changes_say_nothing() -> None:
    assert unrepeated([track(np.linspace(50.0, 90.0, ENOUGH), 0.1)]) == 0.0
    assert unrepeated([track(np.linspace(50.0, 90.0, ENOUGH + 1), 0.1)]) > 0.01
