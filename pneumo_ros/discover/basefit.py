"""The current model fitted to the evidence: base parameters and accepted effects, within their priors."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.evidence import Evidence
from pneumo_ros.discover.hypothesis import OVERLAP, BaseFit, everything, family_scales, huber, missing, solve, vectors, weights
from pneumo_ros.plant import Model

Array = NDArray[np.float64]


def slopes(evidence: Evidence, model: Model, names: Sequence[str], prior: Array, around: Model) -> Array:
    """Derivative (residuals, free) of the residual by each named parameter per prior deviation; `model` is `around`
    with more effects, neutral."""
    variants: list[dict[str, float]] = [{}]
    steps = np.where(
        [around[n] + 0.02 * p > around.specification(n).high for n, p in zip(names, prior, strict=True)], -0.02, 0.02
    )
    variants += [{n: around[n] + s * p} for n, s, p in zip(names, steps, prior, strict=True)]
    r = evidence.residuals(model, vectors(model, variants))
    return np.asarray(((r[1:] - r[0]) / steps[:, None]).T)


def fit_base(
    evidence: Evidence, model: Model, names: Sequence[str], centre: Mapping[str, float], prior: Array, iterations: int = 4
) -> tuple[Model, Array]:
    """Gauss-Newton from `model`, with priors about `centre`; the model found and its residual."""
    here, r = model, evidence.residual(model)
    middle = np.array([centre[n] for n in names])
    low = np.array([model.specification(n).low for n in names])
    high = np.array([model.specification(n).high for n in names])
    for _ in range(iterations):
        J = slopes(evidence, here, names, prior, here)
        theta = np.array([here[n] for n in names])
        offset, scale = (theta - middle) / prior, family_scales(evidence, r)
        x = np.zeros(len(names))
        after = r
        for _ in range(3):
            x, _A, _bread = solve(J, r, weights(evidence, after, scale), np.ones(len(names)), offset)
            after = r + J @ x
        before = _cost(evidence, r, offset, scale)
        for share in (1.0, 0.3, 0.1):
            new = np.clip(theta + share * x * prior, low, high)
            there = here.with_parameters(dict(zip(names, new.tolist(), strict=True)))
            tried = evidence.residual(there)
            cost = _cost(evidence, tried, (new - middle) / prior, scale)
            if cost < before:
                break
        else:
            break
        here, r = there, tried
        if before - cost < 0.5 + 1e-4 * before:
            break
    return here, r


def _cost(evidence: Evidence, r: Array, offset: Array, scale: Array) -> float:
    return float(OVERLAP**2 * np.sum(huber(r / scale[evidence.family])) + 0.5 * np.sum(offset**2))


def base_fit(evidence: Evidence, model: Model, names: Sequence[str], centre: Mapping[str, float], prior: Array) -> BaseFit:
    """What hypotheses start from."""
    whole = everything(model, missing(model))
    offset = (np.array([model[n] for n in names]) - np.array([centre[n] for n in names])) / prior
    return BaseFit(
        model, whole, tuple(names), prior, offset, evidence, evidence.residual(model),
        slopes(evidence, whole, names, prior, model),
    )  # fmt: skip
