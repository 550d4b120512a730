"""Rows of added effects: those whose gain could not be computed have a dash."""

import pytest

from pneumo_ros.wording.additions import additions


@pytest.mark.parametrize(("score", "shown"), [({"nats": 41.4}, "41"), ({"nats": None}, "-"), (None, "-")])
def test_a_gain_that_is_not_known_is_a_dash(score: dict[str, float | None] | None, shown: str) -> None:
    one = {"effect": "viscous_friction", "parameters": {}, "holdout_error_before": 9.0, "holdout_error_after": 1.1}
    (row,) = additions([one | ({"score": score} if score else {})])
    assert row.nats == shown
