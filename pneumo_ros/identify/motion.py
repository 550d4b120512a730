"""Static friction and Stribeck velocity, which steady motion shows poorly, from the motion after breakaways."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.identify.flow import LIMITS, coefficients
from pneumo_ros.identify.friction_map import LOOSE
from pneumo_ros.identify.presliding import STIFFNESS
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import Estimate, refit_segments, to_fit
from pneumo_ros.shooting.segments import cut_at

Array = NDArray[np.float64]
Index = NDArray[np.int64]

BEFORE_BREAKAWAY, AFTER_BREAKAWAY = 0.7, 0.3  # s around a breakaway
RAMP = 15.0  # N/s: under a slower ramp the moment of breakaway depends on hundredths of a newton
FEWEST_BREAKAWAYS, MOST_BREAKAWAYS = 4, 20  # breakaways: fewer are not enough, more add no information
_SURE, _KNOWN = 0.01, 0.05  # relative prior deviations of valve parameters, identified or as given


@dataclass(frozen=True)
class MotionFit:
    """Estimates from the motion after breakaways by dotted name, their correlation, and the number of breakaways."""

    estimates: dict[str, Estimate]
    correlation: Array  # (names, names)
    names: tuple[str, ...]
    breakaways: int


def fit_motion(
    model: Model,
    runs: Sequence[Run],
    breakaways: Sequence[Breakaway],
    free: Mapping[str, float],
    sure: Sequence[str],
    progress: Callable[[float, str], None],
) -> MotionFit | None:
    """Refit the friction parameters `free` (prior deviation by dotted name) to a second around each breakaway.

    Valve and bristle parameters are free too, with a prior of 1 % where they are `sure`, else 5 %. None when there are
    fewer than four breakaways under a fast enough force, or no free parameter.
    """
    chosen = _one_rate(runs, breakaways)
    starts = _thinned([_starts(run, breakaways) for run in chosen])
    count = sum(len(s) for s in starts)
    if not free or count < FEWEST_BREAKAWAYS:
        return None
    beside = [name for name in to_fit(model, (*coefficients(model), *LIMITS, STIFFNESS)) if name not in free]
    wide = {name: (_SURE if name in sure else _KNOWN) * abs(model[name]) for name in beside} | dict(free)
    segments = cut_at(model, chosen, starts, round((BEFORE_BREAKAWAY + AFTER_BREAKAWAY) / chosen[0].sample_time))
    fit = refit_segments(model, segments, [*free, *beside], wide, progress=progress)
    good = {name: fit.estimates[name] for name in free if _good(fit.estimates[name])}
    return MotionFit(good, fit.correlation, (*free, *beside), count)


def _good(estimate: Estimate) -> bool:
    return estimate.determined and bool(estimate.high - estimate.low < 2.0 * LOOSE * abs(estimate.value))


def _starts(run: Run, breakaways: Sequence[Breakaway]) -> Index:
    before, after = round(BEFORE_BREAKAWAY / run.sample_time), round(AFTER_BREAKAWAY / run.sample_time)
    rows = [
        max(b.index - before, 0)
        for b in breakaways
        if b.run == run.name and abs(b.ramp) > RAMP and max(b.index, before) + after < len(run)
    ]
    return np.array(rows, dtype=np.int64)


def _one_rate(runs: Sequence[Run], breakaways: Sequence[Breakaway]) -> list[Run]:
    """The runs of the sample time with most breakaways, as segments simulated together need one sample time."""
    alike: list[list[Run]] = []
    for run in runs:
        group = next((g for g in alike if abs(run.sample_time / g[0].sample_time - 1.0) < 1e-3), None)
        if group is None:
            alike.append(group := [])
        group.append(run)
    return max(alike, key=lambda group: sum(len(_starts(run, breakaways)) for run in group))


def _thinned(starts: Sequence[Index]) -> list[Index]:
    """At most `MOST_BREAKAWAYS` of all starts, spread evenly."""
    total = sum(len(s) for s in starts)
    kept = np.unique(np.linspace(0, total - 1, min(total, MOST_BREAKAWAYS)).round().astype(int))
    bounds = np.cumsum([0, *(len(s) for s in starts)])
    return [s[kept[(kept >= a) & (kept < a + len(s))] - a] for s, a in zip(starts, bounds[:-1], strict=True)]
