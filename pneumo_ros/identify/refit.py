"""Refit of a whole model to recordings by multiple shooting (Bock 1983).

Every run is cut into segments whose initial states are free; each segment is simulated from its own start, and all
starts and all parameters together minimise the whitened, robustly weighted errors (Huber 1964) plus the priors. The few
segments that fit far worse than the rest, breakaways caught in the wrong moment, are left out. The starts are
eliminated segment by segment (Schur complement), so that the cost grows linearly with the data, and all perturbed
simulations of one iteration run as lanes.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from pneumo_ros.errors import DataError, NumericalError, UsageError
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.segments import PROBE, Segments, cut
from pneumo_ros.identify.start import fit_starts
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

SEGMENT = 0.5  # s
TAIL = 4.0  # noise deviations: beyond, errors count less than squared
PRIOR = 0.05  # relative standard deviation of a parameter known to a few per cent
OUTLYING = 4.0  # times the median loss of a segment
_ITERATIONS, _ENOUGH = 20, 0.05  # of one descent: steps, and gain in cost (half a squared deviation) worth another
_ROUNDS, _WORTH = 6, 2.0  # rounds, and gain of a round worth another
_RESAMPLES = 400

# What a scale, a ruler or a table tells better than a motion: fixed unless asked for.
FIXED_SECTIONS = ("piston", "chambers", "air", "end_stop")
FIXED = ("air.supply_pressure", "lugre_friction.bristle_damping", "lugre_friction.breakaway_ratio")


@dataclass(frozen=True)
class Estimate:
    """A refitted parameter: value, standard deviation and 95 % interval in its unit, infinite when not determined."""

    value: float
    std: float
    low: float
    high: float
    before: float
    prior: float  # standard deviation of the prior

    @property
    def determined(self) -> bool:
        """Whether the data say more than was known before: the deviation is below half the prior's."""
        return self.std < 0.5 * self.prior


@dataclass(frozen=True)
class Refit:
    """The refitted model, an estimate per free parameter, their correlation, and the course of the cost."""

    model: Model
    estimates: dict[str, Estimate]
    correlation: Array  # (free, free)
    costs: tuple[float, ...]
    segments: int
    left_out: int  # segments that fit far worse than the rest


def default_free(model: Model) -> tuple[str, ...]:
    """Parameters a refit lets move: all but mass, geometry, gas, end stops and what presliding alone shows."""
    return tuple(
        name for name in model.parameters if name.partition(".")[0] not in FIXED_SECTIONS and name not in FIXED
    )


