"""A model and its candidates, fitted to the evidence of recordings within the priors of their parameters."""

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.binned import clusters
from pneumo_ros.diagnose.basefit import ITERATIONS, SMALL_SHARE, Fitted, Known, base_fit, fit_base, strain
from pneumo_ros.diagnose.coordinates import Coordinate, coordinates, forms, kinds, profile
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.freedom import conditions, freed, relative, shaping, uneven, unevenness
from pneumo_ros.diagnose.hypothesis import (
    BaseFit,
    Hypothesis,
    everything,
    jackknife,
    log_likelihood,
    missing,
    own_weights,
    spread,
)
from pneumo_ros.diagnose.prediction import typical_error, windowed
from pneumo_ros.diagnose.score import AS_MUCH, Scoring, surprise
from pneumo_ros.diagnose.stretches import stretches
from pneumo_ros.plant import Model
from pneumo_ros.plant.library import FRAME
from pneumo_ros.runs.inputs import measured_inputs, predicts_force
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.physical import physical
from pneumo_ros.shooting.refit import default_free
from pneumo_ros.shooting.windows import HORIZON

Array = NDArray[np.float64]

BASE_PRIOR, USUAL = 0.03, 0.05  # of a base parameter: deviation of a uniform prior within 5 %, and its usual change
PROBE_SHARE = 5e-6  # of a usual change of a base parameter, or size of an effect: a step for slopes; 5e-7 serves, too
SCREENED, SAMPLES = 50.0, 50_000  # s of recordings by which candidates are ranked first, and samples, if that is longer
UNSEEN = ("lugre_friction.bristle_stiffness",)  # no equation residual shows it


