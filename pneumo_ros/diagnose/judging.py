"""Candidates judged: stability of their sizes, comparison with traces shifted in time, gain on held-out runs."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import GAIN_LEAST, T_LEAST, Candidate
from pneumo_ros.diagnose.coordinates import Coordinate, coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import (
    BaseFit,
    Hypothesis,
    cluster_robust,
    family_scales,
    log_likelihood,
    wald,
    weights,
)
from pneumo_ros.diagnose.measures import acting, advantage, equation_of, explained, force, gains, usual_gains
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

TEXTURE = 0.01  # of the drive force: a smaller force must explain most of the misfit, or it counts as friction texture
DECOYS = 12
WELL_KNOWN = 0.5  # of a size: runs that determine it less well do not count against it
FEW_RUNS = 3
NONE_WITHIN = 2.0  # deviations from zero: a smaller size may be zero


def judged(
    base: BaseFit,
    held: BaseFit,
    hypotheses: Sequence[Hypothesis],
    residuals: Sequence[Array],
    nothing: Hypothesis,
    first: bool,
) -> list[Candidate]:
    """Refined hypotheses as candidates, with their held-out residuals, best score first.

    All are compared with `nothing`: base parameters at their best without any candidate, whose residuals `held` has.
    """
    rng, found = np.random.default_rng(0), []
    reference = nothing.likelihood + log_likelihood(held.evidence, held.residual)
    for h, r in zip(hypotheses, residuals, strict=True):
        there = acting(held.residual, r)
        found.append(
            Candidate(
                hypothesis=replace(h, relief=h.relief - nothing.relief),
                held=r,
                gain=gains(held.evidence, held.residual, r),
                local=max(gains(held.evidence, held.residual, r, there).values(), default=0.0),
                usual=usual_gains(held.evidence, held.residual, r),
                z=advantage(held.evidence, held.residual, r)[1],
                size=magnitude(h.coordinates, h.u),
                stable=stable(base, h),
                share=explained(held.evidence, held.residual, r, there),
                first=first,
                decoy=decoy(base, h, rng) if h.t >= T_LEAST else 0.0,
                score=h.likelihood + log_likelihood(held.evidence, r) - reference,
                force=force(held.evidence, held.residual, r) / (TEXTURE * held.evidence.drive),
                lag=_lag(h, base.evidence.runs[0].sample_time),
                elsewhere=_elsewhere(base.evidence, h),
            )
        )
    return sorted(found, key=lambda candidate: -candidate.score)


def sizes(own: Sequence[Coordinate], at: Array) -> Array:
    """Sizes (own,) of an effect in usual sizes, 0 for shape parameters; at (own,): its coordinates.

    Damping above the usual one adds to the lag 2 zeta / omega, so it multiplies the size of a fading frequency.
    """
    values = [(c, float(u)) for c, u in zip(own, at, strict=True)]
    damping = max((c.value(u) / c.typical for c, u in values if c.name.endswith(".damping_ratio")), default=1.0)
    return np.array(
        [c.size(u) * (max(damping, 1.0) if c.fading_frequency else 1.0) if c.is_size else 0.0 for c, u in values]
    )


def magnitude(own: Sequence[Coordinate], at: Array) -> float:
    """Largest size of an effect in usual sizes; at (own,): its coordinates."""
    return float(np.max(np.abs(sizes(own, at)), initial=0.0))


def size_in(model: Model, name: str) -> float:
    """Largest size of an effect of the model, in usual sizes."""
    own = coordinates(model.library.find(name))
    return magnitude(own, np.array([c.u(model[c.name]) for c in own]))


def undetermined(model: Model, name: str, std: Mapping[str, float]) -> bool:
    """Whether all sizes of an effect of the model may be zero: each is within two of its deviations `std` of neutral.

    A size of infinite deviation, on which there are no data, does not count as zero.
    """
    fading = [c for c in coordinates(model.library.find(name)) if c.is_size]
    return all(abs(model[c.name] - (c.neutral or 0.0)) <= NONE_WITHIN * std[c.name] < np.inf for c in fading)


def stable(base: BaseFit, h: Hypothesis) -> bool:
    """Whether the sizes keep their sign and half their value, whichever run is left out (linearised).

    Remaining runs that determine a size to no better than half of it do not count against it, as when the run left out
    is the only run that reaches the end of the stroke.
    """
    A, e, ridge = _parts(base, h)
    p, normal = len(base.names), A.T @ A
    sizes = [k for k, c in enumerate(h.coordinates) if c.is_size and not c.logarithmic]
    if not sizes:
        return True
    u = h.u[sizes]
    for own in _folds(base.evidence):
        inverse = np.linalg.inv(normal - A[own].T @ A[own] + np.diag(ridge))
        # the optimum of the other runs: their gradient is minus that of the runs left out
        shift, covariance = (inverse @ A[own].T @ e[own])[p:][sizes], inverse[p:, p:][np.ix_(sizes, sizes)]
        known = float(u @ covariance @ u) < (WELL_KNOWN * float(u @ u)) ** 2
        if known and float(u @ (u + shift)) < 0.5 * float(u @ u):
            return False
    return True


def _folds(evidence: Evidence) -> list[NDArray[np.bool_]]:
    """Residuals to leave out together: one run each; with fewer than three runs, a quarter in time of each."""
    if len(evidence.runs) >= FEW_RUNS:
        return [evidence.run == k for k in range(len(evidence.runs))]
    ends = np.array([run.time[-1] for run in evidence.runs])
    part = np.minimum((4.0 * evidence.time / ends[evidence.run]).astype(int), 3) + 4 * evidence.run
    return [part == k for k in range(4 * len(evidence.runs))]


def _parts(base: BaseFit, h: Hypothesis) -> tuple[Array, Array, Array]:
    """Weighted slopes (residuals, base + candidate), weighted residual, and ridge, at the hypothesis."""
    w = weights(base.evidence, h.residual, family_scales(base.evidence, h.residual))
    K = np.concatenate([base.slopes, h.slopes], axis=1)
    ridge = np.concatenate([np.ones(len(base.names)), [1.0 / c.prior**2 for c in h.coordinates]])
    return K * w[:, None], w * h.residual, ridge


def decoy(base: BaseFit, h: Hypothesis, rng: np.random.Generator) -> float:
    """Largest t among copies of the candidate's trace shifted in time, each within its runs."""
    evidence, p = base.evidence, len(base.names)
    w = weights(evidence, h.residual, family_scales(evidence, h.residual))
    B, e = base.slopes * w[:, None], w * h.residual
    sizes = [k for k, c in enumerate(h.coordinates) if c.is_size]
    C = h.slopes[:, sizes]
    groups = [
        np.flatnonzero((evidence.family == f) & (evidence.run == r))
        for f in range(len(evidence.names))
        for r in range(len(evidence.runs))
    ]
    largest = 0.0
    for _ in range(DECOYS):
        shifted = np.empty_like(C)
        for rows in groups:
            if len(rows):
                shifted[rows] = np.roll(C[rows], int(rng.uniform(0.1, 0.9) * len(rows)), axis=0)
        A = np.concatenate([B, shifted * w[:, None]], axis=1)
        bread = np.linalg.inv(A.T @ A + np.diag(np.concatenate([np.ones(p), np.full(len(sizes), 1e-3)])))
        x = -bread @ (A.T @ e)
        cov = cluster_robust(A, e + A @ x, evidence.block, bread, np.zeros(len(x)))
        largest = max(largest, wald(x[p:], cov[p:, p:]))
    return largest


def remaining(candidate: Candidate, first: dict[str, float], now: dict[str, float]) -> float:
    """Share of the original misfit that is still there, in the equation where the candidate helps most.

    Only equations with a sufficient gain count: 0.1 % of a large misfit elsewhere may be larger, but is chance.
    """
    helped = [n for n, gain in candidate.gain.items() if gain >= GAIN_LEAST] or list(candidate.gain)
    name = max(helped, key=lambda n: candidate.gain[n] * now.get(n, 0.0))
    return now.get(name, 0.0) / first[name] if first.get(name) else 1.0


def _elsewhere(evidence: Evidence, h: Hypothesis) -> frozenset[str]:
    """Equations of which no residual depends on the candidate."""
    touched = np.any(h.slopes != 0.0, axis=1)
    entered = {equation_of(name) for k, name in enumerate(evidence.names) if touched[evidence.family == k].any()}
    return frozenset(map(equation_of, evidence.names)) - entered


def _lag(h: Hypothesis, sample_time: float) -> float:
    delays = [value for name, value in h.values.items() if name.endswith(".delay")]
    return min(delays) / sample_time if delays else np.inf
