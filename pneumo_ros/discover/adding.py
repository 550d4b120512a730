"""Effects added by name: what the model has and what is new, fitted to recordings together.

First along the measured signals, where candidates start from several shapes and sizes; then by multiple shooting over a
part of the recordings (`identify.refit`), which alone determines when the piston breaks away: a static friction off by
3 % costs next to nothing along the signals, and a hundred noise deviations in predictions over a second.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.compare import Comparison, compare
from pneumo_ros.discover.coordinates import coordinates, starts
from pneumo_ros.discover.fitter import Fitter
from pneumo_ros.discover.hypothesis import Hypothesis
from pneumo_ros.discover.ranking import refine
from pneumo_ros.errors import UsageError
from pneumo_ros.identify.breakaway import find_breakaways
from pneumo_ros.identify.refit import SEGMENT, Estimate, Refit, default_free, refit_segments
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.segments import cut_at, side_by_side
from pneumo_ros.plant import Model

Index = NDArray[np.int64]
Progress = Callable[[float, str], None]

HORIZON = 1.0  # s
SEGMENTS = 80  # of all runs together: more take longer and change little
BEFORE = 0.15  # s of a segment before its breakaway
ROUGHLY = 40  # enough for the model without the effects, whose fit is slow and is not kept


@dataclass(frozen=True)
class Adding:
    """What adding effects brought: refitted without and with them, and how both predict the runs judged by."""

    effects: tuple[str, ...]
    base: Model
    model: Model
    estimates: dict[str, Estimate]  # of all free parameters of `model`, by dotted name
    before: Comparison = field(repr=False)
    after: Comparison = field(repr=False)
    given: Comparison = field(repr=False)  # the model as it was given
    train: tuple[str, ...] = ()
    judged: tuple[str, ...] = ()

    @property
    def held_out(self) -> bool:
        """Whether the runs judged by took no part in the fit."""
        return not set(self.train) & set(self.judged)


def add(
    model: Model,
    effects: Sequence[str],
    train: Sequence[Run],
    held: Sequence[Run] = (),
    *,
    threads: int = 2,
    progress: Progress | None = None,
) -> Adding:
    """Add `effects` to `model`, refit all that may move to `train`, and predict `held`, or `train` where it is empty.

    Raises UsageError for no run, no effect, an unknown one, and one that the model has or that does not fit beside
    its others; DataError when a run does not fit the model.
    """
    check_addable(model, effects)
    if not train:
        raise UsageError("effects are fitted to recordings; give at least one")
    tell = progress or (lambda share, text: None)
    tell(0.0, "refitting what the model has")
    fading = [name for name in effects if coordinates(model.library.find(name))]
    fitter = Fitter(model, train, train[:1], candidates=fading)
    base = larger = fitter.refit(model)
    if len(fading) < len(effects):
        plain = [name for name in effects if name not in fading]
        fitter = Fitter(model.with_effects([*model.effects, *plain]), train, train[:1], candidates=fading)
        larger = fitter.refit(fitter.start)
    for k, name in enumerate(fading):
        tell(0.1 + 0.1 * k / len(fading), f"fitting {name}")
        larger = _with(fitter, larger, name)
    base = polish(fitter, base, train, ROUGHLY, threads=threads, progress=_part(tell, 0.2, 0.5, "without")).model
    found = polish(fitter, larger, train, threads=threads, progress=_part(tell, 0.5, 0.85, "with"))
    judged, compared = held or train, []
    for k, one in enumerate((model, base, found.model)):
        tell(0.85 + 0.05 * k, "predicting the recordings")
        compared.append(compare(one, judged, HORIZON))
    return Adding(
        tuple(effects), base, found.model, found.estimates, compared[1], compared[2], compared[0],
        tuple(run.name for run in train), tuple(run.name for run in judged),
    )  # fmt: skip


def check_addable(model: Model, effects: Sequence[str]) -> None:
    """UsageError for effects that cannot be added to `model`."""
    if not effects:
        raise UsageError("name an effect to add; see: pneumo effects")
    for name in effects:
        model.library.find(name)
        if name in model.effects:
            raise UsageError(f"{name} is in '{model.name}' already; pneumo compare --refit fits what a model has")
        if list(effects).count(name) > 1:
            raise UsageError(f"{name} is named twice")
    larger = model.with_effects([*model.effects, *effects])
    for name in effects:
        if not coordinates(model.library.find(name)) and any(n.startswith(f"{name}.") for n in default_free(larger)):
            raise UsageError(
                f"{name} cannot be fitted: none of its parameters says where it adds nothing, as "
                "Parameter(..., neutral=0.0) does; put it into the machine file instead"
            )


def polish(
    fitter: Fitter,
    model: Model,
    runs: Sequence[Run],
    most: int = SEGMENTS,
    *,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Multiple shooting from `model`, over at most `most` segments of all runs.

    What is free and what was known of it are those of `fitter`; estimates tell what changed against its start.
    """
    known = fitter.known(model)
    samples = max(round(SEGMENT / runs[0].sample_time), 2)
    segments = cut_at(model, runs, telling(model, runs, samples, most), samples)
    widths = dict(zip(known.names, known.prior.tolist(), strict=True))
    centre = dict(zip(known.names, known.centre.tolist(), strict=True))
    found = refit_segments(model, segments, known.names, widths, threads=threads, progress=progress)
    estimates = {n: replace(e, before=centre[n], prior=widths[n]) for n, e in found.estimates.items()}
    return replace(found, estimates=estimates)


