"""The current model fitted to the evidence: base parameters and accepted effects, within their priors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import (
    OVERLAP,
    BaseFit,
    Hypothesis,
    family_scales,
    huber,
    log_likelihood,
    solve,
    solve_within,
    vectors,
    weights,
)
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

ITERATIONS = 8  # sets of slopes
FAITHFUL = 0.8  # of the decrease that slopes promise: who keeps less asks for new ones


@dataclass(frozen=True)
class Known:
    """What is known before any data of the parameters that may move: centres, standard deviations; arrays (free,).

    `step`: by how much each is moved to see what it does.
    """

    names: tuple[str, ...]
    centre: Array
    prior: Array
    step: Array

    def offset(self, model: Model) -> Array:
        """How far the parameters (free,) of `model` are from the centres, in standard deviations."""
        return np.asarray((np.array([model[n] for n in self.names]) - self.centre) / self.prior)


def strain(offset: Array) -> float:
    """Log likelihood that parameters cost by their priors; offset (free,): how far they are from the centres."""
    return 0.5 * float(np.sum(offset**2))


def residuals(evidence: Evidence, model: Model, variants: Sequence[Mapping[str, float]]) -> Array:
    """Residuals (variants, residuals) of `model` with some values changed."""
    return evidence.residuals(model, vectors(model, variants))


def slopes(evidence: Evidence, model: Model, known: Known) -> tuple[Array, Array]:
    """Residual (residuals,) of `model`, and its derivative (residuals, free) by each free parameter per prior."""
    ends = np.array([model.specification(n).high for n in known.names])
    here = np.array([model[n] for n in known.names])
    steps = np.where(here + known.step > ends, -known.step, known.step)
    r = residuals(evidence, model, [{}, *({n: x} for n, x in zip(known.names, here + steps, strict=True))])
    return r[0], np.asarray(((r[1:] - r[0]) / (steps / known.prior)[:, None]).T)


def fit_base(evidence: Evidence, model: Model, known: Known, iterations: int = ITERATIONS) -> Model:
    """Gauss-Newton from `model`, within what is known; the model found.

    Slopes are taken anew only where those of an earlier model bring no more: they hardly change, and cost most.
    """
    here, names, middle, prior = model, known.names, known.centre, known.prior
    low = np.array([model.specification(n).low for n in names])
    high = np.array([model.specification(n).high for n in names])
    r, J = slopes(evidence, here, known)
    taken, fresh = 1, True
    while True:
        theta = np.array([here[n] for n in names])
        offset, scale = (theta - middle) / prior, family_scales(evidence, r)
        after, x, room = r, np.zeros(len(names)), ((low - theta) / prior, (high - theta) / prior)
        for _ in range(3):
            x = solve_within(J, r, weights(evidence, after, scale), np.ones(len(names)), offset, *room)
            after = r + J @ x
        before, expected = _cost(evidence, r, offset, scale), _cost(evidence, after, offset + x, scale)
        steps = [np.clip(theta + share * x * prior, low, high) for share in (1.0, 0.3, 0.1)]
        tried = residuals(evidence, here, [dict(zip(names, new.tolist(), strict=True)) for new in steps])
        costs = [_cost(evidence, t, (new - middle) / prior, scale) for t, new in zip(tried, steps, strict=True)]
        best = int(np.argmin(costs))
        gain = before - costs[best]
        if gain > 0.0:
            here, r = here.with_parameters(dict(zip(names, steps[best].tolist(), strict=True))), tried[best]
        little = gain < 0.5 + 1e-4 * before
        if (little and fresh) or (taken == iterations and (little or not fresh)):
            return here
        fresh = taken < iterations and (little or gain < FAITHFUL * (before - expected))
        if fresh:
            r, J = slopes(evidence, here, known)
            taken += 1


def _cost(evidence: Evidence, r: Array, offset: Array, scale: Array) -> float:
    return float(OVERLAP**2 * np.sum(huber(r / scale[evidence.family]))) + strain(offset)


def base_fit(evidence: Evidence, whole: Model, model: Model, known: Known) -> BaseFit:
    """What hypotheses start from; `whole` is a model that holds `model` and every candidate."""
    r, J = slopes(evidence, model, known)
    held = whole.with_parameters({n: v for n, v in model.parameters.items() if n in whole.parameters})
    return BaseFit(model, held, known.names, known.prior, known.offset(model), evidence, r, J)


def at_best(base: BaseFit, here: Array) -> tuple[Array, Array, float]:
    """Base parameters' best shift beside a candidate's residual, what they leave, and its log likelihood."""
    after, shift = here, np.zeros(len(base.names))
    for _ in range(4):
        scale = family_scales(base.evidence, after)
        weight = weights(base.evidence, after, scale)
        shift, _A, _bread = solve(base.slopes, here, weight, np.ones(len(base.names)), base.offset)
        after = here + base.slopes @ shift
    value = log_likelihood(base.evidence, after) - strain(shift + base.offset)
    return shift, after, value


def unaided(base: BaseFit) -> Hypothesis:
    """What base parameters reach without any candidate, by one linear step like the candidates': nothing is missing."""
    shift, after, value = at_best(base, base.residual)
    return Hypothesis("", (), np.empty(0), shift, after, value, relief=relief_of(base, shift))


def relief_of(base: BaseFit, shift: Array) -> float:
    """Log likelihood of the priors that the model's own parameters regain by a shift; bent laws do not count."""
    return strain(base.offset[base.own]) - strain((shift + base.offset)[base.own])
