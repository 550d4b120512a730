"""Least squares on the starts of all segments and the parameters together, with the starts eliminated.

Gauss-Newton with Levenberg-Marquardt damping on the parameters. The starts follow them by the linear prediction; where
that does not lower a segment's error, its start is fitted by itself, so that a single breakaway does not stop the rest.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError
from pneumo_ros.shooting.physical import physical
from pneumo_ros.shooting.problem import Equations, Problem
from pneumo_ros.shooting.start import fit_starts

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Progress = Callable[[float, str], None]

OUTLYING = 4.0  # times the median loss of a segment
_POOR = 1.1  # times the same: with noise alone, half a second at 1 kHz stays below it
_ITERATIONS, _ENOUGH = 20, 0.3  # of one descent: most steps, and least gain in cost (half a squared deviation) of each
_ROUGHLY = 1e-3  # share of the cost: least gain of a step before starts have been reseated for the first time
_ROUNDS, _WORTH = 6, 2.0  # most rounds, and least gain of a round before another
_LEAST, _MOST, _HARDER = 1e-9, 1e3, 30.0  # bounds of the damping, and its growth after a step without gain
_SETTLING = 6  # steps of a single start that is worse after the linear prediction
_WORSE = 1.0  # rise of a segment's loss above which its start is fitted by itself


@dataclass(frozen=True)
class Solution:
    """Parameters (free,), starts (segments, states), cost by iteration, the equations there, the active segments."""

    theta: Array
    states: Array
    costs: tuple[float, ...]
    equations: Equations
    active: NDArray[np.bool_]


class Shooting(Problem):
    """Solves the problem of one model, its unknowns and segments."""

    def solve(self, states: Array, progress: Progress, fresh: bool = False) -> Solution:
        """Rounds of descent and of reseating starts, until neither helps. NumericalError when nothing is finite.

        A segment whose breakaway is predicted too early or too late is in a local minimum, which no descent leaves:
        between rounds starts are fitted again from their guesses, and the better of both is kept. `fresh`: the starts
        were just fitted from guesses by these parameters.
        """
        theta, costs = self.unknowns.begin.copy(), []
        for number in range(int(fresh), _ROUNDS):

            def tell(share: float, cost: float, number: int = number) -> None:
                progress(1.0 - 0.5 ** (number + share), f"cost {cost:.4g}")

            states, theta, course = self._descend(states, theta, 0.0 if number else _ROUGHLY, tell)
            costs += course
            worth = _WORTH + 10.0 * self.slack(costs[-1])
            if number and course[0] - course[-1] < worth:
                break
            guess_anew = number < 2 and (not number or not self.model.composition.true_sensors)
            if guess_anew:
                self.segments = self.segments.guessed(self.with_values(theta))  # by now much better than at first
                self.coarse = self.segments.coarser()
            states, residuals = self._reseat(states, theta, poor_only=number > 0)
            active = ~self._outliers(residuals)
            same = bool((active == self.active).all())
            self.active = active
            if not guess_anew and same and costs[-1] - self.total(residuals, theta) < worth:
                break
        if not np.isfinite(costs[-1]):
            raise NumericalError("the refit found no finite prediction; check the recordings and the model first")
        progress(1.0, f"cost {costs[-1]:.4g}")
        equations = self.equations(states, theta, self.residuals(states, theta))
        return Solution(theta, states, tuple(costs), equations, self.active)

    def approach(self, states: Array, progress: Progress) -> tuple[Array, Array, float]:
        """Starts, parameters and cost after one rough descent."""
        states, theta, costs = self._descend(
            states, self.unknowns.begin.copy(), _ROUGHLY, lambda share, cost: progress(share, f"cost {cost:.4g}")
        )
        return states, theta, costs[-1]

    def _descend(
        self, states: Array, theta: Array, roughly: float, tell: Callable[[float, float], None]
    ) -> tuple[Array, Array, list[float]]:
        damping, residuals = 1e-3, self.residuals(states, theta)
        costs = [self.total(residuals, theta)]
        for k in range(_ITERATIONS):
            tell(k / _ITERATIONS, costs[-1])
            equations = self.equations(states, theta, residuals)
            enough = max(_ENOUGH + self.slack(costs[-1]), roughly * costs[-1])
            if self.promise(theta, equations) < enough and equations.settling[self.active].sum() < _WORTH + enough:
                break
            *tried, cost = self._step(states, theta, residuals, equations, damping)
            while not cost < costs[-1] and damping <= _MOST:
                damping *= _HARDER
                *tried, cost = self._step(states, theta, residuals, equations, damping)
            if not cost < costs[-1]:
                break
            states, theta, residuals = tried
            damping = max(damping * 0.1, _LEAST)
            costs.append(cost)
            if costs[-2] - costs[-1] < enough:
                break
        return states, theta, costs

    def _step(
        self, states: Array, theta: Array, residuals: Array, equations: Equations, damping: float
    ) -> tuple[Array, Array, Array, float]:
        """Starts, parameters and residuals after a damped step, and their cost."""
        move = self.move(theta, equations, damping)
        new_theta = np.clip(theta + move * self.unknowns.prior, self.unknowns.low, self.unknowns.high)
        new_theta = physical(self.model, self.unknowns.names, new_theta)
        pull = equations.slope + np.einsum("spn,p->sn", equations.cross, move)
        start_move = -np.linalg.solve(equations.starts, pull[..., None])[..., 0]
        new_states = states + start_move * self.segments.scale
        stayed = self.segments.seated(
            self.with_values(new_theta), states, self.segments.read(self.with_values(theta), states)[0]
        )
        found = self._settle(stayed, new_states, new_theta, self.losses(residuals))
        return *found, self.total(found[2], new_theta)

    def _settle(self, stayed: Array, new: Array, theta: Array, before: Array) -> tuple[Array, Array, Array]:
        """Starts, parameters and residuals: the predicted starts, or fitted ones where these are worse than before."""
        residuals = self.residuals(new, theta)
        worse = np.flatnonzero((self.losses(residuals) > before + _WORSE) & self.active)
        if len(worse):
            both = self.segments.pick(np.tile(worse, 2))  # from either start, in one batch of lanes
            begin, count = np.concatenate([new[worse], stayed[worse]]), len(worse)
            fitted = fit_starts(self.with_values(theta), both, begin, _SETTLING, self.threads)
            for starts, theirs in (
                (fitted, self.residuals(fitted, theta, both)),
                (begin, self.residuals(begin, theta, both)),
            ):
                for own in (slice(count), slice(count, None)):
                    self._take_better(new, residuals, starts[own], theirs[own], worse)
        return new, theta, residuals

    def _take_better(self, states: Array, residuals: Array, others: Array, theirs: Array, which: Index) -> None:
        """Replace starts and their residuals by `others` (which, states) where these fit better."""
        better = self.losses(theirs) < self.losses(residuals[which])
        states[which[better]], residuals[which[better]] = others[better], theirs[better]

    def _reseat(self, states: Array, theta: Array, poor_only: bool) -> tuple[Array, Array]:
        """The better start of each segment, the present one or one fitted from its guess; states and residuals."""
        residuals, states = self.residuals(states, theta), states.copy()
        losses = self.losses(residuals)
        which = np.flatnonzero(losses > _POOR * np.median(losses)) if poor_only else np.arange(len(states))
        if len(which):
            part = self.segments.pick(which)
            fresh = fit_starts(self.with_values(theta), part, threads=self.threads)
            self._take_better(states, residuals, fresh, self.residuals(fresh, theta, part), which)
        return states, residuals

    def _outliers(self, residuals: Array) -> NDArray[np.bool_]:
        """Segments whose loss is far above the median, at most the worst 5 %."""
        each = self.losses(residuals)
        most = max(len(each) // 20, 1)
        far = each > OUTLYING * np.median(each)
        return np.asarray(far & (each >= np.sort(each)[-most]))
