"""The current model fitted to the evidence: base parameters and accepted effects, within their priors.

The measured acceleration is a factor of a mass, and noisy: least squares that counted residuals in a fixed unit would
draw the mass towards zero (attenuation). Each model's residual counts in the noise that its own mass amplifies, which
is Deming's regression and consistent (Fuller 1987, Measurement error models, 1.3).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import (
    OVERLAP,
    BaseFit,
    Hypothesis,
    family_scales,
    huber,
    log_likelihood,
    own_weights,
    solve,
    solve_within,
    vectors,
    weights,
)
from pneumo_ros.plant import Model
from pneumo_ros.shooting.physical import physical

Array = NDArray[np.float64]

ITERATIONS, ROUNDS_EACH = 40, 12  # sets of slopes, and rounds with each of them
# Log likelihood (a parameter 0.3 deviations off its best) and share of the loss: after a smaller gain no other round
LITTLE, SMALL_SHARE = 0.05, 1e-4
SHARES = (0.3, 0.1)  # of a step, tried where all of it does not gain
REWEIGHTED = 3  # least-squares solutions of a round, each weighted by the residual of the previous solution


@dataclass(frozen=True)
class Known:
    """Priors of the free parameters: centres and standard deviations; arrays (free,).

    `step`: finite-difference step of each parameter.
    """

    names: tuple[str, ...]
    centre: Array
    prior: Array
    step: Array

    def offset(self, model: Model) -> Array:
        """How far the parameters (free,) of `model` are from the centres, in standard deviations."""
        return np.asarray((np.array([model[n] for n in self.names]) - self.centre) / self.prior)


@dataclass(frozen=True)
class Fitted:
    """A fitted model, the sets of slopes it took, and whether it settled: if not, the bound on rounds was reached."""

    model: Model
    taken: int
    settled: bool


def strain(offset: Array) -> float:
    """Log likelihood lost to the priors; offset (free,): distance of the parameters from the prior centres."""
    return 0.5 * float(np.sum(offset**2))


def residuals(
    evidence: Evidence, model: Model, variants: Sequence[Mapping[str, float]], ranking: bool = False
) -> Array:
    """Residuals (variants, residuals) of `model` with some values changed; `ranking` as in `Evidence.residuals`."""
    return evidence.residuals(model, vectors(model, variants), ranking=ranking)


class OwnNoise:
    """Residuals in units of the noise that each model's own mass amplifies.

    What `model` leaves beyond that noise, in `residual` (residuals,) over that of the windows, has another cause: a
    heavier load does not amplify it.
    """

    def __init__(self, evidence: Evidence, model: Model, residual: Array) -> None:
        self.evidence = evidence
        self.load = evidence.load(model)
        self.here = evidence.by_load(self.load)
        self.square = family_scales(evidence, residual / self.here)[evidence.family] ** 2

    def of(self, models: Sequence[Model], found: Array) -> Array:
        """Residuals of other models in the noise of `model`, from those over the noise of the windows, in place.

        found (models, residuals): a model that amplifies noise by twice as much has half of the residual.
        """
        for row, one in zip(found, models, strict=True):
            row /= self.unit(one)
        return found

    def unit(self, other: Model) -> Array | float:
        """Noise (residuals,) of another model over that of `model`; 1 where they carry the same load."""
        load = self.evidence.load(other)
        if load == self.load:
            return 1.0
        grown = (self.evidence.by_load(load) / self.here) ** 2
        return np.asarray(np.sqrt(1.0 + (grown - 1.0) / self.square))


def slopes(evidence: Evidence, model: Model, known: Known) -> tuple[Array, Array]:
    """Residual (residuals,) of `model`, and its derivative (residuals, free) by each free parameter per prior.

    Both in the noise of the windows; a parameter that amplifies it counts as `OwnNoise` says.
    """
    return _slopes(evidence, model, known)[1:]


def _slopes(evidence: Evidence, model: Model, known: Known) -> tuple[OwnNoise, Array, Array]:
    """The same, and the noise in which the residuals of the probes counted."""
    ends = np.array([model.specification(n).high for n in known.names])
    here = np.array([model[n] for n in known.names])
    steps = np.where(here + known.step > ends, -known.step, known.step)
    variants = [{}, *({n: x} for n, x in zip(known.names, here + steps, strict=True))]
    residual = residuals(evidence, model, [{}])[0]
    own = OwnNoise(evidence, model, residual)
    r = residuals(evidence, model, variants, ranking=True)  # differences need no more
    r = own.of([model.with_parameters(variant) for variant in variants], r)
    return own, residual, np.asarray(((r[1:] - r[0]) / (steps / known.prior)[:, None]).T)


def fit_base(
    evidence: Evidence, model: Model, known: Known, iterations: int = ITERATIONS, share: float = SMALL_SHARE
) -> Fitted:
    """Gauss-Newton from `model`, within the priors of its parameters.

    Every round is judged by one objective, `_objective`: a step is taken only if it raises the log likelihood, so no
    model is visited twice. Slopes are renewed where a round gains less than they promised, and where they promise no
    further gain: they hardly change, and cost most. Rounds end when slopes promise no further gain that are new, or
    that erred by as little in all that they promised, in the same noise; at the latest after `iterations` sets of
    slopes and `ROUNDS_EACH` rounds for each of them. A round pays that gains more than `LITTLE`, and `share` of the
    loss.
    """
    descent = _Descent(evidence, known, model, share)
    for taken in range(1, iterations + 1):
        descent.renew()
        erred = 0.0
        for number in range(ROUNDS_EACH):
            gain, promised = descent.step()
            if descent.little(gain):
                if number == 0 or (descent.little(erred + promised) and descent.in_the_same_noise()):
                    return Fitted(descent.model, taken, True)
                break
            if not descent.little(promised - gain):
                break
            erred += abs(gain - promised)
    return Fitted(descent.model, iterations, False)


class _Descent:
    """A model on its way to the best fit: its residual and the latest slopes, in the noise of `own`."""

    def __init__(self, evidence: Evidence, known: Known, model: Model, share: float) -> None:
        self.evidence, self.known, self.model, self.share = evidence, known, model, share
        specified = [model.specification(n) for n in known.names]
        self.low, self.high = np.array([s.low for s in specified]), np.array([s.high for s in specified])
        self.residual = self.slopes = np.empty(0)

    def renew(self) -> None:
        """Compute residual and slopes at the current model: windows of chambers have the volumes of the model asked."""
        self.own, residual, steep = _slopes(self.evidence, self.model, self.known)
        self.residual, self.slopes = residual / self.own.here, steep / self.own.here[:, None]

    def in_the_same_noise(self) -> bool:
        """Whether the model at hand amplifies noise as that of the slopes does."""
        return self.evidence.load(self.model) == self.own.load

    def little(self, gain: float) -> bool:
        """Whether a gain in log likelihood is too small for another round."""
        return gain < LITTLE + self.share * _loss(self.evidence, self.residual)

    def step(self) -> tuple[float, float]:
        """Take the next step or a share of it, if that gains; the gain, and the gain that the slopes predicted.

        Nothing is tried where they predict little.
        """
        theta = np.array([self.model[n] for n in self.known.names])
        offset = (theta - self.known.centre) / self.known.prior
        x, after = self._wanted(theta, offset)
        before = _objective(self.evidence, self.residual, offset)
        promised = _objective(self.evidence, after, offset + x) - before
        if self.little(promised):
            return 0.0, promised
        tried = self._tried(theta, x, (1.0,))
        if not tried[0][0] > before:
            tried += self._tried(theta, x, SHARES)
        objective, variant, residual = max(tried, key=lambda one: one[0])
        gain = objective - before
        if gain > 0.0:
            self.model, self.residual = self.model.with_parameters(variant), residual
        return gain, promised

    def _tried(self, theta: Array, x: Array, shares: Sequence[float]) -> list[tuple[float, dict[str, float], Array]]:
        """Objective, values and residual of shares of a step x (free,) from theta."""
        names, prior = self.known.names, self.known.prior
        values = [np.clip(theta + share * x * prior, self.low, self.high) for share in shares]
        values = [physical(self.model, names, own) for own in values]
        variants = [dict(zip(names, own.tolist(), strict=True)) for own in values]
        models = [self.model.with_parameters(variant) for variant in variants]
        found = self.own.of(models, residuals(self.evidence, self.model, variants)) / self.own.here
        offsets = [(own - self.known.centre) / prior for own in values]
        objectives = [_objective(self.evidence, r, o) for r, o in zip(found, offsets, strict=True)]
        return list(zip(objectives, variants, found, strict=True))

    def _wanted(self, theta: Array, offset: Array) -> tuple[Array, Array]:
        """Step in priors by reweighted least squares within the ranges, and the residual that the slopes predict."""
        room = (self.low - theta) / self.known.prior, (self.high - theta) / self.known.prior
        after, x, ones = self.residual, np.zeros(len(theta)), np.ones(len(theta))
        scale = family_scales(self.evidence, self.residual)
        for _ in range(REWEIGHTED):
            w = weights(self.evidence, after, scale)
            x = solve_within((self.slopes,), self.residual, w, ones, offset, *room)
            after = self.residual + self.slopes @ x
        return x, after


def _objective(evidence: Evidence, residual: Array, offset: Array) -> float:
    """The objective of a fit: the log likelihood with the scales of the residual itself, and that of the priors."""
    return log_likelihood(evidence, residual) - strain(offset)


def _loss(evidence: Evidence, residual: Array) -> float:
    """Robust loss of a residual in its own scales: about half the number of independent windows."""
    scale = family_scales(evidence, residual)
    return float(OVERLAP**2 * np.sum(huber(residual / scale[evidence.family])))


def base_fit(evidence: Evidence, whole: Model, model: Model, known: Known) -> BaseFit:
    """The starting point of hypotheses; `whole` is a model that holds `model` and every candidate."""
    r, J = slopes(evidence, model, known)
    held = whole.with_parameters({n: v for n, v in model.parameters.items() if n in whole.parameters})
    return BaseFit(model, held, known.names, known.prior, known.offset(model), evidence, r, J)


def at_best(base: BaseFit, here: Array, unit: Array | float = 1.0) -> tuple[Array, Array, float]:
    """Best shift of the base parameters given a candidate's residual, the residual after it, and its log likelihood.

    unit (residuals,): the noise in which they count, where the candidate amplifies it.
    """
    after, shift = here, np.zeros(len(base.names))
    for _ in range(4):
        weight = own_weights(base.evidence, after, unit)
        shift, _bread = solve((base.slopes,), here, weight, np.ones(len(base.names)), base.offset)
        after = here + base.slopes @ shift
    value = log_likelihood(base.evidence, after / unit) - strain(shift + base.offset)
    return shift, after, value


def unaided(base: BaseFit) -> Hypothesis:
    """The hypothesis that nothing is missing: base parameters alone, fitted by one linear step as beside candidates."""
    shift, after, value = at_best(base, base.residual)
    return Hypothesis("", (), np.empty(0), shift, after, value, relief=relief_of(base, shift))


def relief_of(base: BaseFit, shift: Array) -> float:
    """Log likelihood of the priors that the model's own parameters regain by a shift; freed laws do not count."""
    return strain(base.offset[base.own]) - strain((shift + base.offset)[base.own])
