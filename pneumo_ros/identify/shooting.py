"""Least squares on the starts of all segments and the parameters together, with the starts eliminated.

Gauss-Newton with Levenberg-Marquardt damping on the parameters. The starts follow them by the linear prediction; where
that does not lower a segment's error, its start is fitted by itself, so that no single breakaway holds up the rest.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError
from pneumo_ros.identify.segments import PROBE, Segments
from pneumo_ros.identify.start import fit_starts
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Progress = Callable[[float, str], None]

TAIL = 4.0  # noise deviations: beyond, errors count less than squared
OUTLYING = 4.0  # times the median loss of a segment
_ITERATIONS, _ENOUGH = 20, 0.3  # of one descent: steps, and gain in cost (half a squared deviation) worth another
_ROUGHLY = 1e-3  # share of the cost: gain worth another step before starts have been reseated for the first time
_ROUNDS, _WORTH = 6, 2.0  # rounds, and gain of a round worth another
_LEAST, _MOST = 1e-9, 1e3  # damping
_SETTLING = 6  # steps of a single start that the linear prediction left worse
_WORSE = 1.0  # of a segment's loss: more is worth those
_LANES = 1024  # at once: more take memory, not time


@dataclass(frozen=True)
class Unknowns:
    """What is fitted: free parameters by name with the values (free,) they begin at, priors about `centre`, bounds."""

    names: tuple[str, ...]
    begin: Array
    centre: Array
    prior: Array  # standard deviations
    low: Array
    high: Array

    def steps(self, theta: Array) -> Array:
        """Finite-difference steps: a hundredth of the prior, away from a bound and never across the other."""
        steps = np.minimum(1e-2 * self.prior, 0.5 * (self.high - self.low))
        return np.where(theta + steps > self.high, -steps, steps)


@dataclass(frozen=True)
class Equations:
    """Linearised, per segment: normal matrix and gradient of the parameters, in priors, with the starts eliminated."""

    matrix: Array  # (segments, free, free)
    gradient: Array  # (segments, free)
    starts: Array  # (segments, states, states), damped
    cross: Array  # (segments, free, states)
    slope: Array  # (segments, states)


@dataclass(frozen=True)
class Solution:
    """Parameters (free,), starts (segments, states), the course of the cost, the equations there, who was counted."""

    theta: Array
    states: Array
    costs: tuple[float, ...]
    equations: Equations
    active: NDArray[np.bool_]


class Shooting:
    """The problem of one model, its unknowns and segments."""

    def __init__(self, model: Model, unknowns: Unknowns, segments: Segments, threads: int) -> None:
        self.model, self.unknowns, self.segments, self.threads = model, unknowns, segments, threads
        self.coarse = segments.coarser()
        self.columns = [list(model.parameters).index(name) for name in unknowns.names]
        self.active = np.ones(len(segments), dtype=bool)
        count, n = segments.measured[0].size, segments.guess.shape[1]
        self.tail = np.append(np.full(count, TAIL), np.full(n, np.inf))  # distances from guesses count squared

    def solve(self, states: Array, progress: Progress) -> Solution:
        """Rounds of descent and of reseating starts, until neither helps. NumericalError when nothing is finite.

        A segment whose breakaway is predicted too early or too late sits in a valley of its own, which no descent
        leaves: between rounds every segment's start is fitted afresh from its guess, and the better of both is kept.
        """
        theta, costs = self.unknowns.begin.copy(), []
        for number in range(_ROUNDS):

            def tell(share: float, cost: float, number: int = number) -> None:
                progress(1.0 - 0.5 ** (number + share), f"cost {cost:.4g}")

            states, theta, course, equations = self._descend(states, theta, 0.0 if number else _ROUGHLY, tell)
            costs += course
            if number and course[0] - course[-1] < _WORTH:
                break
            if not number:
                self.segments = self.segments.guessed(self._model(theta))  # by now much better than at first
                self.coarse = self.segments.coarser()
            states, residuals = self._reseat(states, theta)
            active = ~self._outliers(residuals)
            same = bool((active == self.active).all())
            self.active = active
            if number and same and costs[-1] - self._cost(residuals, theta) < _WORTH:
                break
        if not np.isfinite(costs[-1]):
            raise NumericalError("the refit found no finite prediction; check the recordings and the model first")
        progress(1.0, f"cost {costs[-1]:.4g}")
        return Solution(theta, states, tuple(costs), equations, self.active)

    def _descend(
        self, states: Array, theta: Array, roughly: float, tell: Callable[[float, float], None]
    ) -> tuple[Array, Array, list[float], Equations]:
        """States, parameters, costs, and the equations at the end or one small step before it."""
        damping, residuals = 1e-3, self._residuals(states, theta)
        costs = [self._cost(residuals, theta)]
        for k in range(_ITERATIONS):
            tell(k / _ITERATIONS, costs[-1])
            equations = self._equations(states, theta, residuals)
            while True:
                tried = self._step(states, theta, residuals, equations, damping)
                cost = self._cost(tried[2], tried[1])
                if cost < costs[-1] or damping > _MOST:
                    break
                damping *= 30.0
            if not cost < costs[-1]:
                break
            states, theta, residuals = tried
            damping = max(damping * 0.1, _LEAST)
            costs.append(cost)
            if costs[-2] - costs[-1] < max(_ENOUGH, roughly * cost):
                break
        return states, theta, costs, equations

    # --- residuals --------------------------------------------------------------------------------------------------

    def _parameters(self, theta: Array) -> Array:
        """Parameter vectors (copies, parameters) for values (copies, free)."""
        values = np.tile(self.model.values, (len(theta), 1))
        values[:, self.columns] = theta
        return values

    def _residuals(self, states: Array, theta: Array, segments: Segments | None = None) -> Array:
        """Whitened errors, then distances of the starts from their guesses (segments, residuals)."""
        return np.asarray(self._lanes(segments or self.segments, states, theta[None])[0])

    def _lanes(self, segments: Segments, states: Array, theta: Array) -> Array:
        """Residuals (copies, segments, residuals) of copies of all segments, with values (copies, free)."""
        parameters = np.repeat(self._parameters(theta), len(segments), axis=0)
        errors = segments.residuals(self.model, states, parameters, self.threads)
        return np.concatenate([errors, segments.from_guess(self.model, states, parameters)], axis=2)

    def _losses(self, residuals: Array) -> Array:
        """Loss (segments,) of whitened errors (Huber 1964) and of distances from guesses."""
        size = np.abs(residuals)
        square = np.minimum(size, self.tail)
        return np.asarray(np.sum(square * (size - 0.5 * square), axis=1))

    def _cost(self, residuals: Array, theta: Array) -> float:
        moved = (theta - self.unknowns.centre) / self.unknowns.prior
        return float(np.sum(self._losses(residuals)[self.active]) + 0.5 * np.sum(moved**2))

    # --- linearisation ----------------------------------------------------------------------------------------------

    def _jacobian(self, states: Array, theta: Array) -> Array:
        """Derivatives (segments, states + free, residuals) by starts in scales and by parameters in priors."""
        steps, (count, n) = self.unknowns.steps(theta), states.shape
        values = np.concatenate([np.tile(theta, (n + 1, 1)), theta + np.diag(steps)])
        moved = np.concatenate([states, self.segments.probes(states), np.tile(states, (len(theta), 1))])
        lanes = moved.reshape(len(values), count, n)
        scale = np.concatenate([np.full(n, 1.0 / PROBE), self.unknowns.prior / steps])
        base = self._lanes(self.coarse, states, theta[None])[0]
        jacobian = np.empty((count, len(scale), base.shape[1]))
        each = max(_LANES // count, 1)
        for first in range(1, len(values), each):
            part = slice(first, first + each)
            found = self._lanes(self.coarse, lanes[part].reshape(-1, n), values[part])
            for j, residuals in enumerate(found, first - 1):
                jacobian[:, j] = (residuals - base) * scale[j]
        return jacobian

    def _equations(self, states: Array, theta: Array, residuals: Array) -> Equations:
        n, active = states.shape[1], self.active[:, None]
        jacobian = self._jacobian(states, theta)
        weight = np.minimum(1.0, self.tail / np.maximum(np.abs(residuals), 1e-300))
        weight[:, :-n] *= active  # starts of segments left out go where they were guessed
        jacobian[:, n:] *= active[..., None]
        weighted = jacobian * weight[:, None]
        normal = weighted @ np.swapaxes(jacobian, 1, 2)
        gradient = (weighted @ residuals[..., None])[..., 0]
        starts, cross, slope = normal[:, :n, :n], normal[:, n:, :n], gradient[:, :n]
        right = np.concatenate([np.swapaxes(cross, 1, 2), slope[..., None]], axis=2)
        solved = np.linalg.solve(starts, right)
        return Equations(
            normal[:, n:, n:] - cross @ solved[..., :-1],
            gradient[:, n:] - (cross @ solved[..., -1:])[..., 0],
            starts, cross, slope,
        )  # fmt: skip

    # --- steps ------------------------------------------------------------------------------------------------------

    def _step(
        self, states: Array, theta: Array, residuals: Array, equations: Equations, damping: float
    ) -> tuple[Array, Array, Array]:
        move = self._move(theta, equations, damping)
        new_theta = np.clip(theta + move * self.unknowns.prior, self.unknowns.low, self.unknowns.high)
        pull = equations.slope + np.einsum("spn,p->sn", equations.cross, move)
        start_move = -np.linalg.solve(equations.starts, pull[..., None])[..., 0]
        new_states = states + start_move * self.segments.scale
        stayed = self.segments.seated(self._model(new_theta), states, self.segments.read(self._model(theta), states)[0])
        return self._settle(stayed, new_states, new_theta, self._losses(residuals))

    def _move(self, theta: Array, equations: Equations, damping: float) -> Array:
        """Damped step (free,) in priors, at most one of them each, that ends within the bounds.

        What would go farther is put there, and the others are solved for again.
        """
        u = self.unknowns
        total = equations.matrix.sum(0) + np.eye(len(theta))
        slope = equations.gradient.sum(0) + (theta - u.centre) / u.prior
        total += damping * np.diag(np.diag(total))
        low, high = np.maximum((u.low - theta) / u.prior, -1.0), np.minimum((u.high - theta) / u.prior, 1.0)
        move, held = np.zeros(len(theta)), np.zeros(len(theta), dtype=bool)
        while True:
            free = ~held
            right = slope[free] + total[np.ix_(free, held)] @ move[held]
            move[free] = -np.linalg.solve(total[np.ix_(free, free)], right)
            across = free & ((move < low) | (move > high))
            if not across.any():
                return move
            move[across] = np.clip(move, low, high)[across]
            held |= across

    def _settle(self, stayed: Array, new: Array, theta: Array, before: Array) -> tuple[Array, Array, Array]:
        """Starts, parameters and residuals: the predicted starts, or fitted ones where these are worse than before."""
        residuals = self._residuals(new, theta)
        worse = np.flatnonzero((self._losses(residuals) > before + _WORSE) & self.active)
        if len(worse):
            part, model = self.segments.pick(worse), self._model(theta)
            for begin in (new[worse], stayed[worse]):
                for starts in (begin, fit_starts(model, part, begin, _SETTLING)):
                    self._take_better(new, residuals, starts, self._residuals(starts, theta, part), worse)
        return new, theta, residuals

    def _take_better(self, states: Array, residuals: Array, others: Array, theirs: Array, which: Index) -> None:
        """Put other starts (which, states) with their residuals in place where they fit better."""
        better = self._losses(theirs) < self._losses(residuals[which])
        states[which[better]], residuals[which[better]] = others[better], theirs[better]

    def _reseat(self, states: Array, theta: Array) -> tuple[Array, Array]:
        """The better start of each segment, at hand or fitted afresh from its guess; states and residuals."""
        residuals, states = self._residuals(states, theta), states.copy()
        fresh = fit_starts(self._model(theta), self.segments)
        self._take_better(states, residuals, fresh, self._residuals(fresh, theta), np.arange(len(states)))
        return states, residuals

    def _outliers(self, residuals: Array) -> NDArray[np.bool_]:
        """Segments whose loss is far above the median, the worst twentieth at most."""
        each = self._losses(residuals)
        most = max(len(each) // 20, 1)
        far = each > OUTLYING * np.median(each)
        return np.asarray(far & (each >= np.sort(each)[-most]))

    def _model(self, theta: Array) -> Model:
        return self.model.with_parameters(dict(zip(self.unknowns.names, theta.tolist(), strict=True)))
