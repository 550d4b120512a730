"""One score for models: the log evidence of recordings, in nats, by which effects are added or not.

The residual of an equation along a run, in the unit of the equation, is d + n. n is the noise of the sensors, known for
each window and model and, as a whole, to a tenth. d is what no model has: a stationary process of Ornstein and
Uhlenbeck, of deviation delta and correlation time tau, both of the greatest likelihood under each model. So hundreds of
correlated windows where the shape of a law is wrong count as few. Beyond three deviations the density of an innovation
falls by a power, as that of Student does: single wild windows say little. The likelihood is that of a scalar Kalman
filter (Harvey 1989, Forecasting, structural time series models and the Kalman filter, 3.4), its gain lowered at wild
windows (Masreliez and Martin 1977).

Windows of one width overlap by three quarters: every second one is nearly independent, so both halves count half. An
equation seen through windows of two widths counts half by each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import strain
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis, family_scales, weights
from pneumo_ros.plant import Model
from pneumo_ros.plant.jit import entry

Array = NDArray[np.float64]
Index = NDArray[np.int64]

TAIL = 3.0  # deviations: beyond, an innovation counts by its logarithm
SIZES = 0.5 * 2.0 ** np.arange(12)  # of the discrepancy, over the median noise
TIMES = (0.03, 0.2, 1.0, 5.0)  # s: its correlation time
NOISE = np.linspace(0.9, 1.1, 41)  # of the stated noise, which is known to a tenth
ROUNDS = 2  # of choosing the discrepancy and the noise in turn
BREAKAWAY_NOISE = 0.5  # of the stated spread of breakaways, which is larger than their scatter


@dataclass(frozen=True)
class Score:
    """Nats that a model gains over another one: on the training runs, priors included, and on the held-out runs."""

    train: float
    held: float

    @property
    def nats(self) -> float:
        """All recordings together."""
        return self.train + self.held


@dataclass(frozen=True)
class _Family:
    """The windows of a family that are judged together; arrays (windows,), `weight` is that of each."""

    rows: Index
    weight: float
    single: bool  # without correlation, as breakaways


class Scoring:
    """The windows of training and held-out runs, and the score of residuals along them."""

    def __init__(self, train: Evidence, held: Evidence) -> None:
        self.parts = (train, held)
        self.names = tuple(dict.fromkeys([*train.names, *held.names]))
        self.families = [[_split(part, name) for part in self.parts] for name in self.names]

    def evidence(self, model: Model, train: Array, held: Array) -> Array:
        """Log evidence (2,) of the residuals over noise that `model` leaves in training and held-out runs."""
        values = [residual * part.noise for part, residual in zip(self.parts, (train, held), strict=True)]
        levels = [part.noise_of(model) for part in self.parts]
        return np.asarray(np.sum([self._of_family(own, values, levels) for own in self.families], axis=0))

    def _of_family(
        self, own: Sequence[Sequence[_Family]], residuals: Sequence[Array], levels: Sequence[Array]
    ) -> Array:
        """Log evidence (2,) of one family, at the discrepancy and the noise of the greatest likelihood."""
        noise = np.concatenate([part.noise[f.rows] for part, some in zip(self.parts, own, strict=True) for f in some])
        if not len(noise):
            return np.zeros(2)
        single, median = own[0][0].single, float(np.median(noise))
        times = (0.0,) if single else TIMES
        scale, best = 1.0, (0.0, times[0])

        def likelihood(size: float, time: float, scale: float) -> tuple[Array, Array]:
            scale *= BREAKAWAY_NOISE if single else 1.0
            return self._likelihood(own, residuals, levels, size * median, time, scale)

        for _ in range(ROUNDS):
            options = [(0.0, times[0]), *product(SIZES.tolist(), times)]
            best = max(options, key=lambda one: float(likelihood(one[0], one[1], scale)[0].sum()))
            if not single:
                scale = max(NOISE, key=lambda one: float(likelihood(*best, one)[0].sum()))
        return likelihood(*best, scale)[1]

    def _likelihood(
        self,
        own: Sequence[Sequence[_Family]],
        residuals: Sequence[Array],
        levels: Sequence[Array],
        size: float,
        time: float,
        scale: float,
    ) -> tuple[Array, Array]:
        """Log likelihood (2,) of training and held-out runs; and the same without what noise alone costs."""
        whole, beyond = np.zeros(2), np.zeros(2)
        for k, (part, some, residual, level) in enumerate(zip(self.parts, own, residuals, levels, strict=True)):
            for f in some:
                rows = f.rows
                given = residual[rows], scale * level[rows], part.noise[rows], part.time[rows], part.run[rows]
                values = f.weight * np.array(_log_likelihood(*given, size, time, TAIL))
                whole[k] += values[0]
                beyond[k] += values[1]
        return whole, beyond


def _split(part: Evidence, name: str) -> list[_Family]:
    rows = np.flatnonzero(part.family == part.names.index(name)) if name in part.names else np.empty(0, dtype=np.int64)
    if name == "breakaway":
        return [_Family(rows, 1.0, True)]
    return [_Family(rows[k::2], 0.25, False) for k in (0, 1)]


@entry
def _log_likelihood(residual, noise, usual, time, run, size, correlation, tail):  # type: ignore[no-untyped-def]
    """Of residuals (n,) with `noise` (n,); and the same without what noise alone costs, where `usual` (n,) is its unit.

    A model that amplifies the noise of the sensors less explains no more than another one. Its discrepancy, however, is
    not counted in units of that noise: a heavy piston would make any force look small.
    """
    total, beyond, mean, variance, full = 0.0, 0.0, 0.0, 0.0, size * size
    for k in range(len(residual)):
        if k > 0 and run[k] == run[k - 1] and correlation > 0.0:
            kept = np.exp((time[k - 1] - time[k]) / correlation)
            mean, variance = kept * mean, kept * kept * variance + full * (1.0 - kept * kept)
        else:
            mean, variance = 0.0, full
        spread = variance + noise[k] * noise[k]
        error = residual[k] - mean
        square, edge = error * error / spread, tail * tail
        wild = max(square / edge, 1.0)
        loss = min(square, edge) + edge * np.log(wild)
        total -= 0.5 * (loss + np.log(spread))
        beyond -= 0.5 * (loss + np.log(1.0 + variance / (usual[k] * usual[k])))
        gain = variance / spread / wild
        mean, variance = mean + gain * error, variance * (1.0 - gain)
    return total, beyond


def occam(base: BaseFit, h: Hypothesis) -> float:
    """Nats that the free coordinates of a candidate cost: half the log determinant of 1 + prior information.

    Their prior is one usual size, or a factor e; what base parameters may replace is no information.
    """
    w = weights(base.evidence, h.residual, family_scales(base.evidence, h.residual))
    A, p = np.concatenate([base.slopes, h.slopes], axis=1) * w[:, None], len(base.names)
    normal = A.T @ A
    own = normal[:p, :p] + np.eye(p)
    information = normal[p:, p:] - normal[p:, :p] @ np.linalg.solve(own, normal[:p, p:])
    return 0.5 * float(np.linalg.slogdet(np.eye(len(information)) + information)[1])


def prior_gain(base: BaseFit, nothing: Hypothesis, h: Hypothesis) -> float:
    """Log prior of a candidate's coordinates and base parameters, minus that of base parameters without it."""
    return strain(nothing.shift + base.offset) - strain(h.shift + base.offset) - 0.5 * float(h.u @ h.u)
