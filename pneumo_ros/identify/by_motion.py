"""Identification from any motion, for machines and recordings without steady flow under a constant command.

Pulses of on/off valves and the loops of regulators change the flow while the command is constant; a piston that sticks
and slips, or follows a sine, is nowhere steady: there is no static map and no steady mass balance. All parameters are
fitted together by multiple shooting instead, in segments so short that few hold a breakaway. Two fits to two halves of
the segments may end in neighbouring minima, where a breakaway is predicted a little early or late: half their
difference counts as uncertainty.

The bristle stiffness is often known within its power of ten alone, and presliding may lie within the sensor's noise.
Unless the machine file states how uncertain it is, the halves start at a third and at three times its value, with
priors as wide as that value. Its cost has several minima, so that half the distance between the farthest of all fits
counts as its uncertainty, those that were replaced included.

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
from pneumo_ros.shooting.refit import LOOP_SEGMENT, default_free, refit_segments
from pneumo_ros.shooting.segments import Segments, cut

Array = NDArray[np.float64]

SEGMENT, SAMPLES = 0.1, 20  # s and samples: a segment is at least as long as both
FEWEST = 10  # segments of a position loop: recordings too short for so many have shorter ones
MOST = 140  # segments: more narrow intervals slowly and take proportionally longer
_DETERMINED = 0.5  # of the prior deviation: a parameter that is known no better is not determined
BRISTLE = "lugre_friction.bristle_stiffness"
APART = 3.0  # times and over the bristle stiffness, where the halves start: half a power of ten either way
_TOLD_APART = 1.92  # cost: half the 95 % point of chi squared with one degree; data do not tell what differs by less
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
        and (not name.startswith("lugre_friction.") or name in wanted or name == BRISTLE)
    )


def fit_by_motion(
    model: Model, runs: Sequence[Run], wanted: Sequence[str], tell: Callable[[float, str], None]
) -> MotionIdentification:
    """Fit to two halves of evenly drawn segments; the difference counts. Raises DataError as `refit_segments`."""
    alike = on_one_clock(runs)
    segments = cut(model, alike, max(_length(model, alike), SAMPLES * alike[0].sample_time))
    rows = np.unique(np.linspace(0, len(segments) - 1, min(MOST, len(segments))).round().astype(np.int64))
    parts = [segments.pick(rows[k::2]) for k in range(2)]
    halves, least = _halves(model, parts, parameters_of(model, wanted), tell)
    free = tuple(halves[0].estimates)
    found = {name: _found(model, name, halves, len(rows), least.get(name, 0.0)) for name in free}
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
) -> tuple[list[Refit], dict[str, float]]:
    """A refit of each half; the half that fits worse is tried once more from the values of the other.

    And by name the least deviation: half the distance of the farthest of all fits, where the bristle stiffness is
    fitted without a stated uncertainty.
    """
    unstated = BRISTLE in free and BRISTLE not in model.uncertainty
    priors = {BRISTLE: model[BRISTLE]} if unstated else {}

    def fit(start: Model, part: Segments, share: float) -> Refit:
        return refit_segments(start, part, free, priors, progress=lambda own, text: tell(share + own / 3.0, text))

    halves = [fit(one, part, k / 3.0) for k, (one, part) in enumerate(zip(_begun(model, unstated), parts, strict=True))]
    losses = [half.costs[-1] / _measured(part) for half, part in zip(halves, parts, strict=True)]
    worse = int(np.argmax(losses))
    again = fit(halves[1 - worse].model, parts[worse], 2.0 / 3.0)
    fits = (*halves, again)
    least = {BRISTLE: 0.5 * float(np.ptp([one.estimates[BRISTLE].value for one in fits]))} if unstated else {}
    # the prior of the new fit is about the values of the other half, which is no evidence that they agree
    if _by_data(again) < _by_data(halves[worse]) - _TOLD_APART:
        halves[worse] = again
    return halves, least


def _begun(model: Model, apart: bool) -> tuple[Model, Model]:
    """Where the halves start; `apart`: with different bristle stiffnesses, within what the parameter allows."""
    if not apart:
        return model, model
    spec = model.specification(BRISTLE)
    low, high = max(model[BRISTLE] / APART, spec.low), min(model[BRISTLE] * APART, spec.high)
    return model.with_parameters({BRISTLE: low}), model.with_parameters({BRISTLE: high})


def _by_data(half: Refit) -> float:
    """The cost of a fit without the share of its priors."""
    return half.costs[-1] - 0.5 * sum(((one.value - one.before) / one.prior) ** 2 for one in half.estimates.values())


def _measured(part: Segments) -> int:
    """How many residuals were measured."""
    return int(np.sum(part.weight > 0.0))


def _found(model: Model, name: str, halves: Sequence[Refit], segments: int, least: float) -> Found:
    """Mean of both halves; its deviation is theirs, or half their difference, or the `least`."""
    both = [half.estimates[name] for half in halves]
    value, own = 0.5 * (both[0].value + both[1].value), 0.5 * math.hypot(both[0].std, both[1].std)
    std = max(own, abs(both[0].value - both[1].value) / 2.0, least)
    unit = model.specification(name).unit
    if not std < _DETERMINED * both[0].prior:
        return Found(model[name], None, unit, model[name], "not determined: no motion here shows it")
    interval = (value - 1.96 * std, value + 1.96 * std)
    return Found(value, interval, unit, model[name], f"motion in {segments} segments")
