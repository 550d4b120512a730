"""A model fitted to predict: by multiple shooting over segments that begin before breakaways, and some others.

A static friction 3 % off costs next to nothing along the signals; in predictions over a second it makes a breakaway
late, which costs a hundred noise deviations.

A machine in its position loop is fitted to whole recordings: the loop corrects what is predicted wrongly, so that
errors stay bounded however long a segment is, and the free start of each short segment would take in what parameters
explain. Whole recordings also show the bristles' stiffness. Their valleys lie close, and most are far from the best, so
a fit to segments of 1 s comes first: there is less for an error to add up over, and few valleys.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.equations.breakaway import find_breakaways
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import LOOP_SEGMENT, SEGMENT, Refit, refit_segments
from pneumo_ros.shooting.segments import cut_at, side_by_side

Index = NDArray[np.int64]
Progress = Callable[[float, str], None]

SEGMENTS = 80  # of all runs together: more take longer and change little
LOOP = 10.0  # s, the longest segment of a machine in its position loop
LEAD = 0.15  # s of a segment before its breakaway


def polish(
    fitter: Fitter,
    model: Model,
    runs: Sequence[Run],
    most: int = SEGMENTS,
    *,
    sure: Mapping[str, float] | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Multiple shooting from `model`, over at most `most` segments of all runs.

    Free parameters and their priors are those of `fitter`; estimates are changes against its start. `sure`: standard
    deviations of parameters of `model`, which narrow their priors where they are smaller.
    """
    known, held = fitter.known(model, presliding=model.self_driven), sure or {}
    widths = dict(zip(known.names, known.prior.tolist(), strict=True))
    centre = dict(zip(known.names, known.centre.tolist(), strict=True))
    holding = {name: min(held.get(name, np.inf), width) for name, width in widths.items()}

    def fit(begin: Model, samples: int, most: int = most) -> Refit:
        segments = cut_at(begin, runs, telling(begin, runs, samples, most), samples)
        return refit_segments(begin, segments, known.names, holding, threads=threads, progress=progress)

    if model.self_driven:
        first, whole = longest(runs, LOOP_SEGMENT), longest(runs)
        found = fit(fit(model, first, SEGMENTS).model if first < whole else model, whole)
    else:
        found = fit(model, max(round(SEGMENT / runs[0].sample_time), 2))
    estimates = {n: replace(e, before=centre[n], prior=widths[n]) for n, e in found.estimates.items()}
    return replace(found, estimates=estimates)


def longest(runs: Sequence[Run], most: float = LOOP) -> int:
    """The most samples of a segment that every run holds between its gaps; of at most `most` [s], or the usual."""
    step = runs[0].sample_time
    samples = min(round(most / step), *(len(run) - 1 for run in runs))
    while samples * step > 2.0 * SEGMENT and not all(len(side_by_side(run, samples)) for run in runs):
        samples //= 2
    return max(samples, 2)


def telling(model: Model, runs: Sequence[Run], samples: int, most: int) -> list[Index]:
    """Starts of segments of `samples` in each run: before breakaways, at most half of `most`; the others anywhere."""
    slips = [_before_slips(model, run, samples) for run in runs]
    some = _thinned(slips, most // 2)
    rest = _thinned([side_by_side(run, samples) for run in runs], most - sum(map(len, some)))
    return [np.sort(np.concatenate(pair)) for pair in zip(some, rest, strict=True)]


def _before_slips(model: Model, run: Run, samples: int) -> Index:
    """Grid points shortly before each breakaway whose following segment is measured throughout."""
    slips = find_breakaways(model, run) if "z" in model.states else []
    early = round(LEAD / run.sample_time)
    starts = [slip.index - early for slip in slips if 0 <= slip.index - early < len(run) - samples]
    return np.array([s for s in starts if run.measured[s : s + samples + 1].all()], dtype=np.int64)


def _thinned(each: Sequence[Index], most: int) -> list[Index]:
    """At most `most` of the grid points of all runs, spread evenly over them."""
    run = np.repeat(np.arange(len(each)), [len(one) for one in each])
    every = np.concatenate(each)
    kept = np.unique(np.linspace(0, len(every) - 1, min(most, len(every))).round().astype(np.int64))
    return [every[kept][run[kept] == i] for i in range(len(each))]
