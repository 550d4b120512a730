"""One score for models: the log evidence of recordings, in nats, by which effects are added or not.

The residual of an equation along a run, in the unit of the equation, is d + n. n is the noise of the sensors, known for
each window and model and, as a whole, to 5 %, alike for all models that are compared. d is what no model has: a
stationary process of Ornstein and Uhlenbeck, of deviation delta and correlation time tau, both of the greatest
likelihood under each model. So hundreds of correlated windows where the shape of a law is wrong count as few. Beyond
three deviations the density of an innovation falls by a power, as that of Student does: single wild windows say little.
The likelihood is that of a scalar Kalman filter (Harvey 1989, Forecasting, structural time series models and the Kalman
filter, 3.4), its gain lowered at wild windows (Masreliez and Martin 1977).

Windows of one width overlap by three quarters: every second one is nearly independent, so both halves count half. An
equation seen through windows of two widths counts half by each.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.basefit import strain
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.freedom import points_of
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis, gathered, own_weights
from pneumo_ros.plant import Model
from pneumo_ros.plant.jit import entry

Array = NDArray[np.float64]

TAIL = 3.0  # deviations: beyond, an innovation counts by its logarithm
SIZES = (0.0, *(0.5 * 2.0**k for k in range(12)))  # of the discrepancy, over the median noise
TIMES = (0.03, 0.2, 1.0, 5.0)  # s: its correlation time
NOISE = tuple(0.9 + 0.005 * k for k in range(41))  # of the stated noise
STEPS, SHARE, LITTLE = 3, 0.3, 0.5  # of base parameters: most steps, share tried of a poor one, least gain to go on
USUAL = 0.0, 0.0, 1.0  # size and correlation time of the discrepancy, and scale of the noise, where nothing is known
EXACT = 4  # parabolas, each closer to the largest value
FINE, REACH = 0.01, 4.0  # of the scale of the noise: a step of parabolas; and how many of them at a time
ROUNDS = 2  # of choosing the discrepancy and the noise in turn
MARGIN = 8.0  # nats that an effect must gain: the logarithm of some thirty candidates, and 5 for odds of 150 to 1
# Nats: models that differ by less explain as much as each other, and the simpler one is taken. More are called strong
# evidence (Kass and Raftery 1995, Bayes factors: twice its logarithm above 6).
AS_MUCH = 3.0
WRONG_LINE = MARGIN  # a line of the machine file that is wrong: no more than an effect, so that one such line is none
EVEN, SAFE = 1e-9, 1e-200  # share by which even gaps differ by rounding; products are finite from here to the inverse
STATED = 0.05  # deviation of the noise from what recordings state
# Share to which it is known how much a model amplifies the noise, beside another one. Candidates that explain nothing
# differ by 0.001; with 0.03 a friction along the stroke beside a hysteresis still loses 29 nats that it should not.
AMPLIFIED = 0.01
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


Noise = tuple[float, float, float]  # size and correlation time of a discrepancy, scale of the noise
Fit = tuple[Array, Array, Array]  # residuals of training and held-out runs over noise, shift of base parameters


@dataclass(frozen=True)
class Best:
    """Log evidence (parts,) of training and held-out runs, and the fit that is best for all of them.

    noise: by family, size and correlation time of its discrepancy and the scale of the sensors' noise.
    """

    evidence: Array
    fit: Fit
    noise: dict[str, Noise]


def moved(fit: Fit, fits: tuple[BaseFit, BaseFit], step: Array) -> Fit:
    """A fit with its base parameters moved by a step (free,), by the slopes of training and held-out residuals."""
    return fit[0] + fits[0].slopes @ step, fit[1] + fits[1].slopes @ step, fit[2] + step


class Scoring:
    """The windows of training and held-out runs, or of some of them alone, and the score of residuals along them."""

    def __init__(self, *parts: Evidence) -> None:
        self.parts = parts
        self.names = tuple(dict.fromkeys(name for part in parts for name in part.names))
        # Size and correlation time of the discrepancy and scale of the noise, by family; empty: each model has its own.
        self.usual = dict[str, Noise]()

    def measure(self, model: Model, *residuals: Array) -> None:
        """Take the scale of the sensors' noise from what `model` leaves: it is the same for models compared to it."""
        self.usual = {}
        self.usual = {family.name: family.best for family in self._families(model, residuals)}

    def at(self, model: Model, *residuals: Array) -> Best:
        """The log evidence of the residuals over noise that `model` leaves in each part of the runs.

        Noise and discrepancy are those of the greatest likelihood in all of them; base parameters are as they are.
        """
        return _reached(self._families(model, residuals), (residuals[0], residuals[-1], np.zeros(0)))

    def in_noise_of(self, others: Sequence[Best], model: Model, best: Best) -> list[Best]:
        """A model's best fit, each family in the noise that another one found, if it gains more there than in its own.

        For each of the others. All have the same sensors. Where the noise may as well be a little larger and the
        discrepancy smaller, the model that came upon it gains hundreds of nats, which are no merit of it.
        """

        def evidences(noise: Mapping[str, Noise]) -> list[Array]:
            return [family.evidence() for family in self._families(model, best.fit[: len(self.parts)], noise)]

        own, found = evidences(best.noise), list[Best]()
        for other in others:
            gains = [there - here for there, here in zip(evidences(other.noise), own, strict=True)]
            more = np.sum([gain for gain in gains if gain.sum() > 0.0], axis=0)
            found.append(replace(best, evidence=best.evidence + more))
        return found

    def heldout(self, model: Model, best: Best, without: Model, plain: Best) -> float:
        """Nats that the held-out runs gain by themselves from the best fit of one model, `without`, to that of another.

        What no model has may be another thing in them, as where an effect that is still missing acts more: each model
        has the discrepancy that is best for them alone.
        """
        alone = Scoring(self.parts[1])
        alone.usual = self.usual
        after, before = alone.at(model, best.fit[1]), alone.at(without, plain.fit[1])
        return float((after.evidence - alone.in_noise_of([after], without, before)[0].evidence).sum())

    def _families(
        self, model: Model, residuals: Sequence[Array], usual: Mapping[str, Noise] | None = None
    ) -> list["_Family"]:
        """The families of the training runs' residuals, or of those and the held-out runs'."""
        usual, parts = usual or self.usual, self.parts[: len(residuals)]
        levels = [part.noise_of(model) for part in parts]
        return [_Family(name, parts, residuals, levels, usual.get(name)) for name in self.names]

    def best(self, model: Model, fits: tuple[BaseFit, BaseFit], starts: Sequence[Fit], threads: int = 1) -> Best:
        """The log evidence of a fit, its base parameters moved to where that of all runs is largest.

        `fits`: slopes of training and held-out residuals. A fit to windows as if they were independent leaves a little
        of what parameters explain, which the correlation of the discrepancy makes worth many nats. What training hardly
        determines, such as friction at a place that it passed once, must not decide on held-out runs; and what is
        missing may differ between recordings, so that training alone would ask for another discrepancy.

        `starts`: one fit or several that differ in base parameters. A slow and a fast discrepancy have largest evidence
        at different base parameters, tens of nats apart, and a climb ends at that which is nearer.
        """

        def valued(one: Fit) -> tuple[float, Best, list[_Family]]:
            families = self._families(model, one[:2])
            found = _reached(families, one)
            return float(found.evidence.sum()) - strain(one[2] + fits[0].offset), found, families

        with ThreadPoolExecutor(threads) as pool:
            best = max(pool.map(valued, starts), key=lambda one: one[0])
        for _ in range(STEPS):
            step = self._step(fits, best[1].fit, best[2])
            tried = valued(moved(best[1].fit, fits, step))
            if not tried[0] > best[0] + LITTLE:
                tried = max(tried, valued(moved(best[1].fit, fits, SHARE * step)), key=lambda one: one[0])
            if not tried[0] > best[0]:
                break
            gained, best = tried[0] - best[0], tried
            if gained < LITTLE:
                break
        return best[1]

    def _step(self, fits: tuple[BaseFit, BaseFit], fitted: Fit, families: Sequence["_Family"]) -> Array:
        """The step (free,) of base parameters by generalised least squares; `families`: those of the fit."""
        normal, slope = np.eye(len(fits[0].names)), fitted[2] + fits[0].offset
        for family in families:
            for part, fit in enumerate(fits):
                A, b = family.normal(part, fit.slopes)
                normal, slope = normal + A, slope + b
        return np.asarray(-np.linalg.solve(normal, slope))


