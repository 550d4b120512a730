"""The last fit: the equations along the motion beside predictions of it, two estimates from the same recordings.

The equations in weak form find the machine from far; predictions by multiple shooting are sharper, but may end beside
the optimum. Where they end above the noise, another fit begins there, and the better one counts. Where they come down
to the noise, their values are taken, and half the difference between the two estimates counts as uncertainty. Where
they do not, the values along the motion are taken, and all of the difference counts: predictions know when the piston
slips, which decides static friction and Stribeck velocity, and are mostly the nearer ones even then.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pneumo_ros.commission.information import NORMAL, Knowledge
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.estimates import Estimate, Refit
from pneumo_ros.shooting.refit import default_prior, refit

AT_NOISE = 2.0  # times the cost of noise alone, up to which predictions are believed
AGAIN = 2  # fits at most from where one ended above the noise
ACCURACY = 0.001  # of a value: sums over samples of 1 to 2 ms are no better


def settled(model: Model, known: Knowledge, runs: Sequence[Run]) -> Knowledge:
    """`known`, fitted again by predictions of `runs`; `model` is the machine as data sheets tell it."""
    sharper = _sharpest(model, known, runs)
    if sharper is None:
        return known
    believed = _cost(sharper, runs) < AT_NOISE
    estimates = {name: _joined(one, sharper.estimates[name], believed) for name, one in known.estimates.items()}
    values = {name: one.value for name, one in estimates.items()}
    return replace(known, model=known.model.with_parameters(values), estimates=estimates)


def _sharpest(model: Model, known: Knowledge, runs: Sequence[Run]) -> Refit | None:
    """The best of the fits, each begun where the last one ended, up to the first at the noise; None where none can."""
    best, begin = None, known.model
    for _ in range(1 + AGAIN):
        try:
            found = _predicting(model, begin, tuple(known.estimates), runs)
        except PneumoError:
            break
        if best is not None and not _cost(found, runs) < _cost(best, runs):
            break
        best, begin = found, found.model
        if _cost(best, runs) < AT_NOISE:
            break
    return best


def _predicting(model: Model, begin: Model, names: tuple[str, ...], runs: Sequence[Run]) -> Refit:
    """Predictions of `runs` fitted from `begin`, within what data sheets say.

    `begin` was fitted to the same runs: priors about it would count them twice, and hold what data sheets tell better.
    """
    priors = {name: default_prior(model, name) for name in names}
    return refit(begin, runs, free=names, priors=priors, centres={name: model[name] for name in names})


def _cost(sharper: Refit, runs: Sequence[Run]) -> float:
    """The cost of the refit over that of noise alone: half a square for each measured value."""
    each = np.mean([len(run.signals) * 0.5 / run.sample_time for run in runs])  # values in a segment of half a second
    return float(sharper.costs[-1] / (0.5 * each * max(sharper.segments - sharper.left_out, 1)))


def _joined(along: Estimate, predicted: Estimate, believed: bool) -> Estimate:
    """One estimate of two; all values are those of one fit, as errors of some make up for errors of others."""
    value = predicted.value if believed else along.value
    apart = (0.5 if believed else 1.0) * abs(predicted.value - along.value)
    own = max(along.std, min(predicted.std, along.prior) if believed else 0.0)  # infinite: not determined
    std = float(np.sqrt(own**2 + apart**2 + (ACCURACY * value) ** 2))
    return replace(along, value=value, std=std, low=value - NORMAL * std, high=value + NORMAL * std)
