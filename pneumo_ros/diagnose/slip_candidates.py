"""Effects tried on breakaways and reversals: started at several sizes and shapes, fitted, judged by held-out events."""

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import Candidate, removes
from pneumo_ros.diagnose.coordinates import Coordinate, by_kind, coordinates
from pneumo_ros.diagnose.hypothesis import Hypothesis, missing
from pneumo_ros.diagnose.judging import magnitude
from pneumo_ros.diagnose.measures import NOISE_SHARE, together
from pneumo_ros.diagnose.score import TAIL, Score
from pneumo_ros.diagnose.slip_starts import Tangents, by_sizes
from pneumo_ros.diagnose.slips import FEW_PARAMETERS, POOR, Slips, errors, friction_priors, textured, with_values_of
from pneumo_ros.diagnose.steps import Step
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import moves
from pneumo_ros.shooting.refit import refit_segments
from pneumo_ros.shooting.segments import Segments

Array = NDArray[np.float64]

BLIND = 30.0  # t of the usual size of an effect on the equations: below it, they do not decide about the effect
SHARE_REMOVED = (
    0.7  # of the error beyond noise, which an effect must remove: slips alone decide, so they must be explained
)
MOST_FITTED = 3  # candidates that are fitted, those with the best starts
EXPLAINED = 0.9  # share of the error beyond the noise's
PART_EXPLAINED = 0.3  # share of the error beyond noise: a candidate that removes as much is fitted on, and restarted
RESIZED, WORTH_RESTART = (2.0, 0.5), 0.9  # times the size; most of the old error that may be left for another restart
RESIZINGS = 12  # restarts either way: a size that is wrong by more than a factor of 4000 is no start
# log likelihood: an effect's own state starts free in every event, so that it can follow any slow force
CONTRADICTED = 10.0
Against = Callable[[str, Mapping[str, float]], float]  # log likelihood lost by the equations, by effect and values
QUANTILES = (0.5, 0.75)  # of the events' errors: the first poor one is used


@dataclass(frozen=True)
class Slipping:
    """A candidate on the events: the mechanics with it, and its errors per training and held-out event.

    Its sizes of one kind were fitted, and its shapes: `std` names them.
    """

    name: str
    model: Model
    train: Array
    held: Array
    std: dict[str, float]  # of its parameters
    against: float = 0.0  # log likelihood that the equations along the motion lose by it, if the events need it
    some: bool = False  # whether it was fitted to some of the training events only


@dataclass(frozen=True)
class Misfit:
    """The errors (events,) of held-out events by a model, judged by their `q`-quantile.

    `least`: that quantile of what noise and forces that no model has leave, over the noise's.
    """

    events: Array
    q: float = 0.5
    least: float = 1.0

    @property
    def usual(self) -> float:
        """Their quantile."""
        return float(np.quantile(self.events, self.q))

    @property
    def poor(self) -> bool:
        """Whether something between stick and slip is missing."""
        return self.usual >= POOR * self.least

    def share(self, after: Array) -> float:
        """Reduction of the quantile to that of other errors, as a share of its excess over noise and texture."""
        second = float(np.quantile(after, self.q))
        return (self.usual - max(second, self.least)) / max(self.usual - self.least, NOISE_SHARE)


def misfits(alone: Model, segments: Segments, force: float) -> list[Misfit]:
    """By each of `QUANTILES`, where a force of deviation `force` [N] that no model has acts in every event."""
    own, rough = errors(alone, segments), textured(alone, segments, force)
    return [Misfit(own, q, 1.0 + float(np.quantile(rough, q))) for q in QUANTILES]


