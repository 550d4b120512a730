"""Identification from any motion, for machines and recordings without steady flow under a constant command.

Pulses of on/off valves and the loops of regulators change the flow while the command is constant; a piston that sticks
and slips, or follows a sine, is nowhere steady: there is no static map and no steady mass balance. All parameters are
fitted together by multiple shooting instead, in segments so short that few hold a breakaway. Two fits to two halves of
the segments may end in neighbouring minima, where a breakaway is predicted a little early or late: half their
difference counts as uncertainty.

A position loop that follows a goal has no constant command either. It corrects what is predicted wrongly, so that its
segments may be as long as the predictions that are judged: in short ones a small servo hardly moves.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.assembly import Found
from pneumo_ros.identify.flow import CHOKED, coefficients
from pneumo_ros.plant import Model
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.estimates import Refit
from pneumo_ros.shooting.refit import default_free, refit_segments
from pneumo_ros.shooting.segments import Segments, cut

Array = NDArray[np.float64]

SEGMENT, SAMPLES = 0.1, 20  # s and samples: a segment is at least as long as both
LOOP_SEGMENT, FEWEST = 1.0, 10  # s, of a position loop; recordings too short for so many segments have shorter ones
MOST = 140  # segments: more narrow intervals slowly and take proportionally longer
_DETERMINED = 0.5  # of the prior deviation: a parameter that is known no better is not determined
# not found by motion: a scale of the opening that the coefficients take in, and a share that is chosen
_LEFT = ("arctan_flow.voltage_gain", "choked_flow.blend")


@dataclass(frozen=True)
class MotionIdentification:
    """The model, every parameter, a sentence for each that is not determined, and the misfit over the noise."""

    model: Model
    parameters: dict[str, Found]
    undetermined: dict[str, str]
    segments: int
    misfit: float  # root mean square of predictions over noise within the segments; 1 when noise explains them


def needs_motion(model: Model) -> str:
    """Why no constant command gives steady motion: a loop that follows a goal, pulses, a regulator's loop; or ""."""
    if model.self_driven:
        return "The goal drives the position loop, and no command is constant"
    if model.composition.jumping or "pressure_regulator" in model.effects:
        return "Pulses or regulators let flow change under a constant command"
    return ""


def parameters_of(model: Model, wanted: Sequence[str]) -> tuple[str, ...]:
    """What is fitted: all that a refit fits, without friction that is not `wanted` and laws without influence."""
    without = (*_LEFT, *(("arctan_flow",) if coefficients(model) == CHOKED else ()))
    return tuple(
        name
        for name in default_free(model)
        if name not in without
        and name.partition(".")[0] not in without
        and (not name.startswith("lugre_friction.") or name in wanted or name.endswith("bristle_stiffness"))
    )


def fit_by_motion(
    model: Model, runs: Sequence[Run], wanted: Sequence[str], tell: Callable[[float, str], None]
) -> MotionIdentification:
    """Fit to two halves of evenly drawn segments; the difference counts. Raises DataError as `refit_segments`."""
    alike = on_one_clock(runs)
    segments = cut(model, alike, max(_length(model, alike), SAMPLES * alike[0].sample_time))
    rows = np.unique(np.linspace(0, len(segments) - 1, min(MOST, len(segments))).round().astype(np.int64))
    parts = [segments.pick(rows[k::2]) for k in range(2)]
    halves = _halves(model, parts, parameters_of(model, wanted), tell)
    free = tuple(halves[0].estimates)
    found = {name: _found(model, name, halves, len(rows)) for name in free}
    values = {name: one.value for name, one in found.items()}
    unknown = {name: "the recordings do not tell it from the others" for name, one in found.items() if not one.interval}
    noise = 0.5 * sum(_measured(part) for part in parts)
    misfit = float(np.sqrt(sum(one.costs[-1] for one in halves) / noise))
    return MotionIdentification(model.with_parameters(values), found, unknown, len(rows), misfit)


def _length(model: Model, runs: Sequence[Run]) -> float:
    """The length of a segment [s], where the clock is fast enough."""
    if not model.self_driven:
        return SEGMENT
    recorded = sum(len(run) * run.sample_time for run in runs)
    return max(SEGMENT, min(LOOP_SEGMENT, recorded / FEWEST))


def _halves(
    model: Model, parts: Sequence[Segments], free: Sequence[str], tell: Callable[[float, str], None]
) -> list[Refit]:
    """A refit of each half; the one that fits worse is tried once more from the values of the other."""

    def fit(start: Model, part: Segments, share: float) -> Refit:
        return refit_segments(start, part, free, {}, progress=lambda own, text: tell(share + own / 3.0, text))

    halves = [fit(model, part, k / 3.0) for k, part in enumerate(parts)]
    losses = [half.costs[-1] / _measured(part) for half, part in zip(halves, parts, strict=True)]
    worse = int(np.argmax(losses))
    again = fit(halves[1 - worse].model, parts[worse], 2.0 / 3.0)
    if again.costs[-1] < halves[worse].costs[-1]:
        halves[worse] = again
    return halves


def _measured(part: Segments) -> int:
    """How many residuals were measured."""
    return int(np.sum(part.weight > 0.0))


def _found(model: Model, name: str, halves: Sequence[Refit], segments: int) -> Found:
    """Mean of both halves; its deviation is theirs, or half their difference."""
    both = [half.estimates[name] for half in halves]
    value, own = 0.5 * (both[0].value + both[1].value), 0.5 * math.hypot(both[0].std, both[1].std)
    std = max(own, abs(both[0].value - both[1].value) / 2.0)
    unit = model.specification(name).unit
    if not std < _DETERMINED * both[0].prior:
        return Found(model[name], None, unit, model[name], "not determined: no motion here shows it")
    interval = (value - 1.96 * std, value + 1.96 * std)
    return Found(value, interval, unit, model[name], f"motion in {segments} segments")
