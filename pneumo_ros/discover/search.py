"""The search for what a model lacks: refit, rank, try, add, repeat; then take back what does not pay."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.basefit import base_fit, fit_base
from pneumo_ros.discover.coordinates import Coordinate, coordinates
from pneumo_ros.discover.evidence import Evidence
from pneumo_ros.discover.hypothesis import (
    BaseFit,
    Hypothesis,
    cluster_robust,
    everything,
    family_scales,
    huber,
    missing,
    weights,
)
from pneumo_ros.discover.ranking import SHORTLIST, held_out, refine, screen, unaided
from pneumo_ros.discover.slips import POOR, as_trial, blind, errors, polished, slips, try_candidates
from pneumo_ros.discover.trial import Trial, excess, put_on_trial, remaining, rivals, simplest
from pneumo_ros.identify.noise import run_noise
from pneumo_ros.identify.refit import default_free
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.windows import predict
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

SCREENED = 50.0  # s of recordings by which candidates are ranked first
PROMISING = 3.0  # log likelihood that a candidate has to gain in the first ranking
SHOWN = 2  # candidates that are tried in any case, so that the reasons against the next best can be read
FINALISTS = 4  # candidates that are fitted to all training runs
HORIZON, FARTHEST = 1.0, 1e6  # s, and noise deviations: no error counts as larger
EXPLAINED = 0.8  # share of what noise does not explain in an equation
BETTER, WORSE = 0.95, 1.1  # of a signal's prediction error
MOST = 4  # effects added
UNSEEN = ("lugre_friction.bristle_stiffness",)  # no equation residual shows it


@dataclass(frozen=True)
class Step:
    """One round: the model it began with, all trials best first, and what was added (None in the last round)."""

    model: Model
    trials: tuple[Trial, ...]
    added: Trial | None
    rivals: tuple[Trial, ...]
    before: dict[str, float]  # scale over noise by family on held-out runs
    after: dict[str, float]


@dataclass(frozen=True)
class Found:
    """The outcome: refitted base, final model, the rounds that led there."""

    base: Model
    model: Model
    steps: tuple[Step, ...]
    interrupted: bool = False


class Search:
    """Everything that stays the same during one search."""

    def __init__(
        self,
        model: Model,
        train: Sequence[Run],
        held: Sequence[Run],
        progress: Progress | None = None,
        candidates: Sequence[str] | None = None,
    ) -> None:
        """`candidates`: names of all that may be added; by default whatever the model lacks."""
        self.progress = progress or (lambda share, text: None)
        self.start = model
        self.first: dict[str, float] = {}  # what the refitted model leaves beyond noise, by equation
        found = missing(model) if candidates is None else own_coordinates(model, candidates)
        self.whole = everything(model, found)  # one kernel for all that may be added
        self._fitted: BaseFit | None = None
        self.train, self.held = Evidence(model, train), Evidence(model, held)

    def run(self) -> Found:
        """Add effects one after another while they pass every test."""
        self.progress(0.05, "refitting what the model has")
        base = self.polish(self.refit(self.start))
        model, steps = base, list[Step]()
        before, banned = windowed(base, self.held.runs), dict[str, str]()
        try:
            screened: list[Hypothesis] = []
            while len(steps) <= MOST + len(banned):
                k = len(model.effects) - len(base.effects)
                self.progress(0.1 + 0.15 * k, f"ranking what {'else ' if k else ''}may be missing")
                step, screened = self.round(model, banned)
                if step.added is None or k == MOST:
                    steps.append(replace(step, added=None))
                    break
                self.progress(0.2 + 0.15 * k, f"adding {step.added.name}")
                new = self.polish(self.refit(self.extended(model, step.added.hypothesis)))
                after = windowed(new, self.held.runs)
                if not self.beyond_doubt(step.added) and not pays(before, after):
                    banned[step.added.name] = "predictions of held-out runs over 1 s get no better with it"
                    continue
                steps.append(step)
                model, before = new, after
            self.progress(0.85, "looking at breakaways and reversals")
            longer, last = self.slip_round(model, screened)
            if last is not None and last.added is not None and pays(before, windowed(longer, self.held.runs)):
                steps[-1:] = [last, replace(steps[-1], model=longer)]
                model = longer
        except KeyboardInterrupt:
            steps = [step for step in steps if step.added is None or step.added.name in model.effects]
            return Found(base, model, tuple(steps), interrupted=True)
        return Found(base, model, tuple(steps))

    @staticmethod
    def beyond_doubt(trial: Trial) -> bool:
        """Whether an effect need not show in predictions: its equation is explained, or the data cannot tell at all.

        While something else is missing, predictions over a second may hang on that alone.
        """
        return trial.absorbed or trial.share >= EXPLAINED

    def extended(self, model: Model, h: Hypothesis) -> Model:
        """The model with the hypothesis' effect in it, base parameters where the hypothesis had them."""
        names, prior, _ = self.priors(model)
        moved = {}
        for n, shift, p in zip(names, h.shift, prior, strict=True):
            s = model.specification(n)
            moved[n] = min(max(model[n] + shift * p, s.low), s.high)
        moved |= {n: self.start[n] for n in UNSEEN if n in self.start.parameters}  # bent by what was missing
        return model.with_parameters(moved).with_effects([*model.effects, h.name], h.values)

    def priors(self, model: Model) -> tuple[tuple[str, ...], Array, dict[str, float]]:
        """Free parameters, their prior deviations and centres: the start's within 5 %, of added effects hardly any."""
        names, deviation, centre = [], [], {}
        for name in default_free(model):
            section, _, _key = name.partition(".")
            if name in UNSEEN:
                continue
            if section in self.start.effects:
                size = max(abs(self.start[name]), abs(self.start.specification(name).default))
                middle, width = self.start[name], 0.05 * size
            else:
                c = next(c for c in coordinates(model.library.find(section)) if c.name == name)
                middle, width = _prior(c, model[name])
            names.append(name)
            deviation.append(width)
            centre[name] = middle
        return tuple(names), np.array(deviation), centre

    def refit(self, model: Model) -> Model:
        """All free parameters fitted to the training evidence."""
        names, prior, centre = self.priors(model)
        return fit_base(self.train, model, names, centre, prior)

    def fits(self, model: Model) -> tuple[BaseFit, BaseFit]:
        """The model on training and held-out evidence."""
        names, prior, centre = self.priors(model)
        return self.fit(model), base_fit(self.held, self.whole, model, names, centre, prior)

    def fit(self, model: Model) -> BaseFit:
        """The model on training evidence; that of the last one asked for is kept."""
        if self._fitted is None or self._fitted.model is not model:
            names, prior, centre = self.priors(model)
            self._fitted = base_fit(self.train, self.whole, model, names, centre, prior)
        return self._fitted

    def polish(self, model: Model) -> Model:
        """Friction refitted to breakaways and reversals, which decide about predictions through them."""
        made = slips(model, self.train.runs, self.held.runs)
        if made is None:
            return model
        added = [name for name in model.effects if name not in self.start.effects]
        return with_values_of(model, polished(*made, self.deviations(model), added))

    def deviations(self, model: Model) -> dict[str, float]:
        """Cluster-robust standard deviation of every free parameter of `model`, infinite where the data say nothing."""
        names, prior, _centre = self.priors(model)
        base = self.fit(model)
        w = weights(self.train, base.residual, family_scales(self.train, base.residual))
        A = base.slopes * w[:, None]
        bread = np.linalg.inv(A.T @ A + np.eye(len(names)))
        cov = cluster_robust(A, w * base.residual, self.train.block, bread, np.ones(len(names)))
        std = np.sqrt(np.maximum(np.diag(cov), np.diag(bread))) * prior
        return {n: float(s) if s < 0.5 * p else float("inf") for n, s, p in zip(names, std, prior, strict=True)}

    def slip_round(self, model: Model, screened: Sequence[Hypothesis]) -> tuple[Model, Step | None]:
        """Friction refitted to breakaways and reversals, and an effect added that they alone show, if they miss one."""
        made = slips(model, self.train.runs, self.held.runs)
        if made is None:
            return model, None
        alone, found = made
        known = self.deviations(model)
        train, held = errors(alone, found.train(alone)), errors(alone, found.held(alone))
        if max(np.median(train), (usual := float(np.median(held)))) < POOR:
            return model, None
        tried = try_candidates(alone, found, blind(screened, alone), known)
        first = model.effects == self.start.effects
        trials = [as_trial(c, missing(alone)[c.name], train, held, first) for c in tried]
        good = [t for t in trials if not t.objections]
        best = good[0] if good else None
        step = Step(model, tuple(trials), best, (), {"slip": usual}, {"slip": usual})
        if best is not None:
            chosen = next(c for c in tried if c.name == best.name)
            model = with_values_of(model.with_effects([*model.effects, best.name]), chosen.model)
        return model, step

    def round(self, model: Model, banned: Mapping[str, str]) -> tuple[Step, list[Hypothesis]]:
        """Rank all candidates on the training runs, try the best on the held-out ones."""
        base, held = self.fits(model)
        part = self.worst(base)
        screened = screen(part)
        least, short = unaided(part).likelihood + PROMISING, list[Hypothesis]()
        for h in screened:
            promising = h.likelihood > least or len(short) < SHOWN
            if promising and h.name not in [s.name for s in short]:
                short.append(h)
        tried = sorted(refine(part, short[:SHORTLIST]), key=lambda h: -h.likelihood)
        tried = refine(base, tried[:FINALISTS], iterations=2, settled=True)
        nothing = unaided(base)
        without = held_out(base, held, [nothing])[0]
        trials = put_on_trial(
            base, replace(held, residual=without), tried, held_out(base, held, tried), nothing,
            model.effects == self.start.effects,
        )  # fmt: skip
        now = excess(self.held, without)
        self.first = self.first or now
        trials = [
            replace(trial, refused=banned.get(trial.name, ""), rest=remaining(trial, self.first, now))
            for trial in trials
        ]
        best = simplest(base, held, [trial for trial in trials if not trial.objections])
        others = rivals(base, held, best, trials) if best else []
        step = Step(
            model, tuple(trials), best, tuple(others), _scales(self.held, without),
            _scales(self.held, best.held if best else without),
        )  # fmt: skip
        return step, screened

    def worst(self, base: BaseFit) -> BaseFit:
        """The part of the training evidence where the model is worst: enough to rank by."""
        runs, left = [], SCREENED
        e = base.evidence
        misfit = [float(np.mean(huber(base.residual[e.run == i]))) for i in range(len(e.runs))]
        for i in np.argsort(misfit)[::-1]:
            if left > 0.0:
                runs.append(int(i))
                left -= float(e.runs[i].time[-1])
        part, rows = e.only(runs)
        return replace(base, evidence=part, residual=base.residual[rows], slopes=base.slopes[rows])