def longer(
    model: Model,
    made: tuple[Model, Slips],
    screened: Sequence[Hypothesis],
    known: dict[str, float],
    against: Against,
    first: bool,
    limits: list[str],
    force: float = 0.0,
) -> tuple[Model, Step | None]:
    """The model with the effect that its breakaways and reversals need, and the candidates; None if none is needed.

    `made`: its mechanics and the events; `known`: standard deviations of its parameters; `against`: log likelihood that
    the equations along the motion lose by an effect; `first`: nothing was added; `limits` takes a sentence for every
    loop that ended at its bound; `force` [N]: deviation of what no model explains while the piston slides.
    """
    alone, found = made
    parts = [misfits(alone, segments, force) for segments in (found.train(alone), found.held(alone))]
    poor = [both for both in zip(*parts, strict=True) if any(one.poor for one in both)]
    if not poor:
        return model, None
    train, held = poor[0]
    tried = SlipFits(alone, found, known, against, held, limits).tried(blind(screened, alone, found.inputs))
    effects = [coordinates(alone.library.find(c.name)) for c in tried]
    samples = found.train(alone).samples
    candidates = [
        as_candidate(c, own, train.events, held, samples, first) for c, own in zip(tried, effects, strict=True)
    ]
    good = [(c, t) for c, t in zip(tried, candidates, strict=True) if not t.objections]
    usual = held.usual
    step = Step(model, tuple(candidates), good[0][1] if good else None, (), {"slip": usual}, {"slip": usual})
    if good:
        chosen = good[0][0]
        model = with_values_of(model.with_effects([*model.effects, chosen.name]), chosen.model)
    return model, step


