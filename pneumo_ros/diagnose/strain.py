"""Effects that base parameters replace: the recordings cannot decide, but the priors of those parameters can.

Base parameters refitted far from their prior centres can imitate a missing effect. Between that fit and the true
parameters lies a valley along which predictions hardly change. It is too curved for one linear step, so the effect and
the base parameters are fitted together.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import at_best, relief_of, strain
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis, log_likelihood
from pneumo_ros.diagnose.screening import STRAINED
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

MOST_FOLLOWED, PART_REGAINED = 2, 0.2  # most effects followed; least share of the strain that their step regains
SIMPLE = 3  # most parameters of an effect: a profile can replace anything
SETS_OF_SLOPES = 12


def followed(
    fitter: Fitter, base: BaseFit, screened: Sequence[Hypothesis], anyway: float, known: Sequence[str]
) -> tuple[list[Hypothesis], list[Array]]:
    """Effects that relieve a strained base in a linear step, fitted together with it, and their held-out residuals.

    Effects `known` to be good are not followed. A step covers only the start of the valley: it has to regain only part
    of the strain, beyond the part the base regains `anyway`.
    """
    strained = strain(base.offset)
    if strained < STRAINED:
        return [], []
    best: dict[str, Hypothesis] = {}
    for h in sorted(screened, key=lambda h: -h.relief):
        simple = len(h.coordinates) <= SIMPLE and not any(c.logarithmic for c in h.coordinates)
        if simple and h.relief > anyway + PART_REGAINED * strained:
            best.setdefault(h.name, h)
    chosen = [h for h in list(best.values())[:MOST_FOLLOWED] if h.name not in known]
    models = [fitter.refit(fitter.extended(base.model, h), SETS_OF_SLOPES, share=0.0) for h in chosen]
    found = [_hypothesis(fitter, base, h, new) for h, new in zip(chosen, models, strict=True)]
    return [h for h, _ in found], [held for _, held in found]


def _hypothesis(fitter: Fitter, base: BaseFit, h: Hypothesis, new: Model) -> tuple[Hypothesis, Array]:
    """The hypothesis to judge, and its held-out residual; laws are as free in shape as without a candidate.

    Parameters of another form of the effect, which do nothing in this one, are not free.
    """
    fit, held = fitter.fits(new, fitter.added(base.model))
    own = tuple(c for c in h.coordinates if c.name in fit.names)
    shift, after, _value = at_best(fit, fit.residual)
    offset, bends = base.offset.copy(), slice(len(fit.names) - fit.bends, None)
    offset[base.own] = (fit.offset + shift)[[fit.names.index(n) for n in base.names[base.own]]]
    offset[base.own.stop :] = (fit.offset + shift)[bends]
    columns = [fit.names.index(c.name) for c in own]
    std = fitter.deviations(new)
    return Hypothesis(
        h.name, own, np.array([c.u(new[c.name]) for c in own]), offset - base.offset, after,
        likelihood=log_likelihood(fitter.train, after) - strain(offset),
        t=max((abs(new[c.name] - (c.neutral or 0.0)) / std[c.name] for c in own if c.is_size), default=0.0),
        relief=relief_of(base, offset - base.offset),
        slopes=fit.slopes[:, columns] / np.array([c.prior for c in own]),
    ), held.residual + held.slopes @ shift  # fmt: skip
