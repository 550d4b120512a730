"""How late a position is recorded against the force that drives an axis: less than a sample is no effect, but matters.

When within a sample a force was measured is not known: where the axis jerks, half a millisecond is newtons, which
friction would have to make up for. A delay of a sample or more is an effect, and found as one.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pneumo_ros.diagnose.basefit import fit_base
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run

EFFECT = "position_sensor_delay"
SEEN = 5.0  # deviations from none


def lateness(model: Model, train: Sequence[Run]) -> float:
    """How much later than the force positions are recorded [s], within a sample; 0 where none is seen.

    Of axes driven by a force: a valve's command is held from when it was sent.
    """
    if not model.force_driven or EFFECT in model.effects:
        return 0.0
    fitter = Fitter(model, train, candidates=[EFFECT])
    begin = model.with_effects([*model.effects, EFFECT], {f"{EFFECT}.delay": 0.5 * train[0].sample_time})
    found = fit_base(fitter.train, begin, fitter.known(begin)).model
    late, std = found[f"{EFFECT}.delay"], fitter.deviations(found)[f"{EFFECT}.delay"]
    return late if SEEN * std < late < train[0].sample_time else 0.0


def later(run: Run, seconds: float) -> Run:
    """The run with its input that much later, to tenths of a sample."""
    parts = min(round(seconds / run.sample_time * PARTS), len(run.input) - 1)
    if parts < 1:
        return run
    return replace(run, input=np.concatenate([np.full(parts, run.input[0]), run.input[:-parts]]))
