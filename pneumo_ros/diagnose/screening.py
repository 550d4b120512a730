"""Every candidate fitted linearly to part of the evidence, and the choice of candidates for the nonlinear fit."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import relief_of, strain
from pneumo_ros.diagnose.coordinates import Coordinate, forms, starts
from pneumo_ros.diagnose.freedom import profile_slopes
from pneumo_ros.diagnose.hypothesis import (
    BaseFit,
    Form,
    Hypothesis,
    along,
    block_sums,
    cluster_robust,
    family_likelihoods,
    family_scales,
    log_likelihood,
    missing,
    solve,
    solve_within,
    vectors,
    wald,
    weights,
)  # fmt: skip
from pneumo_ros.diagnose.score import surprise
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

SHORTLIST, FINALISTS = 4, 3  # candidates fitted to part of the training runs, and to all, of each kind
STRAINED = (
    4.5  # log likelihood that base parameters lose by their priors: above it, the effects they replace are searched for
)
OPEN = 3.0  # V: the valve of the usual machine is open
IDLE = 1e-3  # noise deviations: a size that changes no residual by more has no effect
# Least-squares solutions, each weighted by the residual of the previous one, at most; and the share of each scale below
# which its change asks for no other one. Of 435 solutions of each of two rankings it saves 257 and 11. Log likelihoods
# of candidates change by up to 0.1 nats, with half or twice the share by up to 0.15, and the shortlist is the same.
REWEIGHTED, SETTLED = 5, 1e-3
FREE = 1e-3  # least prior information about a size in steps: it is free within some thirty steps, as sizes are
SMALL_STEP = 0.005  # usual sizes: a step for the slope at neutral


def couples(everything: Model, effect: Sequence[Coordinate], absent: str) -> bool:
    """Whether an effect makes the other chamber depend on the pressure of chamber `absent`, which no sensor measured.

    As a leak across the piston does; an effect of the valve acts on each chamber by itself.
    """
    model = everything.with_parameters({c.name: c.typical for c in effect})
    rows = np.tile(model.state(p_a=3e5, p_b=3e5), (2, 1))
    rows[1, model.states.index(f"p_{absent}")] = 2e5
    held = np.zeros((2, len(model.inputs)))
    held[:, 0] = OPEN
    rates = model.derivatives(rows, held)[:, model.states.index("p_b" if absent == "a" else "p_a")]
    return bool(rates[0] != rates[1])


def screen(base: BaseFit) -> list[Hypothesis]:
    """Every candidate, in every shape tried, fitted linearly from neutral to its usual size; best first.

    A profile acts by the slopes of its points, which every model has. Where base parameters are strained, also by the
    slope at neutral, by which they replace an effect; and so a rate [1/s], whose effect saturates: in a large chamber
    all that happens is slow.
    """
    found = missing(base.model, base.everything.inputs)
    found = {name: effect for name, effect in found.items() if name in base.everything.effects}
    if absent := {name.split("_")[1] for run in base.evidence.runs for name in run.assumed}:
        found = {n: e for n, e in found.items() if not couples(base.everything, e, min(absent))}
    each = [(name, form) for name, effect in found.items() for form in forms(effect)]
    tasks = [(name, form, u) for name, form in each for u in starts(form)]
    if strain(base.offset) > STRAINED:
        tasks += [(name, form, SMALL_STEP * starts(form)[0]) for name, form in each if _one_size(form)]
    tasks += [(name, form, SMALL_STEP * starts(form)[0]) for name, form in each if _saturates(form)]
    variants: list[dict[str, float]] = [{}]
    spans: list[tuple[int, int, list[int]]] = []
    made = {form: slopes for _, form in each if (slopes := profile_slopes(base, form)).size}
    for _, effect, u in tasks:
        shape = {c.name: c.value(x) for c, x in zip(effect, u, strict=True) if not c.is_size}
        sizes = [k for k, c in enumerate(effect) if c.is_size]
        own = []
        for k in sizes if effect not in made else ():
            values = {c.name: c.neutral for c in effect if c.is_size and c.neutral is not None}
            own.append(values | shape | {effect[k].name: effect[k].value(u[k])})
        spans.append((len(variants), len(own), sizes))
        variants += own
    residual = base.evidence.residuals(base.everything, vectors(base.everything, variants), ranking=True)

    def fitted(k: int) -> Hypothesis:
        (name, effect, u), (first, count, sizes) = tasks[k], spans[k]
        changes = made[effect] * u if effect in made else (residual[first : first + count] - residual[0]).T
        return _linear(base, name, effect, u, sizes, changes)

    with ThreadPoolExecutor(2) as pool:
        return sorted(pool.map(fitted, range(len(tasks))), key=lambda h: -h.likelihood)


def _one_size(effect: tuple[Coordinate, ...]) -> bool:
    return sum(c.is_size for c in effect) == 1 and not any(c.is_size and c.logarithmic for c in effect)


def _saturates(effect: tuple[Coordinate, ...]) -> bool:
    return any(c.is_size and c.unit == "1/s" for c in effect)


def _linear(
    base: BaseFit, name: str, effect: tuple[Coordinate, ...], u: Array, sizes: list[int], C: Array
) -> Hypothesis:
    """Linear fit of the sizes of one candidate beside the base parameters.

    Sizes without influence here, as points of a profile without data, stay neutral.
    """
    idle = [k for k, change in zip(sizes, C.T, strict=True) if np.max(np.abs(change)) < IDLE]
    if 0 < len(idle) < len(sizes):
        kept = [k for k in range(len(effect)) if k not in idle]
        C = C[:, [k not in idle for k in sizes]]
        sizes = [kept.index(k) for k in sizes if k not in idle]
        effect, u = tuple(effect[k] for k in kept), u[kept]
    K, p = (base.slopes, C), len(base.names)
    ridge = np.concatenate([np.ones(p), [_known(effect[k], u[k]) for k in sizes]])
    offset = np.concatenate([base.offset, np.zeros(len(sizes))])
    after, x = base.residual, np.zeros(len(ridge))
    low, high = _room(effect, u, sizes, p)
    before = np.full(len(base.evidence.names), np.inf)
    for _ in range(REWEIGHTED):
        scale = family_scales(base.evidence, after)
        if np.all(np.abs(scale - before) < SETTLED * scale):
            break
        before = scale
        w = weights(base.evidence, after, scale)
        x, bread = solve(K, base.residual, w, ridge, offset)
        if np.any((x < low) | (x > high)):  # else a negative mass would explain noise that it amplifies
            x = solve_within(K, base.residual, w, ridge, offset, low, high)
        after = base.residual + along(K, x)
    w = weights(base.evidence, after, scale)
    sums = block_sums(K, w, w * after, base.evidence.block)
    cov = cluster_robust(sums, bread, ridge)[p:, p:]
    beside, wrong = _beside_lines(base, sums, bread, ridge)
    start = u.copy()
    for k, size in zip(sizes, x[p:], strict=True):
        c = effect[k]
        start[k] = u[k] if c.logarithmic else c.clip(size * u[k])
    relief = relief_of(base, x[:p])
    value = log_likelihood(base.evidence, after) - strain(x[:p] + base.offset)
    t = wald(x[p:], cov)
    return Hypothesis(name, effect, start, x[:p], after, value, t, relief, cov, beside_lines=beside, wrong_lines=wrong)


def _beside_lines(base: BaseFit, sums: Array, bread: Array, ridge: Array) -> tuple[Array, float]:
    """Covariance (own, own) of sizes beside lines of the machine file that may be wrong by any amount.

    And the nats that it costs if such lines explain the usual sizes, one by one: so much is known of the effect by what
    the file states, and not by these recordings. `bread`: inverse normal matrix, with `ridge`.
    """
    p = len(base.names)
    normal = np.linalg.inv(bread) - np.diag(ridge)
    free = np.where(np.append(base.lines, np.zeros(len(ridge) - p, dtype=bool)), FREE, ridge)
    cov = cluster_robust(sums, np.linalg.inv(normal + np.diag(free)), free)[p:, p:]
    moves = np.linalg.solve(normal[:p, :p] + np.diag(free[:p]), normal[:p, p:])
    ways = (surprise(base, way * move) for move in moves.T for way in (1.0, -1.0))
    return cov, max(0.5 * sum(ways) - moves.shape[1] * surprise(base, np.zeros(p)), 0.0)


def _known(c: Coordinate, u: float) -> float:
    """Prior information about a size in steps of `u`: a point of a profile that no recording passes stays neutral."""
    return FREE if c.logarithmic else max(FREE, (u / c.prior) ** 2)


def _room(effect: tuple[Coordinate, ...], u: Array, sizes: list[int], own: int) -> tuple[Array, Array]:
    """Least and largest step of `own` base parameters, which are free, and of the sizes, in the steps tried."""
    low, high = np.full(own + len(sizes), -np.inf), np.full(own + len(sizes), np.inf)
    for j, k in enumerate(sizes, own):
        c = effect[k]
        if not c.logarithmic:
            low[j], high[j] = sorted(end / u[k] for end in c.ends)
    return low, high


def shortlist(base: BaseFit, nothing: Hypothesis, ranked: Sequence[Hypothesis], most: int) -> list[Hypothesis]:
    """The first of each form of an effect, `most` of those that help the gas and as many that help the mechanics.

    Effects missing in one part must not crowd out effects missing in the other.
    """
    gas = np.array([name.startswith("chamber") for name in base.evidence.names])
    before, found = family_likelihoods(base.evidence, nothing.residual), dict[Form, tuple[bool, Hypothesis]]()
    for h in ranked:
        gain = family_likelihoods(base.evidence, h.residual) - before
        helps_gas = bool(np.sum(gain[gas]) > np.sum(gain[~gas]))
        if h.form not in found and sum(other == helps_gas for other, _ in found.values()) < most:
            found[h.form] = helps_gas, h
    return [h for _, h in found.values()]
