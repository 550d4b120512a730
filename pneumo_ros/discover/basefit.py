"""The current model fitted to the evidence: base parameters and accepted effects, within their priors."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.evidence import Evidence
from pneumo_ros.discover.hypothesis import OVERLAP, BaseFit, family_scales, huber, solve, vectors, weights
from pneumo_ros.plant import Model

Array = NDArray[np.float64]


def residuals(evidence: Evidence, model: Model, variants: Sequence[Mapping[str, float]]) -> Array:
    """Residuals (variants, residuals) of `model` with some values changed."""
    return evidence.residuals(model, vectors(model, variants))


def slopes(evidence: Evidence, model: Model, names: Sequence[str], prior: Array) -> tuple[Array, Array]:
    """Residual (residuals,) of `model`, and its derivative (residuals, free) by each named parameter per prior."""
    steps = np.where(
        [model[n] + 0.02 * p > model.specification(n).high for n, p in zip(names, prior, strict=True)], -0.02, 0.02
    )
    moved = [{n: model[n] + s * p} for n, s, p in zip(names, steps, prior, strict=True)]
    r = residuals(evidence, model, [{}, *moved])
    return r[0], np.asarray(((r[1:] - r[0]) / steps[:, None]).T)


def fit_base(
    evidence: Evidence, model: Model, names: Sequence[str], centre: Mapping[str, float], prior: Array,
    iterations: int = 6,
) -> Model:  # fmt: skip
    """Gauss-Newton from `model`, with priors about `centre`; the model found."""
    here = model
    middle = np.array([centre[n] for n in names])
    low = np.array([model.specification(n).low for n in names])
    high = np.array([model.specification(n).high for n in names])
    r, J = slopes(evidence, here, names, prior)
    for _ in range(iterations):
        theta = np.array([here[n] for n in names])
        offset, scale = (theta - middle) / prior, family_scales(evidence, r)
        after, x = r, np.zeros(len(names))
        for _ in range(3):
            x, _A, _bread = solve(J, r, weights(evidence, after, scale), np.ones(len(names)), offset)
            after = r + J @ x
        before = _cost(evidence, r, offset, scale)
        steps = [np.clip(theta + share * x * prior, low, high) for share in (1.0, 0.3, 0.1)]
        tried = residuals(evidence, here, [dict(zip(names, new.tolist(), strict=True)) for new in steps])
        costs = [_cost(evidence, t, (new - middle) / prior, scale) for t, new in zip(tried, steps, strict=True)]
        best = int(np.argmin(costs))
        if costs[best] >= before:
            break
        here = here.with_parameters(dict(zip(names, steps[best].tolist(), strict=True)))
        if before - costs[best] < 0.5 + 1e-4 * before:
            break
        r, J = slopes(evidence, here, names, prior)
    return here


def _cost(evidence: Evidence, r: Array, offset: Array, scale: Array) -> float:
    return float(OVERLAP**2 * np.sum(huber(r / scale[evidence.family])) + 0.5 * np.sum(offset**2))


def base_fit(
    evidence: Evidence, whole: Model, model: Model, names: Sequence[str], centre: Mapping[str, float], prior: Array
) -> BaseFit:
    """What hypotheses start from; `whole` is a model that holds `model` and every candidate."""
    offset = (np.array([model[n] for n in names]) - np.array([centre[n] for n in names])) / prior
    r, J = slopes(evidence, model, names, prior)
    held = whole.with_parameters({n: v for n, v in model.parameters.items() if n in whole.parameters})
    return BaseFit(model, held, tuple(names), prior, offset, evidence, r, J)
