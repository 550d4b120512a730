"""How well one model imitates the record of another: the misfit that remains after a refit."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.experiment.whitened import Whitened
from pneumo_ros.plant import Model
from pneumo_ros.shooting.bounded import bounded_minimum
from pneumo_ros.shooting.refit import PRIOR, default_free

Array = NDArray[np.float64]
Residual = Callable[[Array], Array]

_ITERATIONS, _ENOUGH, _ALIKE = 6, 0.03, 0.01  # Gauss-Newton steps; least relative gain of one; negligible cost
_ANEW = 2  # steps that renew all derivatives; later ones only those of the effect, which may be far from linear
_SHORTER = (1.0, 0.5, 0.2, 0.05)  # step lengths tried
_VAGUE, _SHAPE = 100.0, 1.0  # prior deviations of the effect's strengths and other parameters, over usual values


@dataclass(frozen=True)
class Unknowns:
    """Parameters that a refit may move: dotted names, start, prior deviation, finite-difference steps and bounds."""

    names: tuple[str, ...]
    start: Array
    prior: Array
    step: Array
    low: Array
    high: Array
    base: int  # the first `base` parameters are not the effect's own


def unknowns(model: Model, effect: str) -> Unknowns:
    """Free parameters when `effect`, one of the model's, imitates another: its own parameters with wide priors, the
    others of `default_free` as its machine file states, else within 5 %.

    Strengths start at their neutral value, if they have one.
    """
    own = [name for name in model.parameters if name.startswith(f"{effect}.")]
    base = [name for name in default_free(model) if name not in own]
    usual = _usual(model, own)
    rows = [(n, model[n], model.uncertainty.get(n, PRIOR * _size(model, n)), 0.1) for n in base]
    for name in own:
        neutral = model.specification(name).neutral
        if neutral is None:
            rows.append((name, model[name], _SHAPE * (_size(model, name) or usual), 0.05))
        else:
            rows.append((name, neutral, _VAGUE * (_size(model, name) or usual), 1e-3))
    names, start, prior, share = zip(*(row for row in rows if row[2] > 0.0), strict=True)
    low, high = (np.array([getattr(model.specification(n), side) for n in names]) for side in ("low", "high"))
    step = np.array(share) * np.array(prior)
    step = np.where(np.array(start) + step > high, -step, step)
    return Unknowns(names, np.array(start), np.array(prior), step, low, high, sum(name in base for name in names))


def _size(model: Model, name: str) -> float:
    return max(abs(model[name]), abs(model.specification(name).default))


def _usual(model: Model, names: list[str]) -> float:
    """The largest usual strength of an effect: the scale of parameters that are usually zero."""
    return max((_size(model, name) for name in names if model.specification(name).neutral is not None), default=1.0)


def imitate(evidence: Sequence[Whitened], truth: Model, model: Model, free: Unknowns) -> list[float]:
    """Remaining misfit in squared noise deviations, per family of residuals and last of the priors.

    `truth` made the record; its own residuals, which come from sums over samples, are subtracted. Gauss-Newton with
    bounds; the equations are evaluated again at every step, so that the misfit is not a linear estimate.
    """
    marks = _families(evidence, truth)
    mark = np.concatenate(marks)

    def residual(phi: Array) -> Array:
        values = {name: float(v) for name, v in zip(free.names, phi, strict=True)}
        return np.concatenate(_families(evidence, model.with_parameters(values))) - mark

    def cost(phi: Array, r: Array) -> float:
        return float(r @ r + np.sum(((phi - free.start) / free.prior) ** 2))

    phi, r = free.start.copy(), residual(free.start)
    jacobian = np.empty((len(r), len(phi)))
    for k in range(_ITERATIONS):
        before = cost(phi, r)
        if before < _ALIKE:
            break
        _differentiate(jacobian, phi, r, residual, free, 0 if k < _ANEW else free.base)
        move = _move(phi, r, jacobian, free)
        for share in _SHORTER:
            tried = np.clip(phi + share * move, free.low, free.high)
            there = residual(tried)
            if cost(tried, there) < before:
                phi, r = tried, there
                break
        if before - cost(phi, r) <= _ENOUGH * before + _ALIKE:
            break
    ends = np.cumsum([len(part) for part in marks])[:-1]
    return [*(float(part @ part) for part in np.split(r, ends)), float(np.sum(((phi - free.start) / free.prior) ** 2))]


def _families(evidence: Sequence[Whitened], model: Model) -> list[Array]:
    """Residuals of all records, family by family."""
    return [np.concatenate(parts) for parts in zip(*(one.residuals(model) for one in evidence), strict=True)]


def _differentiate(jacobian: Array, phi: Array, r: Array, residual: Residual, free: Unknowns, first: int) -> None:
    """Derivatives (residuals, unknowns) per prior deviation, for the unknowns from `first` on."""
    beyond = (phi + free.step > free.high) | (phi + free.step < free.low)
    for j in range(first, len(phi)):
        moved = phi.copy()
        moved[j] += -free.step[j] if beyond[j] else free.step[j]
        jacobian[:, j] = (residual(moved) - r) * (free.prior[j] / (moved[j] - phi[j]))


def _move(phi: Array, r: Array, jacobian: Array, free: Unknowns) -> Array:
    """The least-squares step within the bounds."""
    low, high = (free.low - phi) / free.prior - 1e-12, (free.high - phi) / free.prior + 1e-12
    gradient = jacobian.T @ r + (phi - free.start) / free.prior
    return bounded_minimum(jacobian.T @ jacobian + np.eye(len(phi)), gradient, low, high) * free.prior