def windowed(model: Model, runs: Sequence[Run]) -> dict[str, float]:
    """By signal, the usual error over noise in windows of 1 s: the geometric mean; no single breakaway decides it."""
    logs: dict[str, list[Array]] = {}
    for run in runs:
        noise = run_noise(run)
        for name, error in predict(model, run, HORIZON).errors.items():
            size = np.sqrt(np.nanmean(np.minimum(np.abs(error / noise[name]), FARTHEST) ** 2, axis=1))
            logs.setdefault(name, []).append(np.log(np.maximum(size, 1e-3)))
    return {name: float(np.exp(np.mean(np.concatenate(parts)))) for name, parts in logs.items()}


def pays(before: Mapping[str, float], after: Mapping[str, float]) -> bool:
    """Whether predictions of some signal got better by a twentieth and none worse by a tenth."""
    return any(after[n] <= BETTER * before[n] for n in before) and all(after[n] <= WORSE * before[n] for n in before)


def own_coordinates(model: Model, names: Sequence[str]) -> dict[str, tuple[Coordinate, ...]]:
    """Coordinates of effects of the model's library, by name."""
    return {name: coordinates(model.library.find(name)) for name in names}


def with_values_of(model: Model, other: Model) -> Model:
    """The model with all parameters that `other` has at its values."""
    return model.with_parameters({n: v for n, v in other.parameters.items() if n in model.parameters})


def _prior(c: Coordinate, value: float) -> tuple[float, float]:
    if c.logarithmic:
        return value if c.is_size else c.typical, max(abs(value), 1e-12) * c.prior
    return (c.neutral or 0.0), abs(c.scale) * c.prior


def _scales(evidence: Evidence, residual: Array) -> dict[str, float]:
    return dict(zip(evidence.names, family_scales(evidence, residual).tolist(), strict=True))