class Fitter:
    """The evidence of training and held-out runs, and fits of `start` and of models with more effects."""

    def __init__(
        self, start: Model, train: Sequence[Run], held: Sequence[Run] = (), candidates: Sequence[str] | None = None
    ) -> None:
        """`candidates`: names of the effects that may be added; by default all that the model lacks."""
        self.start, self._held_runs = start, held
        runs = [*train, *held]
        self.lacking = found = (
            missing(start, measured_inputs(runs), predicts_force(runs))
            if candidates is None
            else _coordinates(start, candidates)
        )
        self.whole = everything(start, found | shaping(start, list(found)))  # one kernel for all that may be added
        self._profiles: dict[Evidence, dict[str, Array]] = {}  # slopes of profiles, by the evidence they belong to
        self.train = Evidence(start, train)
        self.limits: list[str] = []  # a sentence for every loop that ended at its bound
        self.fit = lru_cache(2)(self._fit)  # the last two fits are kept
        self._at_best = lru_cache(1)(lambda model: self.likelihood(self.refit(model)))

    @cached_property
    def held(self) -> Evidence:
        """The evidence of the held-out runs, made only when it is needed."""
        return Evidence(self.start, self._held_runs)

    def known(self, model: Model, fixed: Collection[str] = (), presliding: bool = False) -> Known:
        """Priors of the free parameters of `model` except `fixed`: narrow for the start's, wide for added effects'.

        For the start's, as wide as its machine file states, if it does. `presliding`: also of what no equation shows.
        """
        names, centre, prior, step = [], [], [], []
        for name in default_free(model):
            section, _, _key = name.partition(".")
            if (name in UNSEEN and not presliding) or name in fixed:
                continue
            if section in (*FRAME, *self.start.effects):
                size = max(abs(self.start[name]), abs(self.start.specification(name).default))
                size = size or self.start.usual_size(name)
                width = self.start.uncertainty.get(name, BASE_PRIOR * size)
                middle, usual = self.start[name], USUAL * size
            else:
                c = next(c for c in coordinates(model.library.find(section)) if c.name == name)
                middle, usual = _usual(c, model[name])
                width = usual * (1.0 if model.library.find(section).part else c.prior)  # a valve's curve is no fault
            names.append(name)
            centre.append(middle)
            prior.append(width)
            step.append(PROBE_SHARE * usual)
        return Known(tuple(names), np.array(centre), np.array(prior), np.array(step))

    def refit(
        self, model: Model, iterations: int = ITERATIONS, fixed: Collection[str] = (), share: float = SMALL_SHARE
    ) -> Model:
        """The model, all free parameters except `fixed` fitted to the training evidence; `share` as in `fit_base`."""
        return self.noted(fit_base(self.train, model, self.known(model, fixed), iterations, share))

    def noted(self, fitted: Fitted) -> Model:
        """The fitted model; where the fit ended at its bound, `limits` says so."""
        if not fitted.settled:
            self.limits.append(f"a fit of '{', '.join(fitted.model.effects)}' did not settle in {fitted.taken} rounds")
        return fitted.model

    def simplest(self, model: Model, name: str, horizon: float = HORIZON) -> Model:
        """The model, or the model refitted with sizes of one kind alone of its effect `name`, if that explains as much.

        Only for sizes of different kinds, as a Stribeck curve's exponent and its tail: they replace each other over
        wide ranges, and a fit of both may end in a valley far from the true values. Of kinds that explain as much as
        each other the one is taken that predicts the training recordings best, in windows of `horizon` [s]: equations
        average over what sets in fast, and predictions show it. Forms of an effect were fitted each alone.
        """
        own = coordinates(model.library.find(name))
        if len(kinds(own)) == 1 or profile(own) or len(forms(own)) > 1:
            return model
        alone = [self._alone(model, own, kind) for kind in kinds(own)]
        gains = [self.gain(form, model) for form in alone]
        least = max(0.0, *gains) - AS_MUCH
        alike = [form for form, gain in zip(alone, gains, strict=True) if gain > least]
        if len(alike) < 2:
            return alike[0] if alike else model
        return min(alike, key=lambda form: typical_error(windowed(form, self.train.runs, horizon)))

    def _alone(self, model: Model, effect: Sequence[Coordinate], kind: Sequence[Coordinate]) -> Model:
        """The model refitted with the sizes of an effect that are not of one kind neutral; those at their usual size.

        A size that is not neutral already starts at its value.
        """
        others = {c.name: c.neutral for c in effect if c.neutral is not None and c not in kind}
        if all(model[n] == value for n, value in others.items()):
            return model
        off = all(model[c.name] == c.neutral for c in kind)
        begin = others | ({c.name: c.typical for c in kind} if off else {})
        return self.refit(model.with_parameters(begin), fixed=tuple(others))

    def against(self, model: Model, name: str, values: Mapping[str, float]) -> float:
        """Log likelihood that the training evidence loses when an effect of these `values` is added to `model`.

        All other parameters are refitted, with the effect and without.
        """
        larger = self.refit(model.with_effects([*model.effects, name], values), fixed=values)
        return self._at_best(model) - self.likelihood(larger, values)

    def gain(self, new: Model, old: Model) -> float:
        """Log evidence of all recordings and of the priors of the parameters that one model gains over another."""
        parts = (self.train, self.held) if self._held_runs else (self.train, self.train)
        without, residuals = ([part.residual(model) for part in parts] for model in (old, new))
        scoring = Scoring(*parts)
        scoring.measure(old, *without)
        after, before = scoring.at(new, *residuals), scoring.at(old, *without)
        gained = after.evidence - scoring.in_noise_of([after], old, before)[0].evidence
        strained = strain(self.known(new).offset(new)) - strain(self.known(old).offset(old))
        return float(gained.sum() if self._held_runs else gained[0]) - strained

    def evidences(self, model: Model, hypotheses: Sequence[Hypothesis]) -> list[float]:
        """Log evidence and log prior under `model` refitted with each hypothesis, but for a constant.

        Slopes at the model without them leave out that friction which grew by a tenth is worth a tenth more where an
        effect multiplies it, which is worth dozens of nats. Each is refitted from the model's own parameters beside the
        best one, too: alone it may end where all breakaways are written off.
        """
        scoring = Scoring(self.train, self.held)

        def reached(start: Model) -> tuple[float, Model]:
            new = self.refit(start)
            train, held = self.fits(new, self.added(model))
            if not scoring.usual:
                scoring.measure(new, train.residual, held.residual)
            best = scoring.best(new, (train, held), [(train.residual, held.residual, np.zeros(len(train.names)))])
            return float(best.evidence.sum()) - surprise(train, best.fit[2]), new

        found = [reached(self.extended(model, h)) for h in hypotheses]
        best = max(found, key=lambda one: one[0])[1]
        own = {n: best[n] for n in self.known(model).names}
        again = [one if one[1] is best else reached(one[1].with_parameters(own)) for one in found]
        return [max(one[0], other[0]) for one, other in zip(found, again, strict=True)]

    def likelihood(self, model: Model, fixed: Collection[str] = ()) -> float:
        """Log likelihood of the training evidence and of the priors of the parameters except `fixed`.

        Residuals count in units of the noise that the model itself amplifies.
        """
        residual = self.train.residual(model) * self.train.noise / self.train.noise_of(model)
        return log_likelihood(self.train, residual) - strain(self.known(model, fixed).offset(model))

    def shaped(self, model: Model) -> Model:
        """The model, fitted with the parts that shape the laws of its added effects, as a valve's curve.

        Each is free by a usual size. They are fitted, as slopes at the catalogue's curve do not reach another one.
        """
        parts = shaping(model, self.added(model))
        values = {c.name: c.neutral for part in parts.values() for c in part if c.neutral is not None}
        return self.refit(model.with_effects([*model.effects, *parts], values)) if parts else model

    def fits(self, model: Model, bent: Sequence[str] | None = None) -> tuple[BaseFit, BaseFit]:
        """The model on training and held-out evidence; the laws of `bent` (default: all added) are free in shape."""
        train, held = self.fit(model), base_fit(self.held, self.whole, model, self.known(model))
        names, (usual, others) = self.added(model) if bent is None else bent, self.conditions
        train, held = self._uneven(train), self._uneven(held)
        return freed(train, names, usual), freed(held, names, others)

    def ranking_fit(self, model: Model) -> BaseFit:
        """The model on the part of the training evidence for the first ranking; laws as free in shape as in `fits`."""
        if self.part is self.train:
            return self.fits(model)[0]
        inputs = self.whole.inputs
        seen = relative(conditions(self.part, inputs), conditions(self.train, inputs))
        fit = self._uneven(base_fit(self.part, self.whole, model, self.known(model)))
        return freed(fit, self.added(model), seen)

    def _uneven(self, fit: BaseFit) -> BaseFit:
        """The fit with each profile free that its model lacks; their slopes hardly change and are made once."""
        if fit.evidence not in self._profiles:
            self._profiles[fit.evidence] = unevenness(fit.evidence, self.whole, self.lacking)
        return uneven(fit, self._profiles[fit.evidence])

    @cached_property
    def part(self) -> Evidence:
        """The evidence for the first ranking of candidates: a share of every run, or all runs where they are short."""
        some = stretches(self.train.runs, max(SCREENED, SAMPLES * self.train.runs[0].sample_time))
        return Evidence(self.start, some) if some else self.train

    def added(self, model: Model) -> list[str]:
        """Effects of `model` that the start lacks, without the parts that shape their laws."""
        return [name for name in model.effects if name not in self.start.effects and not model.library.find(name).part]

    def as_given(self, model: Model) -> Model:
        """The model with the values of the start; the effects that it lacks have their neutral sizes."""
        own = [c for name in self.added(model) for c in coordinates(model.library.find(name))]
        neutral = {c.name: c.neutral for c in own if c.neutral is not None}
        return model.with_parameters(neutral | {n: self.start[n] for n in self.start.parameters})

    @cached_property
    def conditions(self) -> tuple[Array, Array]:
        """Conditions of the training and held-out residuals, relative to the mean and scatter of the training ones."""
        here = conditions(self.train, self.whole.inputs)
        return relative(here, here), relative(conditions(self.held, self.whole.inputs), here)

    def _fit(self, model: Model) -> BaseFit:
        """The model on training evidence."""
        return base_fit(self.train, self.whole, model, self.known(model))

    def deviations(self, model: Model, lengths: Sequence[float] = ()) -> dict[str, float]:
        """Cluster-robust standard deviation of every free parameter of `model`, infinite where not determined.

        At least those of errors that are correlated within blocks of further `lengths` [s]. A parameter at the end of
        its range counts as known for the deviations of the others.
        """
        base = self.fit(model)
        w = own_weights(self.train, base.residual)
        A, e = base.slopes * w[:, None], w * base.residual
        ends = [model[n] in (model.specification(n).low, model.specification(n).high) for n in base.names]
        held = np.array(ends, dtype=bool)
        std = spread(A, e, self.train.block)
        std[~held] = spread(A[:, ~held], e, self.train.block)
        for length in lengths:
            longer = clusters(self.train.time, self.train.run, length)
            std[~held] = np.maximum(std[~held], jackknife(A[:, ~held], e, longer))
        named = zip(base.names, std * base.prior, base.prior, strict=True)
        return {n: float(s) if s < 0.5 * p else float("inf") for n, s, p in named}

    def extended(self, model: Model, h: Hypothesis) -> Model:
        """The model with the hypothesis' effect and the hypothesis' base parameters."""
        known, moved = self.known(model), {}
        for n, shift, p in zip(known.names, h.shift[: len(known.names)], known.prior, strict=True):
            s = model.specification(n)
            moved[n] = min(max(model[n] + shift * p, s.low), s.high)
        kept = physical(model, tuple(moved), np.array(list(moved.values())))  # a chamber keeps some volume at its end
        moved = dict(zip(moved, kept.tolist(), strict=True))
        moved |= {n: self.start[n] for n in UNSEEN if n in self.start.parameters}  # biased while the effect was missing
        values = {c.name: c.neutral for c in coordinates(model.library.find(h.name)) if c.neutral is not None}
        return model.with_parameters(moved).with_effects([*model.effects, h.name], values | h.values)


def _coordinates(model: Model, names: Sequence[str]) -> dict[str, tuple[Coordinate, ...]]:
    """Coordinates of effects of the model's library, by name."""
    return {name: coordinates(model.library.find(name)) for name in names}


def _usual(c: Coordinate, value: float) -> tuple[float, float]:
    """Centre, and value per unit of the coordinate."""
    if c.logarithmic:
        return value if c.is_size else c.typical, max(abs(value), 1e-12)
    return (c.neutral or 0.0), abs(c.scale)