def refit(
    model: Model,
    runs: Sequence[Run],
    *,
    free: Sequence[str] | None = None,
    priors: Mapping[str, float] | None = None,
    segment: float = SEGMENT,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters (default `default_free`) of a model to all runs together.

    `priors` maps dotted names to standard deviations in the parameter's unit (default 5 % of the value, or of the
    parameter's default where the value is 0). `segment` [s] is the length of the shooting segments. Raises UsageError
    for unknown names, DataError when no run holds a segment, NumericalError when no prediction is finite.
    """
    names = default_free(model) if free is None else tuple(free)
    return refit_segments(model, cut(model, runs, segment), names, priors or {}, threads=threads, progress=progress)


def refit_segments(
    model: Model,
    segments: Segments,
    free: Sequence[str],
    priors: Mapping[str, float],
    *,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters to the given segments; otherwise as `refit`."""
    size = {name: max(abs(model[name]), abs(model.specification(name).default)) for name in free}
    prior = np.array([priors.get(name, PRIOR * size[name]) for name in free])
    if not free or not (prior > 0.0).all():
        raise UsageError("a refit needs at least one free parameter, and priors above zero")
    problem = _Problem(model, tuple(free), prior, segments, threads)
    theta, costs = problem.solve(progress or (lambda share, text: None))
    return problem.result(theta, costs)


class _Problem:
    """Gauss-Newton on starts and parameters, with the starts eliminated."""

    def __init__(self, model: Model, names: tuple[str, ...], prior: Array, segments: Segments, threads: int) -> None:
        if not len(segments):
            raise DataError("no segment without a gap in any of the recordings; give a shorter --segment")
        self.model, self.names, self.prior, self.segments = model, names, prior, segments
        self.columns = [list(model.parameters).index(name) for name in names]
        self.base = np.array([model[name] for name in names])
        specs = [model.specification(name) for name in names]
        self.low, self.high = np.array([s.low for s in specs]), np.array([s.high for s in specs])
        self.threads, self.round = threads, 0
        self.active = np.ones(len(segments), dtype=bool)
        n = segments.guess.shape[1]
        self.tail = np.append(np.full(segments.measured[0].size, TAIL), np.full(n, np.inf))

    def _parameters(self, theta: Array) -> Array:
        """Parameter vectors (..., parameters) for values (..., free)."""
        values = np.tile(self.model.values, (*theta.shape[:-1], 1))
        values[..., self.columns] = theta
        return values

    def _residuals(self, states: Array, theta: Array) -> Array:
        """Whitened errors, then distances of the starts from their guesses (segments, residuals)."""
        residuals: Array = self._lanes(states, np.tile(self._parameters(theta), (len(states), 1)))[0]
        return residuals

    def _lanes(self, states: Array, parameters: Array) -> Array:
        """Residuals (copies, segments, residuals) of copies of all segments."""
        errors = self.segments.residuals(self.model, states, parameters, self.threads)
        return np.concatenate([errors, self.segments.from_guess(self.model, states, parameters)], axis=2)

    def _jacobian(self, states: Array, theta: Array, residuals: Array) -> tuple[Array, Array]:
        """Derivatives (segments, residuals, states) by starts in scales and (..., free) by parameters in priors."""
        steps = self._steps(theta)
        shifted = theta + np.diag(steps)
        n, count = states.shape[1], len(states)
        lanes = np.concatenate([self.segments.probes(states), np.tile(states, (len(theta), 1))])
        values = np.concatenate([np.tile(theta, (n, 1)), shifted])
        parameters = np.repeat(self._parameters(values), count, axis=0)
        change = self._lanes(lanes, parameters) - residuals
        change[:n] /= PROBE
        change[n:] *= (self.prior / steps)[:, None, None]
        moved = np.moveaxis(change, 0, 2)
        return moved[..., :n], moved[..., n:]

    def _cost(self, residuals: Array, states: Array, theta: Array) -> float:
        moved = (theta - self.base) / self.prior
        return float(np.sum(self._losses(residuals)[self.active]) + 0.5 * np.sum(moved**2))

    def _losses(self, residuals: Array) -> Array:
        """Loss (segments,) of whitened errors and of distances from guesses, these squared however far."""
        return np.asarray(np.sum(_loss(residuals, self.tail), axis=1))

    def _blocks(self, states: Array, theta: Array, residuals: Array) -> tuple[Array, ...]:
        """Normal equations segment by segment: parameters (S, p, p), cross (S, p, n), starts (S, n, n), gradients."""
        by_state, by_theta = self._jacobian(states, theta, residuals)
        active = self.active[:, None, None]
        weight = _weight(residuals, self.tail)[..., None] * active
        weight[:, -states.shape[1] :] = 1.0  # starts of segments left out go where they were guessed
        state_t, theta_t = (np.swapaxes(part * weight, 1, 2) for part in (by_state, by_theta * active))
        return (
            theta_t @ by_theta,
            theta_t @ by_state,
            state_t @ by_state,
            (theta_t @ residuals[..., None])[..., 0],
            (state_t @ residuals[..., None])[..., 0],
        )

    def _steps(self, theta: Array) -> Array:
        """Finite-difference steps: a hundredth of the prior, away from a bound."""
        steps = 1e-2 * self.prior
        return np.where(theta + steps > self.high, -steps, steps)

    def solve(self, progress: Progress) -> tuple[Array, list[float]]:
        """Rounds of Levenberg-Marquardt and of reseating starts, until neither helps; parameters and costs on the way.

        A segment whose breakaway is predicted too early or too late sits in a valley of its own, which no descent
        leaves: between rounds every segment's start is fitted afresh from its guess, and the better of both is kept.
        """
        states, theta = self.segments.seated(self.model), self.base.copy()
        costs: list[float] = []
        for self.round in range(_ROUNDS):
            states, theta, course = self._descend(states, theta, progress)
            gained = costs[-1] - course[-1] if costs else np.inf
            costs += course
            if gained < _WORTH:
                break
            states = self._reseat(states, theta)
            self.active = ~self._outliers(states, theta)
        if not np.isfinite(costs[-1]):
            raise NumericalError("the refit found no finite prediction; check the recordings and the model first")
        self.blocks = self._blocks(states, theta, self._residuals(states, theta))
        progress(1.0, f"cost {costs[-1]:.4g}")
        return theta, costs

    def _reseat(self, states: Array, theta: Array) -> Array:
        """The better start of each segment: the one at hand, or one fitted afresh from its guess."""
        values = {name: float(v) for name, v in zip(self.names, theta, strict=True)}
        fresh = fit_starts(self.model.with_parameters(values), self.segments)
        here, there = (self._losses(self._residuals(x, theta)) for x in (states, fresh))
        return np.where((there < here)[:, None], fresh, states)

    def _outliers(self, states: Array, theta: Array) -> NDArray[np.bool_]:
        """Segments whose loss is far above the median, the worst twentieth at most."""
        each = self._losses(self._residuals(states, theta))
        most = max(len(each) // 20, 1)
        far = each > OUTLYING * np.median(each)
        return np.asarray(far & (each >= np.sort(each)[-most]))

    def _descend(self, states: Array, theta: Array, progress: Progress) -> tuple[Array, Array, list[float]]:
        damping, residuals = 1e-3, self._residuals(states, theta)
        costs = [self._cost(residuals, states, theta)]
        for k in range(_ITERATIONS):
            progress(1.0 - 0.5 ** (self.round + k / _ITERATIONS), f"cost {costs[-1]:.4g}")
            blocks = self._blocks(states, theta, residuals)
            while True:
                new_states, new_theta = self._step(states, theta, blocks, damping)
                tried = self._residuals(new_states, new_theta)
                cost = self._cost(tried, new_states, new_theta)
                if cost < costs[-1] or damping > 1e6:
                    break
                damping *= 10.0
            if not cost < costs[-1]:
                break
            states, theta, residuals, damping = new_states, new_theta, tried, max(damping * 0.1, 1e-9)
            costs.append(cost)
            if costs[-2] - costs[-1] < _ENOUGH:
                break
        return states, theta, costs

    def _step(self, states: Array, theta: Array, blocks: tuple[Array, ...], damping: float) -> tuple[Array, Array]:
        A, B, C, g, h = blocks
        damped = C + damping * np.eye(C.shape[1]) * np.einsum("snn->sn", C)[:, None, :]
        reduced, gradient = _eliminate(A, B, damped, g, h)
        total, slope = reduced.sum(0) + np.eye(len(theta)), gradient.sum(0) + (theta - self.base) / self.prior
        total += damping * np.diag(np.diag(total))
        move = -np.linalg.solve(total, slope)
        start_move = -np.linalg.solve(damped, (h + np.einsum("spn,p->sn", B, move))[..., None])[..., 0]
        limited = np.clip(theta + move * self.prior, self.low, self.high)
        return states + start_move * self.segments.scale, limited

    def result(self, theta: Array, costs: list[float]) -> Refit:
        """Estimates with deviations from a bootstrap over segments of the linearised problem."""
        reduced, gradient = _eliminate(*self.blocks)
        reduced, gradient = reduced[self.active], gradient[self.active]
        shifts = _bootstrap(reduced, gradient - gradient.mean(0), len(theta))
        # what only the prior tells does not change when segments are drawn anew: the prior's own deviation counts there
        posterior = np.sqrt(np.diag(np.linalg.inv(reduced.sum(0) + np.eye(len(theta)))))
        drawn = shifts.std(0) * _small_sample(int(np.sum(self.active)))
        deviation = np.maximum(drawn, posterior) * self.prior
        covariance = np.atleast_2d(np.cov(shifts.T))
        scale = np.where(np.diag(covariance) > 0.0, np.sqrt(np.diag(covariance)), np.nan)
        # a direction that only the prior holds is not determined by the data
        information = np.diag(np.linalg.inv(reduced.sum(0) + 1e-9 * np.eye(len(theta))))
        deviation = np.where(information > 1e6, np.inf, deviation)
        estimates = {
            name: Estimate(float(t), float(d), float(t - 1.96 * d), float(t + 1.96 * d), float(b), float(p))
            for name, t, d, b, p in zip(self.names, theta, deviation, self.base, self.prior, strict=True)
        }
        model = self.model.with_parameters({n: float(t) for n, t in zip(self.names, theta, strict=True)})
        return Refit(
            model,
            estimates,
            covariance / np.outer(scale, scale),
            tuple(costs),
            len(self.active),
            int(np.sum(~self.active)),
        )


def _loss(residuals: Array, tail: Array) -> Array:
    size = np.abs(residuals)
    square = np.minimum(size, tail)
    return np.asarray(square * (size - 0.5 * square))


def _weight(residuals: Array, tail: Array) -> Array:
    return np.asarray(np.minimum(1.0, tail / np.maximum(np.abs(residuals), 1e-300)))


def _eliminate(A: Array, B: Array, C: Array, g: Array, h: Array) -> tuple[Array, Array]:
    """Schur complements onto the parameters: (segments, p, p) and gradients (segments, p)."""
    solved = np.linalg.solve(C, np.concatenate([np.swapaxes(B, 1, 2), h[..., None]], axis=2))
    return A - B @ solved[..., :-1], g - (B @ solved[..., -1:])[..., 0]


def _small_sample(segments: int) -> float:
    """How much wider Student's interval over few segments is than the normal one of their resampling."""
    freedom = max(segments - 1, 1)
    return float(student.ppf(0.975, freedom) / 1.96 * np.sqrt(segments / freedom))


def _bootstrap(reduced: Array, gradient: Array, count: int) -> Array:
    """Parameter shifts (resamples, p) when the segments are drawn with replacement."""
    rng = np.random.default_rng(0)
    weights = rng.multinomial(len(reduced), np.full(len(reduced), 1.0 / len(reduced)), _RESAMPLES).astype(float)
    matrices = np.tensordot(weights, reduced, 1) + np.eye(count)
    return np.asarray(-np.linalg.solve(matrices, (weights @ gradient)[..., None])[..., 0])