@dataclass(frozen=True)
class SlipFits:
    """Fits of effects added to `alone`, judged by the quantile of `held`, its errors on held-out events.

    `known`: standard deviations of the friction; `against`: log likelihood that the equations lose by an effect.
    """

    alone: Model
    found: Slips
    known: dict[str, float]
    against: Against
    held: Misfit
    limits: list[str] = field(default_factory=list)  # a sentence for every loop that ended at its bound

    def tried(self, names: Sequence[str]) -> list[Slipping]:
        """The named effects with the best starts, fitted to the training events; smallest errors first.

        Sizes of different kinds, which replace each other, are fitted one kind at a time, and the best is kept. The
        search stops at an effect that leaves hardly more than noise.
        """
        most_are_poor = self.held.q == QUANTILES[0]
        tangents = None if most_are_poor else Tangents.of(self.alone, self.found, self.known)
        begins = tangents.best if tangents else partial(by_sizes, self.alone, self.found)
        forms = [(name, own) for name in names for own in by_kind(coordinates(self.alone.library.find(name)))]
        with ThreadPoolExecutor(2) as pool:
            begun = list(pool.map(lambda form: begins(*form), forms))
        ranked = sorted(zip(forms, begun, strict=True), key=lambda one: one[1][0])
        result = list[Slipping]()
        for best in list(dict.fromkeys(name for (name, _), _ in ranked))[:MOST_FITTED]:
            fits = [self._fitted(name, model, own, some=True) for (name, own), (_, model) in ranked if name == best]
            result.append(min(fits, key=self._left))
            if self._explains(result[-1]):
                result[-1] = self._settled(result[-1])
            if self._explains(result[-1]):
                return sorted(result, key=self._left)
        for k, c in sorted(enumerate(result), key=lambda one: self._left(one[1])):
            result[k] = self._settled(self._resized(c))
            if self._explains(result[k]):
                break
        return sorted(result, key=self._left)

    def _settled(self, c: Slipping) -> Slipping:
        """Fitted to all events if it was to some, explains a part of the held-out ones, and nothing contradicts it."""
        explains = self.held.share(c.held) >= PART_EXPLAINED and c.against < CONTRADICTED
        if not c.some or not explains or not self._determined(c):
            return c
        return self._fitted(c.name, c.model, self._own(c))

    def _determined(self, c: Slipping) -> bool:
        """Whether it has a size at all; else friction alone explains as much, where its refit ended."""
        return any(determined(k, c.model[k.name], c.std) for k in self._own(c))

    def _own(self, c: Slipping) -> list[Coordinate]:
        return [one for one in coordinates(self.alone.library.find(c.name)) if one.name in c.std]

    def _fitted(self, name: str, begin: Model, own: Sequence[Coordinate], some: bool = False) -> Slipping:
        """Fitted from `begin` to all training events, or to `some`, with the parameters `own` of the effect free."""
        prior, effect = friction_priors(self.alone, self.known), coordinates(self.alone.library.find(name))
        prior |= {c.name: (3.0 if c.is_size else 1.0) * max(abs(c.scale), abs(begin[c.name])) for c in own}
        refit = refit_segments(begin, self.found.some(begin) if some else self.found.train(begin), list(prior), prior)
        fitted, std = refit.model, {c.name: refit.estimates[c.name].std for c in own}
        train, held = (errors(fitted, events(fitted)) for events in (self.found.train, self.found.held))
        asked_for = self.held.share(held) >= SHARE_REMOVED
        loss = self.against(name, {c.name: fitted[c.name] for c in effect}) if asked_for else 0.0
        return Slipping(name, fitted, train, held, std, loss, some)

    def _resized(self, c: Slipping) -> Slipping:
        """A candidate that explains part of the error, restarted from other sizes as long as it explains more.

        Refitted friction compensates too small a size, and a descent along both stops early; the equations along the
        motion contradict too large a size.
        """
        if self.held.share(c.held) < PART_EXPLAINED or not self._determined(c):
            return c
        ways = (self._followed(c, factor) for factor in RESIZED if factor < 1.0 or c.against < CONTRADICTED)
        return next((other for other in ways if other is not c), c)

    def _followed(self, c: Slipping, factor: float) -> Slipping:
        """The last improvement among fits that each start at `factor` times the previous size."""
        for _ in range(RESIZINGS):
            if self._explains(c):
                return c
            begin = c.model.with_parameters(resized(self._own(c), c.model, factor))
            new = self._fitted(c.name, begin, self._own(c), c.some)
            if not self._better(new, c):
                return c
            c = new
        self.limits.append(
            f"fits of {c.name} to breakaways still got better after its size was changed {RESIZINGS} times"
        )
        return c

    def _better(self, new: Slipping, old: Slipping) -> bool:
        """Whether another restart is worthwhile: `new` explains more, or the equations no longer contradict it."""
        if (new.against < CONTRADICTED) == (old.against < CONTRADICTED):
            return self._left(new) <= WORTH_RESTART * self._left(old)
        return new.against < CONTRADICTED and self.held.share(new.held) >= SHARE_REMOVED

    def _explains(self, c: Slipping) -> bool:
        return self.held.share(c.held) > EXPLAINED and c.against < CONTRADICTED

    def _left(self, c: Slipping) -> float:
        return float(np.quantile(c.train, self.held.q) + np.quantile(c.held, self.held.q))


def resized(effect: Sequence[Coordinate], model: Model, factor: float) -> dict[str, float]:
    """Sizes of an effect in `model`, `factor` times larger."""
    return {c.name: c.grown(model[c.name], factor) for c in effect if c.is_size}


def blind(screened: Sequence[Hypothesis], alone: Model, measured: Collection[str]) -> list[str]:
    """Effects of the mechanics that the equations along the motion determine poorly, or that have states of their own.

    Windows of the equations average over oscillations and lags shorter than a window. `measured`: inputs of the events.
    """
    builds, library = missing(alone, measured), alone.library
    seen: dict[str, float] = {}
    for h in screened:
        spread = np.sqrt(np.maximum(np.diag(h.covariance), 1e-300)) if len(h.covariance) else np.array([np.inf])
        seen[h.name] = max(seen.get(h.name, 0.0), float(np.min(1.0 / spread)))
    few = [n for n in seen if n in builds and moves(alone, n) and len(builds[n]) <= FEW_PARAMETERS]
    return [n for n in few if seen[n] < BLIND or library.find(n).states]


def deviations_better(before: Array, after: Array, samples: int) -> float:
    """Improvement of events of `samples` samples over its scatter; unchanged events do not count."""
    return together(0.5 * samples * (before - after))[1]


