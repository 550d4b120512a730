"""Estimates of the parameters of a fit: values, deviations, correlation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # Student's t, without the slow import of scipy.stats

from pneumo_ros.plant import Model
from pneumo_ros.shooting.problem import Unknowns
from pneumo_ros.shooting.shooting import Solution

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_RESAMPLES = 400


@dataclass(frozen=True)
class Estimate:
    """A refitted parameter: value, standard deviation and 95 % interval in its unit, infinite when not determined."""

    value: float
    std: float
    low: float
    high: float
    before: float  # where the prior is centred
    prior: float  # standard deviation of the prior

    @property
    def determined(self) -> bool:
        """Whether the data determine the parameter: its deviation is below half the prior's."""
        return self.std < 0.5 * self.prior


@dataclass(frozen=True)
class Refit:
    """The refitted model, an estimate per free parameter, their correlation, and the cost by iteration.

    `starts` (segments, states) are the fitted initial states of the used segments, `chosen` (segments,) their indices
    among all segments; another refit may start from them.
    """

    model: Model
    estimates: dict[str, Estimate]
    correlation: Array  # (free, free)
    costs: tuple[float, ...]
    segments: int
    left_out: int  # segments that fit far worse than the rest
    starts: Array
    chosen: Index


def estimates(unknowns: Unknowns, solution: Solution) -> tuple[dict[str, Estimate], Array]:
    """Estimates by name and correlation (free, free), from a bootstrap over segments of the linearised problem."""
    active, theta, prior = solution.active, solution.theta, unknowns.prior
    matrices, gradients = solution.equations.matrix[active], solution.equations.gradient[active]
    # gradients that the next step would remove are no scatter; segments without information keep a gradient of zero
    rest = np.linalg.lstsq(matrices.sum(0), gradients.sum(0), rcond=1e-12)[0]
    shifts = _bootstrap(matrices, gradients - matrices @ rest)
    # a parameter that only the prior determines does not vary between resamples: its posterior deviation counts
    posterior = np.sqrt(np.diag(np.linalg.inv(matrices.sum(0) + np.eye(len(theta)))))
    drawn = np.minimum(shifts.std(0) * _small_sample(len(matrices)), 1.0)  # data never increase the prior's deviation
    deviation = np.maximum(drawn, posterior) * prior
    covariance = np.atleast_2d(np.cov(shifts.T))
    scale = np.where(np.diag(covariance) > 0.0, np.sqrt(np.diag(covariance)), np.nan)
    # a parameter that only the prior determines is not determined by the data
    information = np.diag(np.linalg.inv(matrices.sum(0) + 1e-9 * np.eye(len(theta))))
    deviation = np.where(information > 1e6, np.inf, deviation)
    found = {
        name: Estimate(float(t), float(d), float(t - 1.96 * d), float(t + 1.96 * d), float(c), float(p))
        for name, t, d, c, p in zip(unknowns.names, theta, deviation, unknowns.centre, prior, strict=True)
    }
    return found, covariance / np.outer(scale, scale)


def _small_sample(segments: int) -> float:
    """Ratio of Student's interval for few segments to the normal interval of their resampling."""
    freedom = max(segments - 1, 1)
    return float(stdtrit(freedom, 0.975) / 1.96 * np.sqrt(segments / freedom))


def _bootstrap(matrices: Array, gradients: Array) -> Array:
    """Parameter shifts (resamples, p) when the segments are drawn with replacement."""
    rng = np.random.default_rng(0)
    count = len(matrices)
    weights = rng.multinomial(count, np.full(count, 1.0 / count), _RESAMPLES).astype(float)
    drawn = np.tensordot(weights, matrices, 1) + np.eye(matrices.shape[1])
    return np.asarray(-np.linalg.solve(drawn, (weights @ gradients)[..., None])[..., 0])
