"""Candidates fitted to the evidence by Gauss-Newton, many at once, each with its own best base parameters."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import OwnNoise, at_best, relief_of
from pneumo_ros.diagnose.freedom import profile_slopes
from pneumo_ros.diagnose.hypothesis import (
    COORDINATE_PROBE,
    BaseFit,
    Hypothesis,
    Slopes,
    along,
    block_sums,
    gathered,
    own_weights,
    solve_within,
    vectors,
)  # fmt: skip
from pneumo_ros.diagnose.significance import covariances, significance
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

NEAR = 0.1  # usual sizes, or of a logarithm: over so small a step slopes hardly change
FEW_SIZES = 3  # sizes: an effect with more starts from the linear fit only


def refine(
    base: BaseFit, hypotheses: Sequence[Hypothesis], iterations: int = 5, settled: bool = False
) -> list[Hypothesis]:
    """Gauss-Newton of all coordinates of some candidates at once, each with its own step control.

    Unless they are `settled`, each starts at the best of a few sizes, and is fitted only as exactly as ranking needs.
    """
    best = [replace(h, likelihood=-np.inf, slopes=profile_slopes(base, h.coordinates)) for h in hypotheses]
    noise = OwnNoise(base.evidence, base.model, base.residual)
    begins = [h.u.copy() for h in hypotheses] if settled else _best_sizes(base, hypotheses, noise)
    moving = list(range(len(best)))
    for _k in range(iterations):
        variants: list[dict[str, float]] = []
        spans = {}
        for i in moving:
            probes = [] if keeps_slopes(best[i], begins[i]) else _probes(best[i], begins[i])
            spans[i] = len(variants)
            variants += [_values(best[i], v) for v in (begins[i], *probes)]
        if not moving:
            break
        residual = base.evidence.residuals(base.everything, vectors(base.everything, variants), ranking=not settled)
        own = [residual[spans[i] : spans[i] + 1 + len(begins[i])] for i in moving]
        with ThreadPoolExecutor(2) as pool:
            taken = list(pool.map(lambda i, r: _advanced(base, best[i], begins[i], r, noise), moving, own))
        for i, (h, u, _) in zip(moving, taken, strict=True):
            best[i], begins[i] = h, u
        moving = [i for i, (_, _, settles) in zip(moving, taken, strict=True) if not settles]
    return best


def _advanced(
    base: BaseFit, h: Hypothesis, u: Array, residual: Array, noise: OwnNoise
) -> tuple[Hypothesis, Array, bool]:
    """The better of a hypothesis and of itself at u, where to try it next, and whether it has settled.

    residual (1 or 1 + coordinates, residuals): at u, and at its probes if the slopes are not kept; those are changed.
    """
    unit = noise.unit(_at(base, h, u))
    C = h.slopes if keeps_slopes(h, u) else _slopes(base, h, u, residual, noise)
    tried = _judge(base, h, u, residual[0], C, unit)
    better = tried.likelihood > h.likelihood
    found, begin = (tried, _next(base, tried, C, residual[0], unit)) if better else (h, 0.5 * (u + h.u))
    little = 0.0 < tried.likelihood - h.likelihood < 0.3
    return found, begin, bool(little or np.max(np.abs(begin - found.u)) < 3e-3)


def keeps_slopes(h: Hypothesis, u: Array) -> bool:
    """Whether the slopes at a hypothesis serve at u, too: those of a profile hardly change anywhere."""
    return len(h.slopes) > 0 and (_is_profile(h) or float(np.max(np.abs(u - h.u))) <= NEAR)


def _is_profile(h: Hypothesis) -> bool:
    return len(h.u) > FEW_SIZES and all(c.is_size and not c.logarithmic for c in h.coordinates)


def _at(base: BaseFit, h: Hypothesis, u: Array) -> Model:
    """The base's model with a candidate at u."""
    return base.everything.with_parameters(_values(h, u))


def _slopes(base: BaseFit, h: Hypothesis, u: Array, residual: Array, noise: OwnNoise) -> Array:
    """Derivatives (residuals, coordinates) from the residuals at u and at each of its probes.

    With what a change of the noise in which residuals count makes.
    """
    probes = _probes(h, u)
    there = noise.of([_at(base, h, v) for v in probes], residual[1:])
    there *= noise.unit(_at(base, h, u))
    moved = np.array([v[j] - u[j] for j, v in enumerate(probes)])
    return np.asarray(((there - residual[0]) / np.where(moved == 0.0, 1.0, moved)[:, None]).T)


