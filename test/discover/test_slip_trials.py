"""What breakaways and reversals alone speak for: a size that they determine, and only of what enough of them show."""

import numpy as np
import pytest
from numpy.typing import NDArray

from pneumo_ros.discover.coordinates import coordinates
from pneumo_ros.discover.slip_trials import Slipping, as_trial, deviations_better
from pneumo_ros.discover.trial import Trial
from pneumo_ros.plant import Model, load_model

Array = NDArray[np.float64]

MODEL = load_model("axis")
EFFECT = "dwell_time_breakaway"
RISE = 12.0  # N
SAMPLES = 300


def tried(model: Model, before: Array, after: Array, std: dict[str, float], q: float = 0.5) -> Trial:
    effect = coordinates(MODEL.library.find(EFFECT))
    return as_trial(Slipping(EFFECT, model, after, after, std), effect, before, before, q, SAMPLES, True)


@pytest.mark.parametrize(("std", "objects"), [(1.5, False), (13.8, True), (None, True)])
def test_a_size_that_nothing_determines_is_refused(std: float | None, objects: bool) -> None:
    """Everything else speaks for it: each event fits ten times better."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    before, after = np.full(40, 10.0), np.full(40, 1.0)
    known = {} if std is None else {f"{EFFECT}.rise": std}
    trial = tried(model, before, after, known)
    assert any("uncertainty" in words for words in trial.objections) is objects
    assert bool(trial.objections) is objects


@pytest.mark.parametrize(("changed", "objects"), [(16, False), (3, True)])
def test_an_effect_that_touches_two_events_in_five_is_told_by_their_upper_quartile(changed: int, objects: bool) -> None:
    """The others scatter about the noise with it as without it."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    rng = np.random.default_rng(1)
    before, after = (1.05 + 0.003 * rng.standard_normal(40) for _ in range(2))
    before[:changed] = 30.0
    assert bool(tried(model, before, after, {f"{EFFECT}.rise": 1.5}, 0.75).objections) is objects


def test_events_that_nothing_changes_and_single_wild_ones_decide_nothing() -> None:
    before = np.ones(40)
    assert deviations_better(before, before, SAMPLES) == 0.0
    wild = before.copy()
    wild[0] = 1e6
    assert deviations_better(wild, before, SAMPLES) == pytest.approx(1.0)
    assert deviations_better(before, wild, SAMPLES) == pytest.approx(-1.0)
    assert deviations_better(np.full(40, 2.0), before, SAMPLES) == pytest.approx(np.sqrt(40.0))