def determined(k: Coordinate, value: float, std: dict[str, float]) -> bool:
    """Whether it is a size that differs from neutral by more than twice its standard deviation."""
    return k.is_size and abs(value - (k.neutral or 0.0)) > 2.0 * std.get(k.name, np.inf)


def as_candidate(
    c: Slipping,
    effect: tuple[Coordinate, ...],
    base_train: Array,
    base_held: Misfit,
    samples: int,
    first: bool,
) -> Candidate:
    """The candidate in the form in which all candidates are judged, by errors without it and those of its model.

    `samples`: of an event. All events decide whether there is an effect, the held-out events whether it predicts.
    """
    u = np.array([k.u(c.model[k.name]) for k in effect])
    every = np.concatenate([base_train, base_held.events]), np.concatenate([c.train, c.held])
    h = Hypothesis(c.name, effect, u, np.empty(0), np.empty(0), t=deviations_better(*every, samples))
    gained = [paired(before, after, samples) for before, after in (every, (base_held.events, c.held))]
    gain = 1.0 - float(np.quantile(c.held, base_held.q)) / base_held.usual
    share = base_held.share(c.held)
    enough = (
        "" if share >= SHARE_REMOVED else f"{removes(share)} of the misfit beyond noise at breakaways and reversals"
    )
    if c.against > max(together(0.5 * samples * (base_train - c.train))[0], CONTRADICTED):
        enough = f"the equations along the motion contradict it (they lose {c.against:.3g} in log likelihood)"
    if not any(determined(k, c.model[k.name], c.std) for k in effect):
        enough = enough or "its size is not larger than its uncertainty"
    return Candidate(
        h, np.empty(0), {"slip": gain}, magnitude(effect, u), share, first,
        Score(gained[0] - gained[1] - _cost(effect, u, c.std), gained[1]), refused=enough, std=c.std,
    )  # fmt: skip


def paired(before: Array, after: Array, samples: int) -> float:
    """Nats by which errors of events (events,) of `samples` samples fall; negative where they rise.

    What no model has moves every breakaway a little: samples of one event are not independent, and a model with one
    more effect imitates some of it. So each event is one observation, the logarithm of the ratio of its errors, whose
    scatter is estimated; the evidence is that against a mean of zero. Beyond three deviations a fall counts as three.
    """
    fall = np.log(before / after)
    middle = float(np.median(fall))
    reach = TAIL * max(1.4826 * float(np.median(np.abs(fall - middle))), float(np.sqrt(2.0 / samples)))
    fall = np.clip(fall, middle - reach, middle + reach)
    mean, variance = float(np.mean(fall)), max(float(np.var(fall)), 1e-12)
    return float(np.copysign(0.5 * len(fall) * np.log1p(mean**2 / variance), mean))


def _cost(effect: Sequence[Coordinate], u: Array, std: Mapping[str, float]) -> float:
    """Nats that the coordinates of an effect cost, with priors of a usual size or a factor e each: see `score`."""
    spread = np.array([std.get(k.name, np.inf) for k in effect])
    near = np.array([_nearest(k, x, s) for k, x, s in zip(effect, u.tolist(), spread.tolist(), strict=True)])
    units = np.array([abs(k.value(x) if k.logarithmic else k.scale) for k, x in zip(effect, near, strict=True)])
    relative = spread / np.maximum(units, 1e-300)
    return 0.5 * float(near @ near) + 0.5 * float(np.sum(np.log1p(1.0 / relative**2)))


def _nearest(k: Coordinate, u: float, std: float) -> float:
    """The coordinate nearest to the usual one within a deviation of its value; a size is where it is.

    A fit ends anywhere in the range of a shape that the events do not determine, as at a damping of exactly zero.
    """
    if k.is_size or not k.logarithmic:
        return u
    value = k.value(u)
    return k.u(min(max(k.typical, value - std), value + std))