def _best_sizes(base: BaseFit, hypotheses: Sequence[Hypothesis], noise: OwnNoise) -> list[Array]:
    """For each hypothesis the best of a few sizes: an effect that is linear near neutral may not be so farther away."""
    options: list[list[Array]] = []
    for h in hypotheses:
        size = np.array([c.is_size for c in h.coordinates])
        linear = np.array([c.is_size and not c.logarithmic for c in h.coordinates])
        fading = size & ~linear
        own = [h.u]
        if size.sum() <= FEW_SIZES:
            own += [np.where(linear, share * h.u, h.u) for share in (0.4, 0.1)]
            own += [np.where(linear, share * np.where(h.u < 0.0, -1.0, 1.0), h.u) for share in (1.0, 0.3)]
            own += [np.where(fading, h.u + shift, h.u) for shift in (-0.7, 0.7, 1.4) if fading.any()]
        options.append([np.array([c.clip(x) for c, x in zip(h.coordinates, u, strict=True)]) for u in own])
    each = [(h, u) for h, own in zip(hypotheses, options, strict=True) for u in own]
    variants = [_values(h, u) for h, u in each]
    if not variants:
        return []
    residual = base.evidence.residuals(base.everything, vectors(base.everything, variants), ranking=True)
    with ThreadPoolExecutor(2) as pool:
        likelihood = list(pool.map(lambda r, one: at_best(base, r, noise.unit(_at(base, *one)))[2], residual, each))
    found, at = [], 0
    for own in options:
        found.append(own[int(np.argmax(likelihood[at : at + len(own)]))])
        at += len(own)
    return found


def _values(h: Hypothesis, u: Array) -> dict[str, float]:
    return {c.name: c.value(x) for c, x in zip(h.coordinates, u, strict=True)}


def _probes(h: Hypothesis, u: Array) -> list[Array]:
    """u with each coordinate in turn moved by a small step, away from a bound."""
    found = []
    for j, c in enumerate(h.coordinates):
        v = u.copy()
        v[j] = c.clip(u[j] + COORDINATE_PROBE)
        if abs(v[j] - u[j]) < 0.5 * COORDINATE_PROBE:
            v[j] = c.clip(u[j] - COORDINATE_PROBE)
        found.append(v)
    return found


def _system(base: BaseFit, h: Hypothesis, u: Array, C: Array) -> tuple[Slopes, Array, Array]:
    """Slopes, ridge and offset of base parameters and candidate together, about base values and u."""
    p, priors = len(base.names), np.array([c.prior for c in h.coordinates])
    ridge = np.concatenate([np.ones(p), 1.0 / priors**2])
    return (base.slopes, C), ridge, np.concatenate([base.offset, u])


def _judge(base: BaseFit, h: Hypothesis, u: Array, here: Array, C: Array, unit: Array | float) -> Hypothesis:
    """The hypothesis at u, base parameters at their best there."""
    p = len(base.names)
    shift, after, value = at_best(base, here, unit)
    value -= sum(0.5 * (x / c.prior) ** 2 for c, x in zip(h.coordinates, u, strict=True))
    K, ridge, _offset = _system(base, h, u, C)
    w = own_weights(base.evidence, after, unit)
    normal, sums = gathered(K, w, after)[0], block_sums(K, w, w * after, base.evidence.block)
    of_all = of_sizes = covariances(base, normal, sums, ridge)
    sizes = [j for j, c in enumerate(h.coordinates) if c.is_size]
    if len(sizes) < len(u):
        # Without the effect there is no shape to be uncertain of. A free shape that is correlated with a small size,
        # as a share of flow with its conductance, would hide the largest gain.
        kept = [*range(p), *(p + j for j in sizes)]
        of_sizes = covariances(base, normal[np.ix_(kept, kept)], sums[:, kept], ridge[kept])
    t = significance([h.coordinates[j] for j in sizes], u[sizes], *of_sizes)
    relief = relief_of(base, shift)
    return replace(
        h, u=u.copy(), shift=shift, residual=after, likelihood=value, t=t, covariance=of_all[0], slopes=C, relief=relief
    )


def _next(base: BaseFit, h: Hypothesis, C: Array, here: Array, unit: Array | float) -> Array:
    """u of the next Gauss-Newton step, within the bounds."""
    K, ridge, offset = _system(base, h, h.u, C)
    after, first = h.residual, len(base.names)
    step = np.zeros(len(h.u))
    for _ in range(3):
        w = own_weights(base.evidence, after, unit)
        x = bounded_step(h, K, here, w, ridge, offset)
        after, step = here + along(K, x), x[first:]
    logs = np.array([c.logarithmic for c in h.coordinates])
    step = np.where(logs, np.clip(step, -1.0, 1.0), np.clip(step, -3.0, 3.0))
    return np.array([c.clip(v) for c, v in zip(h.coordinates, h.u + step, strict=True)])


def bounded_step(h: Hypothesis, K: Slopes, here: Array, w: Array, ridge: Array, offset: Array) -> Array:
    """The best step with the candidate's coordinates kept within their bounds."""
    low, high = np.full(len(ridge), -np.inf), np.full(len(ridge), np.inf)
    ends = np.array([c.ends for c in h.coordinates])
    low[-len(h.u) :], high[-len(h.u) :] = (ends - h.u[:, None]).T
    return solve_within(K, here, w, ridge, offset, low, high)


def held_out(base: BaseFit, held: BaseFit, hypotheses: Sequence[Hypothesis]) -> list[Array]:
    """Residuals of hypotheses on held-out runs, with the fitted parameters."""
    if not hypotheses:
        return []
    model, evidence = base.everything, held.evidence
    residual = evidence.residuals(model, vectors(model, [h.values for h in hypotheses]))
    return [r + held.slopes @ h.shift for r, h in zip(residual, hypotheses, strict=True)]