class _Family:
    """The windows of one family that a model leaves, in training runs, or in those and in held-out runs."""

    def __init__(
        self,
        name: str,
        parts: Sequence[Evidence],
        residuals: Sequence[Array],
        levels: Sequence[Array],
        usual: Noise | None,
    ) -> None:
        self.name, self.usual, self.known = name, usual or USUAL, AMPLIFIED if usual else STATED
        self.single = name == "breakaway"  # without correlation
        self.weight = 1.0 if self.single else 0.25
        self.series: list[list[tuple[Array, ...]]] = []
        self.rows: list[list[NDArray[np.int64]]] = []
        for part, residual, level in zip(parts, residuals, levels, strict=True):
            rows = np.flatnonzero(part.family == part.names.index(name)) if name in part.names else np.arange(0)
            halves = [rows] if self.single else [rows[0::2], rows[1::2]]
            self.rows.append(halves)
            self.series.append(
                [(residual[k] * part.noise[k], level[k], part.noise[k], part.time[k], part.run[k]) for k in halves]
            )
        noise = np.concatenate([one[2] for some in self.series for one in some])
        self.median = float(np.median(noise)) if len(noise) else 0.0
        self._known: dict[Noise, tuple[Array, Array]] = {}

    def evidence(self) -> Array:
        """Log evidence (parts,) at the discrepancy and the noise of the greatest likelihood."""
        if not self.median:
            return np.zeros(len(self.series))
        best = self.best
        found: Array = self._likelihood(*best)[1].copy()
        found[0] -= self._strain(best[2])
        return found

    @cached_property
    def best(self) -> Noise:
        """Size and correlation time of the discrepancy, and scale of the noise, of the greatest likelihood."""
        return self._best() if self.median else USUAL

    def normal(self, part: int, slopes: Array) -> tuple[Array, Array]:
        """Normal matrix and gradient of base parameters by their `slopes` (residuals, free) in a part of the runs."""
        matrix, gradient = np.zeros((slopes.shape[1], slopes.shape[1])), np.zeros(slopes.shape[1])
        at = self.best
        for rows, (residual, level, noise, seconds, run) in zip(self.rows[part], self.series[part], strict=True):
            both = np.column_stack([residual, slopes[rows] * noise[:, None]])
            _whiten(both, at[2] * level, seconds, run, at[0] * self.median, at[1], TAIL)
            A = both[:, 1:]
            matrix, gradient = matrix + self.weight * A.T @ A, gradient + self.weight * A.T @ both[:, 0]
        return matrix, gradient

    def _best(self) -> Noise:
        times, scales = ((0.0,), (BREAKAWAY_NOISE,)) if self.single else (TIMES, NOISE)
        (size, time, near), scale = self.usual, scales[len(scales) // 2]
        for _ in range(ROUNDS):
            tried = []
            for time in times:
                size = _peak(SIZES, partial(self._whole, time=time, scale=scale), size)
                tried.append((size, time, scale))
            size, time, _ = max(tried, key=lambda at: self._whole(*at))
            times, scale = (time,), _peak(scales, partial(self._whole, size, time), near)
            near = scale
        return (size, time, scale) if self.single else self._exact(size, time, scale)

    def _exact(self, size: float, time: float, scale: float) -> Noise:
        """Size of the discrepancy and scale of the noise of the greatest likelihood, between the steps of the options.

        Both together: a fast discrepancy and more noise nearly are the same, and differ by hundreds of nats in what is
        left without the cost of noise.
        """

        def at(move: Array) -> Noise:
            larger = float(np.exp(np.log(2.0) * move[1])) if size > 0.0 else 1.0
            scaled = scale + float(move[0]) * FINE
            return size * larger, time, min(max(scaled, NOISE[0]), NOISE[-1])

        return at(_top(lambda move: self._whole(*at(move)), 2 if size > 0.0 else 1))

    def _whole(self, size: float, time: float, scale: float) -> float:
        return float(self._likelihood(size, time, scale)[0].sum()) - self._strain(scale)

    def _strain(self, scale: float) -> float:
        """Nats by which a scale of the noise is less probable than the usual one."""
        return 0.0 if self.single else 0.5 * ((scale / self.usual[2] - 1.0) / self.known) ** 2

    def _likelihood(self, size: float, time: float, scale: float) -> tuple[Array, Array]:
        """Log likelihood (parts,) of training and held-out runs; and the same without what noise alone costs."""
        at = size, time, scale
        if at not in self._known:
            values = np.zeros((2, len(self.series)))
            for k, some in enumerate(self.series):
                for residual, level, _noise, seconds, run in some:
                    both = _log_likelihood(residual, scale * level, level, seconds, run, size * self.median, time, TAIL)
                    values[:, k] += self.weight * np.array(both)
            self._known[at] = values[0], values[1]
        return self._known[at]


def _evidence(families: Sequence[_Family]) -> Array:
    """Log evidence (parts,) of all families."""
    return np.asarray(np.sum([family.evidence() for family in families], axis=0))


def _reached(families: Sequence[_Family], fit: Fit) -> Best:
    """A fit of which all families are known, with its log evidence and the noise it found."""
    return Best(_evidence(families), fit, {family.name: family.best for family in families})


def _peak(options: Sequence[float], value: Callable[[float], float], near: float) -> float:
    """The option of the largest value, which rises up to it and falls beyond; sought from the option next to `near`."""
    at = int(np.argmin(np.abs(np.array(options) - near)))
    for way in (1, -1):
        begin = at
        while 0 <= at + way < len(options) and value(options[at + way]) > value(options[at]):
            at += way
        if at != begin:
            break
    return options[at]


def _top(value: Callable[[Array], float], count: int) -> Array:
    """Where near 0 (count,) the value is largest, by parabolas through points about one apart, then closer ones."""
    at, width = np.zeros(count), 1.0
    for _ in range(EXACT):
        steps = width * np.eye(count)
        here, up = value(at), [value(at + step) for step in steps]
        down = [value(at - step) for step in steps]
        bent = np.diag([2.0 * here - one - other for one, other in zip(up, down, strict=True)])
        if count == 2:
            bent[0, 1] = bent[1, 0] = up[0] + up[1] - here - value(at + steps[0] + steps[1])
        slope = 0.5 * (np.array(up) - np.array(down))
        if np.all(np.linalg.eigvalsh(bent) > 0.0):
            move = np.linalg.solve(bent, slope)
        else:
            move = np.sign(slope)
        tried = at + width * move / max(1.0, float(np.abs(move).max()) / REACH)
        at, width = (tried, 0.3 * width) if value(tried) >= here else (at, 0.3 * width)
    return at


@entry  # numba finds the types by the call
def _log_likelihood(residual, noise, usual, time, run, size, correlation, tail):  # type: ignore[no-untyped-def]
    """Of residuals (n,) with `noise` (n,); and the same without what noise alone costs, where `usual` (n,) is its unit.

    A model that amplifies the noise of the sensors less explains no more than another one, and its discrepancy counts
    in units of that noise: a force that nothing explains moves the piston, and is seen by the noisy motion. Most
    windows are evenly spaced, so that the exponential is kept; logarithms of factors (`SAFE`) are taken together.
    """
    total, beyond, mean, variance, full = 0.0, 0.0, 0.0, 0.0, size * size
    edge, gap, kept = tail * tail, 0.0, 1.0
    spreads, excesses = 1.0, 1.0
    for k in range(len(residual)):
        if k > 0 and run[k] == run[k - 1] and correlation > 0.0:
            apart = time[k] - time[k - 1]
            if abs(apart - gap) > EVEN * gap:
                gap, kept = apart, np.exp(-apart / correlation)
            mean, variance = kept * mean, kept * kept * variance + full * (1.0 - kept * kept)
        else:
            mean, variance = 0.0, full
        spread = variance + noise[k] * noise[k]
        error = residual[k] - mean
        square, wild = error * error / spread, 1.0
        if square > edge:
            wild = square / edge
            square = edge + edge * np.log(wild)
        total -= 0.5 * square
        beyond -= 0.5 * square
        spreads, excesses = spreads * spread, excesses * (1.0 + variance / (usual[k] * usual[k]))
        if not (SAFE < spreads < 1.0 / SAFE and excesses < 1.0 / SAFE):
            total, beyond = total - 0.5 * np.log(spreads), beyond - 0.5 * np.log(excesses)
            spreads, excesses = 1.0, 1.0
        gain = variance / spread / wild
        mean, variance = mean + gain * error, variance * (1.0 - gain)
    return total - 0.5 * np.log(spreads), beyond - 0.5 * np.log(excesses)


@entry
def _whiten(series, noise, time, run, size, correlation, tail):  # type: ignore[no-untyped-def]
    """Residuals and slopes (n, 1 + free) in place: their innovations over the deviation, less at wild windows."""
    n, columns = series.shape
    mean, variance, full = np.zeros(columns), 0.0, size * size
    for k in range(n):
        if k > 0 and run[k] == run[k - 1] and correlation > 0.0:
            kept = np.exp((time[k - 1] - time[k]) / correlation)
            variance = kept * kept * variance + full * (1.0 - kept * kept)
        else:
            kept, variance = 0.0, full
        spread = variance + noise[k] * noise[k]
        wild = max((series[k, 0] - kept * mean[0]) ** 2 / spread / (tail * tail), 1.0)
        gain, over = variance / spread / wild, 1.0 / np.sqrt(spread * wild)
        for j in range(columns):
            error = series[k, j] - kept * mean[j]
            mean[j] = kept * mean[j] + gain * error
            series[k, j] = error * over
        variance *= 1.0 - gain


def occam(base: BaseFit, h: Hypothesis, spread: float = 1.0) -> float:
    """Nats that the free coordinates of a candidate cost: half the log determinant of 1 + prior information.

    Their prior is `spread` usual sizes, or a factor e; what base parameters may replace is no information.
    """
    w = own_weights(base.evidence, h.residual)
    expected = spread * np.array([c.expected for c in h.coordinates])
    normal, p = gathered((base.slopes, h.slopes * expected), w, h.residual)[0], len(base.names)
    own = normal[:p, :p] + np.eye(p)
    information = normal[p:, p:] - normal[p:, :p] @ np.linalg.solve(own, normal[:p, p:])
    return 0.5 * float(np.linalg.slogdet(np.eye(len(information)) + information)[1])


def log_prior(free: BaseFit, shift: Array, h: Hypothesis) -> float:
    """Log prior of a candidate's coordinates and of its base parameters, at a shift (free,) of these.

    Where they hold the candidate's own points, as those of a profile, its coordinates count among them.
    """
    own = 0.0 if points_of(free, h.coordinates).any() else h.surprise
    return -surprise(free, shift) - own


def surprise(base: BaseFit, shift: Array) -> float:
    """Nats by which shifted base parameters (free,) are less probable than at the centres of their priors.

    A parameter is as well known as its prior says, or its line in the machine file is wrong, which costs as much as an
    effect must be worth: one wrong line is no effect; several that moved together are less probable than the effect
    that explains them. The points of a profile that the model lacks are no lines of its file: more than a texture is an
    effect.
    """
    offset, lines = base.offset + shift, base.lines
    wrong = np.logaddexp(-0.5 * offset[lines] ** 2, -WRONG_LINE) - np.logaddexp(0.0, -WRONG_LINE)
    return strain(offset[~lines]) - float(np.sum(wrong))
