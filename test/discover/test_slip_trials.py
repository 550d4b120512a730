"""What breakaways and reversals alone speak for: only a size that they determine."""

import numpy as np
import pytest

from pneumo_ros.discover.coordinates import coordinates
from pneumo_ros.discover.slip_trials import Slipping, as_trial
from pneumo_ros.plant import load_model

MODEL = load_model("axis")
EFFECT = "dwell_time_breakaway"
RISE = 12.0  # N


@pytest.mark.parametrize(("std", "objects"), [(1.5, False), (13.8, True), (None, True)])
def test_a_size_that_nothing_determines_is_refused(std: float | None, objects: bool) -> None:
    """Everything else speaks for it: each event fits ten times better."""
    model = MODEL.with_effects([*MODEL.effects, EFFECT], {f"{EFFECT}.rise": RISE})
    before, after = np.full(40, 10.0), np.full(40, 1.0)
    known = {} if std is None else {f"{EFFECT}.rise": std}
    trial = as_trial(
        Slipping(EFFECT, model, after, after, known), coordinates(MODEL.library.find(EFFECT)), before, before, True
    )
    assert any("uncertainty" in words for words in trial.objections) is objects
    assert bool(trial.objections) is objects
