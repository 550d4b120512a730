"""The least squares of multiple shooting: residuals of all segments, their linearisation and the step from it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.shooting.robust import huber_loss, huber_weight
from pneumo_ros.shooting.segments import Segments
from pneumo_ros.shooting.slopes import LANES, Index, start_slopes

Array = NDArray[np.float64]

NOISE_TAIL = 4.0  # noise deviations: beyond, the loss of an error is linear
_PROBE, _LEAST = 1e-2, 1e-2  # of the prior, a step; of the centre, the least value that steps are shares of
FINE, _COARSE = 0.01, 0.1  # of a value, largest step; where valves open and close, the cost has stairs
_BENT = 5e-3  # share of the cost beyond noise: least gain for a further step of a model that lacks an effect


@dataclass(frozen=True)
class Unknowns:
    """The unknowns of a fit: free parameters by name, initial values (free,), priors about `centre`, bounds."""

    names: tuple[str, ...]
    begin: Array
    centre: Array
    prior: Array  # standard deviations
    low: Array
    high: Array

    def steps(self, theta: Array, most: float) -> Array:
        """Finite-difference steps: a hundredth of the prior, away from a bound and never across the other.

        At most a share `most` of the value, as `small_step` says; a prior may be many times as wide as the value. Where
        the centre is 0, the prior alone says what is a small step.
        """
        steps = np.minimum(small_step(_PROBE * self.prior, theta, self.centre, most), 0.5 * (self.high - self.low))
        return np.where(theta + steps > self.high, -steps, steps)


def small_step(step: Array, theta: Array, centre: Array, most: float) -> Array:
    """Finite-difference steps (free,), at most a share `most` of each value; where the centre is 0, as they were.

    A value is taken as a hundredth of its centre at least.
    """
    size = np.maximum(np.abs(theta), _LEAST * np.abs(centre))
    return np.asarray(np.minimum(step, np.where(centre != 0.0, most * size, np.inf)))


def largest_step(model: Model) -> float:
    """Share of its value by which a parameter is moved at most for a slope: a tenth for valves that open and close.

    There the cost has stairs; elsewhere so long a step would mix slopes of both sides of a Stribeck curve.
    """
    return _COARSE if model.composition.jumping else FINE


@dataclass(frozen=True)
class Equations:
    """Linearised, per segment: normal matrix and gradient of the parameters, in priors, with the starts eliminated."""

    matrix: Array  # (segments, free, free)
    gradient: Array  # (segments, free)
    starts: Array  # (segments, states, states), damped
    cross: Array  # (segments, free, states)
    slope: Array  # (segments, states)
    settling: Array  # (segments,) gain in cost promised by the starts alone


class Problem:
    """One model, its unknowns and segments."""

    def __init__(self, model: Model, unknowns: Unknowns, segments: Segments, threads: int) -> None:
        self.model, self.unknowns, self.segments, self.threads = model, unknowns, segments, threads
        self.coarse = segments.coarser()
        self.columns = [list(model.parameters).index(name) for name in unknowns.names]
        self.active = np.ones(len(segments), dtype=bool)
        count, n = segments.measured[0].size, segments.guess.shape[1]
        self.tail = np.append(np.full(count, NOISE_TAIL), np.full(n, np.inf))  # distances from guesses count squared

    def begin_cost(self, states: Array) -> float:
        """Cost at the initial parameters."""
        return self.total(self.residuals(states, self.unknowns.begin), self.unknowns.begin)

    def with_values(self, theta: Array) -> Model:
        """The model with values (free,) of the free parameters."""
        return self.model.with_parameters(dict(zip(self.unknowns.names, theta.tolist(), strict=True)))

    def slack(self, cost: float) -> float:
        """Gain in cost too small for a step where a model lacks an effect: its cost is rough near the minimum."""
        noise = 0.5 * float(np.sum(self.segments.weight[self.active] > 0.0))
        return _BENT * max(cost - 1.1 * noise, 0.0)

    # --- residuals --------------------------------------------------------------------------------------------------

    def parameters(self, theta: Array) -> Array:
        """Parameter vectors (copies, parameters) for values (copies, free)."""
        values = np.tile(self.model.values, (len(theta), 1))
        values[:, self.columns] = theta
        return values

    def residuals(self, states: Array, theta: Array, segments: Segments | None = None) -> Array:
        """Whitened errors, then distances of the starts from their guesses (segments, residuals)."""
        return np.asarray(self.lanes(segments or self.segments, states, theta[None])[0])

    def lanes(self, segments: Segments, states: Array, theta: Array) -> Array:
        """Residuals (copies, segments, residuals) of copies of all segments, with values (copies, free)."""
        parameters = np.repeat(self.parameters(theta), len(segments), axis=0)
        errors = segments.residuals(self.model, states, parameters, self.threads)
        return np.concatenate([errors, segments.from_guess(self.model, states, parameters)], axis=2)

    def losses(self, residuals: Array) -> Array:
        """Loss (segments,) of whitened errors and of distances from guesses."""
        return np.asarray(np.sum(huber_loss(residuals, self.tail), axis=1))

    def total(self, residuals: Array, theta: Array) -> float:
        """Cost: losses of the active segments, and of the parameters by their priors."""
        moved = (theta - self.unknowns.centre) / self.unknowns.prior
        return float(np.sum(self.losses(residuals)[self.active]) + 0.5 * np.sum(moved**2))

    # --- linearisation ----------------------------------------------------------------------------------------------

    def jacobian(self, states: Array, theta: Array) -> Array:
        """Derivatives (segments, states + free, residuals) by starts in scales and by parameters in priors."""
        steps, (count, n) = self.unknowns.steps(theta, largest_step(self.model)), states.shape

        def residuals(part: Segments, _rows: Index, starts: Array) -> Array:
            return self.lanes(part, starts, np.tile(theta, (len(starts) // len(part), 1)))

        base, slopes = start_slopes(self.model, self.coarse, states, residuals)
        jacobian = np.empty((count, n + len(theta), base.shape[1]))
        jacobian[:, :n] = slopes
        values, each = theta + np.diag(steps), max(LANES // count, 1)
        for first in range(0, len(theta), each):
            some = values[first : first + each]
            found = self.lanes(self.coarse, np.tile(states, (len(some), 1)), some)
            for j, one in enumerate(found, first):
                jacobian[:, n + j] = (one - base) * (self.unknowns.prior[j] / steps[j])
        return jacobian

    def equations(self, states: Array, theta: Array, residuals: Array) -> Equations:
        """Linearised at starts and parameters, with robust weights by the residuals there."""
        n, active = states.shape[1], self.active[:, None]
        jacobian = self.jacobian(states, theta)
        weight = huber_weight(residuals, self.tail)
        weight[:, :-n] *= active  # starts of segments left out go to their guesses
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
            starts, cross, slope, 0.5 * np.sum(slope * solved[..., -1], axis=1),
        )  # fmt: skip

    def promise(self, theta: Array, equations: Equations) -> float:
        """Gain in cost of the next step by the linearisation (half the Newton decrement)."""
        slope = equations.gradient.sum(0) + (theta - self.unknowns.centre) / self.unknowns.prior
        return float(-0.5 * slope @ self.move(theta, equations, 0.0))

    def move(self, theta: Array, equations: Equations, damping: float) -> Array:
        """Damped step (free,) in priors, at most 1 for each parameter, within the bounds.

        A parameter that would go beyond its limit is held there, and the others are solved for again.
        """
        u = self.unknowns
        total = equations.matrix.sum(0) + np.eye(len(theta))
        slope = equations.gradient.sum(0) + (theta - u.centre) / u.prior
        total += damping * np.diag(np.diag(total))
        low, high = np.maximum((u.low - theta) / u.prior, -1.0), np.minimum((u.high - theta) / u.prior, 1.0)
        move, held = np.zeros(len(theta)), np.zeros(len(theta), dtype=bool)
        for _ in range(len(theta) + 1):  # each round holds at least one more parameter, the last none
            free = ~held
            right = slope[free] + total[np.ix_(free, held)] @ move[held]
            move[free] = -np.linalg.solve(total[np.ix_(free, free)], right)
            across = free & ((move < low) | (move > high))
            if not across.any():
                break
            move[across] = np.clip(move, low, high)[across]
            held |= across
        return move
