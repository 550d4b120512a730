"""An identification as plain data: the JSON of `pneumo identify`, the source of text, report and node."""

from collections import Counter
from collections.abc import Sequence
from itertools import groupby
from math import nan
from typing import Any

import numpy as np

from pneumo_ros.identify.campaign import Identification
from pneumo_ros.identify.static_map import sliding_friction
from pneumo_ros.identify.steady import WINDOW, Window
from pneumo_ros.runs.run import Run

STRONG = 0.9  # correlation above which two parameters are reported as determined only together
MISFIT = 3.0  # residuals over noise above which noise does not explain them
REPEATS = 0.01  # of the median force: repeatability of a rig's friction, seldom as good as the sensor noise
_CURVE = 60  # points of the drawn curve in each direction


def summary(found: Identification, runs: Sequence[Run]) -> dict[str, Any]:
    """All results from the `runs`, with the evidence; SI units. Missing values are NaN."""
    return {
        "schema_version": 1,
        "model": found.model.name,
        "coordinate": found.model.coordinate,
        "effects": list(found.model.effects),
        "parameters": {name: _parameter(found, name) for name in found.parameters},
        "undetermined": found.undetermined,
        "correlations": [
            {"between": list(pair), "r": r, "strong": bool(abs(r) > STRONG)} for pair, r in found.correlations.items()
        ],
        "map": {"points": _points(found), "curve": _curve(found), **_fit_quality(found), "window_s": WINDOW},
        "motion": _motion(found),
        "runs": [_run(run, [w for w in found.windows if w.run == run.name]) for run in runs],
        "refused": [
            {"run": w.run, "start_s": w.start, "stop_s": w.stop, "input": w.input, "reason": w.reason,
             "detail": w.refused}
            for w in found.windows if not w.used
        ],
        "breakaways": [
            {"run": b.run, "time_s": b.time, "direction": b.direction, "force_n": b.force, "spread_n": b.spread,
             "ramp_n_per_s": b.ramp, "rest_s": b.rest}
            for b in found.breakaways
        ],
    }  # fmt: skip


def _motion(found: Identification) -> dict[str, Any] | None:
    """How parameters were fitted to any motion; None where constant commands gave a static map."""
    if not found.segments:
        return None
    return {
        "why": found.why_motion, "segments": found.segments, "misfit": found.misfit,
        "in_position_loop": found.model.self_driven,
    }  # fmt: skip


def _fit_quality(found: Identification) -> dict[str, Any]:
    """Distance of the points from the fitted curve."""
    if not found.points:
        nothing = dict.fromkeys(("residual_rms_n", "residual_before_rms_n", "share_of_force", "ratio_to_noise"), nan)
        return nothing | {"explained_by_noise": True, "fits": True}
    rms = float(np.sqrt(np.mean(found.map_fit.residuals**2)))
    at, force = (np.array([getattr(point, key) for point in found.points]) for key in ("velocity", "force"))
    before = float(np.sqrt(np.mean((force - sliding_friction(found.before, at)) ** 2)))
    share = rms / float(np.median([abs(p.force) for p in found.points]))
    ratio = found.map_fit.ratio
    return {
        "residual_rms_n": rms, "residual_before_rms_n": before, "share_of_force": share, "ratio_to_noise": ratio,
        "explained_by_noise": bool(ratio < MISFIT), "fits": bool(ratio < MISFIT or share < REPEATS),
    }  # fmt: skip


def _parameter(found: Identification, name: str) -> dict[str, Any]:
    one = found.parameters[name]
    low, high = one.interval or (None, None)
    return {
        "before": one.before, "value": one.value, "low": low, "high": high, "unit": one.unit,
        "meaning": found.model.specification(name).meaning, "determined": one.interval is not None,
        "source": one.remark,
    }  # fmt: skip


def _points(found: Identification) -> dict[str, list[Any]]:
    used = [w for w in found.windows if w.used]
    return {
        "run": [w.run for w in used], "start_s": [w.start for w in used], "input": [w.input for w in used],
        "velocity": [w.velocity for w in used], "velocity_std": [w.velocity_noise for w in used],
        "force": [w.friction for w in used], "force_std": [w.friction_noise for w in used],
        "residual": found.map_fit.residuals.tolist(), "residual_std": found.map_fit.spread.tolist(),
    }  # fmt: skip


def _curve(found: Identification) -> dict[str, list[float]]:
    """Friction at constant velocity, of the identified and the original model; NaN at rest breaks the curves."""
    velocity = np.array([p.velocity for p in found.points])
    slowest = 0.1 * min(model["lugre_friction.stribeck_velocity"] for model in (found.model, found.before))
    reach = [1.05 * max(side.max(initial=0.0), 2.0 * slowest) for side in (-velocity, velocity)]
    left, right = (np.geomspace(min(slowest, 0.5 * end), end, _CURVE) for end in reach)
    at = np.concatenate([-left[::-1], right])
    curve = {
        "velocity": at,
        "friction": sliding_friction(found.model, at),
        "before": sliding_friction(found.before, at),
    }
    return {name: np.insert(values, _CURVE, np.nan).tolist() for name, values in curve.items()}


def _run(run: Run, windows: Sequence[Window]) -> dict[str, Any]:
    """The use of one run: its used stretches, and the number of refused windows by reason."""
    return {
        "name": run.name, "duration_s": float(run.time[-1]), "sample_time_s": run.sample_time,
        "windows": len(windows), "used": sum(w.used for w in windows),
        "stretches": [_stretch(list(part)) for used, part in groupby(windows, lambda w: w.used) if used],
        "refused": dict(Counter(w.reason for w in windows if not w.used).most_common()),
    }  # fmt: skip


def _stretch(windows: Sequence[Window]) -> dict[str, Any]:
    """Used windows one after another."""
    return {
        "start_s": windows[0].start, "stop_s": windows[-1].stop, "input": windows[0].input, "windows": len(windows),
        "velocity": float(np.mean([w.velocity for w in windows])),
        "force": float(np.mean([w.friction for w in windows])),
    }  # fmt: skip
