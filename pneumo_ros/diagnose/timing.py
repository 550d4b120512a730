"""Delay of the recorded position against the drive force of an axis: below one sample it is no effect, but matters.

The instant of a force measurement within a sample is not known. Where the axis jerks, half a millisecond makes several
newtons, which friction would have to compensate. A delay of a sample or more is an effect, and found as an effect.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import fit_base
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run

Array = NDArray[np.float64]

EFFECT = "position_sensor_delay"
SEEN = 5.0  # deviations from zero: a smaller delay is ignored


def lateness(model: Model, train: Sequence[Run]) -> float:
    """Delay of the positions against the force [s], below one sample; 0 where none is significant.

    For axes that a measured force drives: a command acts from the time it was sent, and a goal too.
    """
    if not model.force_driven or model.self_driven or EFFECT in model.effects:
        return 0.0
    fitter = Fitter(model, train, candidates=[EFFECT])
    begin = model.with_effects([*model.effects, EFFECT], {f"{EFFECT}.delay": 0.5 * train[0].sample_time})
    found = fit_base(fitter.train, begin, fitter.known(begin, fixed=(f"{EFFECT}.low_pass",))).model
    late, std = found[f"{EFFECT}.delay"], fitter.deviations(found)[f"{EFFECT}.delay"]
    return late if SEEN * std < late < train[0].sample_time else 0.0


def later(run: Run, seconds: float) -> Run:
    """The run with its inputs delayed by `seconds`, to tenths of a sample."""
    parts = min(round(seconds / run.sample_time * PARTS), len(run.input) - 1)
    if parts < 1:
        return run
    further = {name: _shifted(held, parts) for name, held in run.further.items()}
    return replace(run, input=_shifted(run.input, parts), further=further)


def _shifted(held: Array, parts: int) -> Array:
    return np.concatenate([np.full(parts, held[0]), held[:-parts]])
