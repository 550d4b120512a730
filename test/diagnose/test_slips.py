"""Friction refitted to breakaways and reversals; a table replaces the simulations."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from pneumo_ros.diagnose import slips
from pneumo_ros.plant import Model, load_model

STATIC = "lugre_friction.static_friction"
AXIS = load_model("axis")


@pytest.mark.parametrize(
    ("errors", "rounds"),
    [
        ((88.0, 7.8, 1.02, 1.0), 2),  # a local minimum on the way
        ((88.0, 1.2, 1.0), 1),  # arrived
        ((88.0, 60.0, 20.0), 1),  # something else is missing
        ((88.0, 30.0, 90.0, 1.0), 1),  # restarted, and worse
        ((88.0, 90.0, 1.0), 0),
    ],
)
def test_a_refit_that_moved_far_is_restarted_where_it_ended(
    errors: tuple[float, ...], rounds: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refitted(model: Model, *_others: Any) -> Any:
        return SimpleNamespace(model=model.with_parameters({STATIC: model[STATIC] + 1.0}))

    def played(model: Model, segments: Any) -> np.ndarray:
        return np.full(3, errors[round(model[STATIC] - AXIS[STATIC])])

    monkeypatch.setattr(slips, "refit_segments", refitted)
    monkeypatch.setattr(slips, "errors", played)
    events = cast(slips.Slips, SimpleNamespace(train=lambda model: None))
    found = slips.polished(AXIS, events, {})
    assert found[STATIC] == pytest.approx(AXIS[STATIC] + rounds)


@pytest.mark.parametrize(
    ("train", "held", "fitted", "judged"), [(4, 40, False, False), (5, 4, True, False), (12, 12, True, True)]
)
def test_few_events_determine_friction_and_more_an_effect(
    train: int, held: int, fitted: bool, judged: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = iter((np.arange(train), np.arange(held)))
    monkeypatch.setattr(slips, "event_rows", lambda *_: next(rows))
    found = slips.slips(AXIS, [], [])
    assert (found is not None) is fitted
    assert (found is not None and found[1].judge) is judged


def test_friction_of_zero_has_the_prior_of_its_default() -> None:
    """A fit may drive static friction to 0, and a machine may have none."""
    without = AXIS.with_parameters({STATIC: 0.0})
    assert slips.friction_priors(without, {})[STATIC] == pytest.approx(5.0)
    assert slips.friction_priors(without, {STATIC: 0.3})[STATIC] == 0.3
    assert slips.friction_priors(AXIS, {STATIC: 0.1})[STATIC] == pytest.approx(0.5)
