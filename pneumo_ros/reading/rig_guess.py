"""How a rig is wired, guessed from a recording: units, gauge, swapped, reversed, zero of the encoder, closed signal.

Every combination is a hypothesis: the recording is corrected by it, and the equations of the machine are evaluated
along the corrected signals. A wrong plug makes residuals several times larger than a wrong parameter or a missing
effect does; the words with the least residuals, geometric mean over the equations, are those of the rig.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.reading.read import ATMOSPHERE
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import corrected
from pneumo_ros.runs.run import make_run

HIGHEST = (("MPa", 1.3), ("bar", 14.0), ("psi", 160.0), ("kPa", 1400.0), ("hPa", 1.4e4))  # of a running axis
SECONDS = 30.0  # of the recording that are looked at
SIMPLER = 1.05  # times larger residuals that a simpler hypothesis may have: nothing is corrected without reason
APART = 1.5  # times larger residuals that make the second best hypothesis another one
SLOWEST = 0.01  # m of motion, without which nothing can be told


@dataclass(frozen=True)
class Hypothesis:
    """Words of --read-as, and the residual of each equation with them [N, kg/s]."""

    words: tuple[str, ...]
    residuals: dict[str, float]

    @property
    def size(self) -> float:
        """Geometric mean of the residuals."""
        return math.exp(sum(map(math.log, self.residuals.values())) / len(self.residuals))


@dataclass(frozen=True)
class Guess:
    """The hypotheses, the likeliest first; `recorded` is that of no correction, None where it makes no sense."""

    ranked: tuple[Hypothesis, ...]
    recorded: Hypothesis | None

    @property
    def best(self) -> Hypothesis:
        """The likeliest."""
        return self.ranked[0]

    @property
    def certain(self) -> bool:
        """Whether the next hypothesis that says anything else is clearly worse."""
        return len(self.ranked) < 2 or self.ranked[1].size > APART * self.best.size


def guess_rig(recording: Recording, model: Model) -> Guess:
    """How `recording` was wired, judged by `model`.

    Raises DataError for a recording without command, position or pressures, whose piston hardly moves, or in which no
    hypothesis makes sense.
    """
    if recording.voltage is None or recording.pressure_a is None or recording.pressure_b is None:
        raise DataError(f"{recording.name}: guessing the wiring takes a valve command, a position and both pressures")
    part = _part(recording)
    given = [_unit(part), *_length(part, model)]
    words = [word for word in given if word]
    factor = 1e-3 if "mm" in words else 1.0
    travelled = factor * float(np.ptp(part.position))
    if travelled < SLOWEST:
        raise DataError(
            f"{recording.name}: the piston moves {1e3 * travelled:.2g} mm; record a run that moves it both ways"
        )
    found = list[Hypothesis]()
    for choice in itertools.product(
        ((), ("gauge",)), ((), ("swapped-chambers",)), ((), ("reversed-position",)), ((), ("reversed-voltage",)),
        _zeros(part, model, factor), _closed(part, model),
    ):  # fmt: skip
        said = (*words, *itertools.chain.from_iterable(choice))
        if (residuals := _residuals(part, model, said)) is not None:
            found.append(Hypothesis(said, residuals))
    if not found:
        raise DataError(
            f"{recording.name}: as no wiring makes sense with '{model.name}': is it this machine's recording?"
        )
    least = min(one.size for one in found)
    ranked = sorted(
        found,
        key=lambda one: (one.size > SIMPLER * least, len(one.words) if one.size <= SIMPLER * least else 0, one.size),
    )
    plain = next((one for one in found if not one.words), None)
    return Guess(tuple(ranked), plain)


def _part(recording: Recording) -> Recording:
    """The part of SECONDS in which the piston moves most, at rest before it if that is possible."""
    time = recording.time
    if time[-1] <= SECONDS:
        return recording
    starts = np.arange(0.0, time[-1] - SECONDS + 1e-9, 0.25 * SECONDS)
    spans = [float(np.ptp(recording.position[(time >= s) & (time <= s + SECONDS)])) for s in starts]
    begin = float(starts[int(np.argmax(spans))])
    inside = (time >= begin) & (time <= begin + SECONDS)
    picked: dict[str, Any] = {name: values[inside] for name, values in recording.signals.items()}
    times, command = recording.command_time, recording.command
    if times is not None and command is not None:
        keep = times <= begin + SECONDS
        picked |= {"command_time": np.maximum(times[keep] - begin, 0.0), "command": command[keep]}
    return replace(recording, time=time[inside] - begin, **picked)


def _unit(recording: Recording) -> str:
    """The word for the unit of the pressures, "" for Pa, by their highest value."""
    both = (recording.pressure_a, recording.pressure_b)
    highest = max(float(np.quantile(one, 0.999)) for one in both if one is not None)
    return (
        next((unit for unit, most in HIGHEST if highest < most), "")
        if highest < max(limit for _, limit in HIGHEST)
        else ""
    )


def _length(recording: Recording, model: Model) -> Sequence[str]:
    """The word for mm where the piston would travel many strokes in m."""
    return ("mm",) if float(np.ptp(recording.position)) > 2.0 * model["piston.stroke"] else ()


def _zeros(recording: Recording, model: Model, factor: float) -> list[tuple[str, ...]]:
    """Zeros of the encoder: mid stroke, either end, as far as the positions lie inside the stroke with them."""
    half, low, high = 0.5 * model["piston.stroke"], factor * recording.position.min(), factor * recording.position.max()
    found: list[tuple[str, ...]] = []
    for zero in (0.0, half, -half):
        if low - zero >= -1.1 * half and high - zero <= 1.1 * half:
            found.append((f"zero={1e3 * zero:g}mm",) if zero else ())
    return found or [(f"zero={1e3 * 0.5 * (low + high):g}mm",)]


def _closed(recording: Recording, model: Model) -> list[tuple[str, ...]]:
    """Closed signals: that of the machine file, and where all commands have one sign, the middles of usual ranges."""
    assert recording.voltage is not None
    low, high = float(recording.voltage.min()), float(recording.voltage.max())
    found: list[tuple[str, ...]] = [()]
    if low > -0.1 * high or high < -0.1 * low:
        usual = (math.copysign(5.0, low + high), math.copysign(2.5, low + high), 0.5 * round(low + high))
        known = closed_signal(model)
        found += [(f"closed={one - known:g}V",) for one in dict.fromkeys(usual) if one != known]
    return found


def _residuals(recording: Recording, model: Model, words: tuple[str, ...]) -> dict[str, float] | None:
    """Residual of each equation with a correction; None where it makes no sense."""
    atmosphere = model.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
    mended = corrected(recording, words, atmosphere)
    for pressure in (mended.pressure_a, mended.pressure_b):
        if pressure is None or np.quantile(pressure, 0.01) < 0.5 * atmosphere or pressure.max() > 1.6e6:
            return None
    try:
        run = make_run(mended, model.force_driven, model.imposed)
        found = {name: one.rms for name, one in equation_residuals(model, run).items()}
    except PneumoError:
        return None
    return found if all(math.isfinite(rms) and rms > 0.0 for rms in found.values()) and found else None