def telling(model: Model, runs: Sequence[Run], samples: int, most: int) -> list[Index]:
    """Where segments of `samples` begin in each run: before breakaways, at most half of `most`; the others anywhere."""
    slips = [_before_slips(model, run, samples) for run in runs]
    some = _thinned(slips, most // 2)
    rest = _thinned([side_by_side(run, samples) for run in runs], most - sum(map(len, some)))
    return [np.sort(np.concatenate(pair)) for pair in zip(some, rest, strict=True)]


def _before_slips(model: Model, run: Run, samples: int) -> Index:
    """Grid points shortly before each breakaway from which on a segment is measured throughout."""
    slips = find_breakaways(model, run) if "z" in model.states else []
    early = round(BEFORE / run.sample_time)
    starts = [slip.index - early for slip in slips if 0 <= slip.index - early < len(run) - samples]
    return np.array([s for s in starts if run.measured[s : s + samples + 1].all()], dtype=np.int64)


def _thinned(each: Sequence[Index], most: int) -> list[Index]:
    """At most `most` of the grid points of all runs, spread evenly over them."""
    run = np.repeat(np.arange(len(each)), [len(one) for one in each])
    every = np.concatenate(each)
    kept = np.unique(np.linspace(0, len(every) - 1, min(most, len(every))).round().astype(np.int64))
    return [every[kept][run[kept] == i] for i in range(len(each))]


def _with(fitter: Fitter, model: Model, name: str) -> Model:
    """The model with one more effect, fitted along the signals from the best of several shapes."""
    fit = fitter.fit(model)
    own = coordinates(model.library.find(name))
    begin = [Hypothesis(name, own, u, np.zeros(len(fit.names)), fit.residual) for u in starts(own)]
    best = max(refine(fit, begin), key=lambda h: h.likelihood)
    return fitter.refit(fitter.extended(model, best))


def _part(tell: Progress, first: float, last: float, what: str) -> Progress:
    return lambda share, _: tell(first + (last - first) * share, f"refitting {what} what is added, by prediction")


def estimates_along(fitter: Fitter, model: Model) -> dict[str, Estimate]:
    """Estimates of what is free in a model that `fitter` fitted, against what was known before."""
    known = fitter.known(model)
    spread = fitter.deviations(model)
    each = zip(known.names, known.centre.tolist(), known.prior.tolist(), strict=True)
    return {n: _estimate(model[n], spread[n], centre, prior) for n, centre, prior in each}


def _estimate(value: float, spread: float, before: float, prior: float) -> Estimate:
    return Estimate(value, spread, value - 1.96 * spread, value + 1.96 * spread, before, prior)
