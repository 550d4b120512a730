"""Candidates judged: their scores, their sizes, and what they remove on held-out runs."""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.coordinates import Coordinate, coordinates
from pneumo_ros.diagnose.freedom import LAW_SPREAD, flattened, loosened, points_of
from pneumo_ros.diagnose.hypothesis import BaseFit, Hypothesis
from pneumo_ros.diagnose.measures import acting, explained, gains
from pneumo_ros.diagnose.score import AS_MUCH, MARGIN, Best, Score, Scoring, log_prior, moved, occam, surprise
from pneumo_ros.plant import Model
from pneumo_ros.plant.effect import LATE

Array = NDArray[np.float64]

# Usual sizes: of the points of a profile, in equal steps of its logarithm from twice the texture of any machine to one.
SPREADS = (0.2, 0.45, 1.0)
NONE_WITHIN = 2.0  # deviations from zero: a smaller size may be zero


@dataclass(frozen=True)
class _Beside:
    """A hypothesis at its best: its evidence, the log prior of its parameters, and what its freedom costs."""

    best: Best
    prior: float
    cost: float

    @property
    def nats(self) -> float:
        """All recordings together, but for a constant."""
        return float(self.best.evidence.sum()) + self.prior - self.cost


def judged(
    base: BaseFit,
    held: BaseFit,
    hypotheses: Sequence[Hypothesis],
    residuals: Sequence[Array],
    nothing: Hypothesis,
    first: bool,
) -> list[Candidate]:
    """Refined hypotheses as candidates, with their held-out residuals, best score first; each effect in its best form.

    All are compared with `nothing`: base parameters at their best without any candidate, whose residuals `held` has.
    """
    scoring, fits, found = Scoring(base.evidence, held.evidence), (base, held), list[Candidate]()
    if not hypotheses:
        return found
    scoring.measure(base.everything, nothing.residual, held.residual)
    own = nothing.residual, held.residual, nothing.shift
    ways = [own, moved(own, fits, -nothing.shift)]  # one step, or as fitted
    alone = scoring.best(base.everything, fits, ways, threads=2)
    models = [base.everything.with_parameters(h.values) for h in hypotheses]
    for part in scoring.parts:
        part.amplify(models)
    with ThreadPoolExecutor(2) as pool:
        reached = list(pool.map(lambda m, h, r: _best(scoring, fits, m, h, r, alone), models, hypotheses, residuals))
    # Base parameters that suit the model better, and that only a candidate came upon, are no merit of the candidate.
    here = alone.fit[2]
    points = [points_of(base, h.coordinates) for h in hypotheses]
    ends = [np.where(of_profile, here, one.best.fit[2]) for of_profile, one in zip(points, reached, strict=True)]
    ways = [alone.fit, *(moved(alone.fit, fits, end - here) for end in ends)]
    alone = scoring.best(base.everything, fits, ways, threads=2)
    unaided = surprise(base, alone.fit[2])
    bare = scoring.in_noise_of([one.best for one in reached], base.everything, alone)
    for h, r, m, of_profile, beside, alone in zip(hypotheses, residuals, models, points, reached, bare, strict=True):
        gained = beside.best.evidence - alone.evidence
        lines = ~of_profile  # a texture that its points explain is nothing that was known
        plain = _plain(scoring, fits, h, alone)
        before, heldout = plain.fit[1], scoring.heldout(m, beside.best, base.everything, plain)
        strained = surprise(base, alone.fit[2] * lines)
        known = strained - surprise(base, beside.best.fit[2] * lines) - h.surprise
        prior, after = unaided + beside.prior, beside.best.fit[1]
        found.append(
            Candidate(
                hypothesis=h,
                held=r,
                gain=gains(held.evidence, held.residual, r),
                size=magnitude(h.coordinates, h.u),
                share=max(
                    explained(held.evidence, before, after, acting(before, after), textured=first),
                    known / max(strained, MARGIN),
                ),
                known=known,
                first=first,
                score=Score(float(gained.sum()) + prior - beside.cost - heldout, heldout),
                lag=lag(h, base.evidence.runs[0].sample_time),
                swing=swing(h, base.evidence.runs[0].sample_time),
            )
        )
    return best_forms(found)


def _best(
    scoring: Scoring, fits: tuple[BaseFit, BaseFit], model: Model, h: Hypothesis, held: Array, alone: Best
) -> _Beside:
    """`Scoring.best` of a hypothesis, from its own base parameters or from those that are best without it.

    `model` holds the hypothesis. Points of a profile that it adds are `loosened`, by the spread of the largest score.
    """
    points, found = points_of(fits[0], h.coordinates), list[_Beside]()
    for spread in _spreads(fits[0], h):
        free, here = (loosened(fits[0], h, spread), loosened(fits[1], h, spread)), h.shift.copy()
        here[points] *= LAW_SPREAD / spread
        own, end = (h.residual, held, here), alone.fit[2]
        starts = [np.where(points, here, end)]
        if points.any():  # and without the profile
            starts.append(np.where(points, LAW_SPREAD / spread * end - free[0].offset, end))
        best = scoring.best(model, free, [own, *(moved(own, free, start - here) for start in starts)])
        found.append(_Beside(best, log_prior(free[0], best.fit[2], h), occam(fits[0], h, spread)))
    chosen = max(found, key=lambda one: one.nats)
    return replace(chosen, cost=chosen.cost + float(np.log(len(found))))


