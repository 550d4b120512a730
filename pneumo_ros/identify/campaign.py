"""Identification from a campaign of constant-voltage runs: the paper's procedure, with intervals and reasons.

1. stretches of constant velocity and pressures -> static map -> F_c, C_d (viscous coefficient, if asked)
2. breakaways from rest -> F_s; the motion that follows them -> v_s, and F_s once more
3. the same stretches' mass balance -> flow coefficients and dead zone
4. presliding -> bristle stiffness; Eqs. 15-16, corrected, for what it does not show
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.identify.breakaway import Breakaway, find_breakaways
from pneumo_ros.identify.flow import COEFFICIENTS, LIMITS, fit_flow
from pneumo_ros.identify.friction_map import MapFit, MapPoint, fit_map, map_points
from pneumo_ros.identify.presliding import STIFFNESS, fit_presliding
from pneumo_ros.identify.refit import Refit, refit_segments
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.segments import cut_at
from pneumo_ros.identify.steady import Window, find_windows
from pneumo_ros.plant import Model

Progress = Callable[[float, str], None]

STATIC, COULOMB = "lugre_friction.static_friction", "lugre_friction.coulomb_friction"
STRIBECK, DRAG = "lugre_friction.stribeck_velocity", "quadratic_drag.coefficient"
FRICTION = (STATIC, COULOMB, STRIBECK, DRAG)
_BEFORE, _AFTER = 0.7, 0.3  # s around a breakaway
_RAMP = 15.0  # N/s: under a slower ramp the moment of breakaway hangs on hundredths of a newton
_FEW = 4  # breakaways


@dataclass(frozen=True)
class Found:
    """One parameter: value, 95 % interval (None where not determined), unit, and a sentence on where it comes from."""

    value: float
    interval: tuple[float, float] | None
    unit: str
    before: float
    remark: str


@dataclass(frozen=True)
class Identification:
    """Result of a campaign: the model, every parameter looked for, and the evidence."""

    model: Model
    parameters: dict[str, Found]
    windows: tuple[Window, ...]
    points: tuple[MapPoint, ...]
    breakaways: tuple[Breakaway, ...]
    map_fit: MapFit


def identify(
    model: Model, runs: Sequence[Run], *, free: Sequence[str] = FRICTION, progress: Progress | None = None
) -> Identification:
    """Identify friction, and where there is a valve its flow coefficients, from constant-voltage runs.

    `free` are the friction parameters of the static map; add "viscous_friction.coefficient" (with that effect in the
    model) to fit it too. Raises DataError when the runs hold too few steady stretches.
    """
    tell = progress or (lambda share, text: None)
    tell(0.0, "looking for steady stretches")
    windows = tuple(w for run in runs for w in find_windows(model, run))
    breakaways = tuple(b for run in runs for b in find_breakaways(model, run))
    points = tuple(map_points(windows))
    _enough(windows, points)
    tell(0.2, f"{len(points)} steady points, {len(breakaways)} breakaways")
    wanted = tuple(name for name in free if name in model.parameters)
    fit = fit_map(model, points, breakaways, wanted)
    result = _Assembly(model, wanted, fit)
    if not model.force_driven:
        result.flow(windows)
    result.presliding(runs, breakaways)
    tell(0.4, "fitting the motion after breakaways")
    result.motion(runs, breakaways, lambda share, text: tell(0.4 + 0.6 * share, text))
    return Identification(result.model, result.found, windows, points, breakaways, fit)


def _enough(windows: Sequence[Window], points: Sequence[MapPoint]) -> None:
    if points:
        return
    reasons = [w.refused.partition(" (")[0] for w in windows]
    common = max(set(reasons), key=reasons.count) if reasons else "no interval of constant voltage is long enough"
    raise DataError(
        f"none of {len(windows)} windows is a stretch of constant velocity; most often: {common}. "
        "Record constant-voltage runs of several seconds: pneumo experiment constant-voltage"
    )


class _Assembly:
    """Collects values, intervals and remarks step by step."""

    def __init__(self, model: Model, wanted: Sequence[str], fit: MapFit) -> None:
        self.start, self.found = model, dict[str, Found]()
        self.model = model.with_parameters(fit.values)
        for name in wanted:
            remark = f"not determined: {fit.undetermined[name]}" if name in fit.undetermined else "static map"
            if name == STATIC and name in fit.intervals:
                remark = "force at breakaway"
            self.note(name, fit.values.get(name, model[name]), fit.intervals.get(name), remark)

    def note(self, name: str, value: float, interval: tuple[float, float] | None, remark: str) -> None:
        """Take over one value."""
        self.model = self.model.with_parameters({name: value})
        self.found[name] = Found(value, interval, self.model.specification(name).unit, self.start[name], remark)

    def flow(self, windows: Sequence[Window]) -> None:
        """Valve parameters from the mass balance of steady stretches."""
        fit = fit_flow(self.model, windows)
        for name in (*COEFFICIENTS, *LIMITS):
            if name in fit.values:
                self.note(name, fit.values[name], fit.intervals[name], "steady flow, q = p A v / (R T)")
            elif name in fit.undetermined:
                self.note(name, self.start[name], None, f"not determined: {fit.undetermined[name]}")

    def presliding(self, runs: Sequence[Run], breakaways: Sequence[Breakaway]) -> None:
        """Bristle stiffness and damping."""
        fit = fit_presliding(self.model, runs, breakaways)
        for name, value in fit.values.items():
            self.note(name, value, fit.intervals.get(name), fit.remarks[name])

    def motion(self, runs: Sequence[Run], breakaways: Sequence[Breakaway], progress: Progress) -> None:
        """Static friction and Stribeck velocity from the motion after breakaways under a rising force."""
        free = [name for name in (STATIC, STRIBECK) if name in self.found]
        starts = [_starts(run, breakaways) for run in runs]
        if not free or sum(len(s) for s in starts) < _FEW:
            return
        nuisance = [n for n in (*COEFFICIENTS, *LIMITS, STIFFNESS) if n in self.model.parameters]
        samples = round((_BEFORE + _AFTER) / runs[0].sample_time)
        segments = cut_at(self.model, runs, starts, samples)
        wide = {name: 0.5 * abs(self.model[name]) for name in free} | {n: 0.01 * abs(self.model[n]) for n in nuisance}
        interval = self.found[STATIC].interval if STATIC in self.found else None
        if interval:
            wide[STATIC] = max(interval[1] - interval[0], 0.2)
        fit = refit_segments(self.model, segments, [*free, *nuisance], wide, progress=progress)
        self._take(free, fit, len(segments))

    def _take(self, free: Sequence[str], fit: Refit, count: int) -> None:
        for name in free:
            estimate = fit.estimates[name]
            if np.isfinite(estimate.std) and estimate.std < 0.15 * abs(estimate.value) and estimate.determined:
                self.note(name, estimate.value, (estimate.low, estimate.high), f"motion after {count} breakaways")


def _starts(run: Run, breakaways: Sequence[Breakaway]) -> NDArray[np.int64]:
    before, after = round(_BEFORE / run.sample_time), round(_AFTER / run.sample_time)
    rows = [
        max(b.index - before, 0)
        for b in breakaways
        if b.run == run.name and abs(b.ramp) > _RAMP and max(b.index, before) + after < len(run)
    ]
    return np.array(rows, dtype=np.int64)