def _spreads(base: BaseFit, h: Hypothesis) -> tuple[float, ...]:
    """The spreads of the sizes of a hypothesis to choose from, in usual sizes."""
    return SPREADS if points_of(base, h.coordinates).any() else (1.0,)


def _plain(scoring: Scoring, fits: tuple[BaseFit, BaseFit], h: Hypothesis, alone: Best) -> Best:
    """The best without a hypothesis, and without the texture that a profile which it adds would replace.

    Such a texture is no alternative to the profile: it is a small one, and predicts held-out recordings as well.
    """
    points = points_of(fits[0], h.coordinates)
    if not points.any():
        return alone
    flat = flattened(fits[0], h), flattened(fits[1], h)
    return scoring.best(fits[0].everything, flat, [moved(alone.fit, fits, np.where(points, -alone.fit[2], 0.0))])


def freedom(base: BaseFit, h: Hypothesis) -> float:
    """Nats that the freedom of a hypothesis costs beside its likelihood; of a profile, by the spread that suits it."""
    return min(occam(base, h, s) + 0.5 * (1.0 / s**2 - 1.0) * float(h.u @ h.u) for s in _spreads(base, h))


def best_forms(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Each effect in the form of the best score; best score first.

    Of forms that explain as much as each other, in the one of the fewest parameters: a spot, and no profile that has
    one.
    """
    found = dict[str, list[Candidate]]()
    for one in by_score(candidates):
        found.setdefault(one.name, []).append(one)
    alike = [[one for one in own if one.score.nats > own[0].score.nats - AS_MUCH] for own in found.values()]
    return by_score([min(own, key=lambda one: len(one.hypothesis.u)) for own in alike])


def by_score(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Best score first."""
    return sorted(candidates, key=lambda candidate: -candidate.score.nats)


def sizes(own: Sequence[Coordinate], at: Array) -> Array:
    """Sizes (own,) of an effect in usual sizes, 0 for shape parameters; at (own,): its coordinates.

    Damping above the usual one adds to the lag 2 zeta / omega, so it multiplies the size of a fading frequency.
    """
    values = [(c, float(u)) for c, u in zip(own, at, strict=True)]
    damping = max((c.value(u) / c.typical for c, u in values if c.role == "damping"), default=1.0)
    return np.array(
        [c.size(u) * (max(damping, 1.0) if c.fading_frequency else 1.0) if c.is_size else 0.0 for c, u in values]
    )


def magnitude(own: Sequence[Coordinate], at: Array) -> float:
    """Largest size of an effect in usual sizes; at (own,): its coordinates."""
    return float(np.max(np.abs(sizes(own, at)), initial=0.0))


def size_in(model: Model, name: str) -> float:
    """Largest size of an effect of the model, in usual sizes."""
    own = coordinates(model.library.find(name))
    return magnitude(own, np.array([c.u(model[c.name]) for c in own]))


def undetermined(model: Model, name: str, std: Mapping[str, float], within: float = NONE_WITHIN) -> bool:
    """Whether all sizes of an effect of the model may be zero: each is at most `within` deviations `std` from neutral.

    Sizes of infinite deviation, on which there are no data, or without one, as those of another form, say nothing.
    """
    fading = [c for c in coordinates(model.library.find(name)) if c.is_size and std.get(c.name, np.inf) < np.inf]
    return bool(fading) and all(abs(model[c.name] - (c.neutral or 0.0)) <= within * std[c.name] for c in fading)


def lag(h: Hypothesis, sample_time: float) -> float:
    """All delays of an effect together, in samples of `sample_time` [s]; infinite if it has none."""
    return _lag(h.coordinates, h.values, sample_time)


def lag_in(model: Model, name: str, sample_time: float) -> float:
    """The same of an effect of the model, with the values that it has there."""
    return _lag(coordinates(model.library.find(name)), model.parameters, sample_time)


def _lag(own: Sequence[Coordinate], values: Mapping[str, float], sample_time: float) -> float:
    delays = [values[c.name] for c in own if c.role in LATE]
    return sum(delays) / sample_time if delays else np.inf


def swing(h: Hypothesis, sample_time: float) -> float:
    """Half the shortest period of an effect's resonances, in samples of `sample_time` [s]; infinite if it has none."""
    fastest = max(
        (h.values[c.name] * (1.0 if c.unit == "Hz" else 0.5 / np.pi) for c in h.coordinates if c.tuned), default=0.0
    )
    return float(0.5 / (fastest * sample_time)) if fastest else np.inf
