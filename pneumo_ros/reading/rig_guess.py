"""How a rig is wired, guessed from a recording: units, gauge, swapped, reversed, zero of the encoder, closed signal.

Every combination is a hypothesis: the recording is corrected by it, and the equations of the machine are evaluated
along the corrected signals. A wrong plug makes residuals several times larger than a wrong parameter or a missing
effect does; the words with the least residuals, geometric mean over the equations, are those of the rig.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.reading.read import ATMOSPHERE
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import POSITION_UNITS, PRESSURE_UNITS, corrected, number
from pneumo_ros.records.unfit import FILLED, check_pressures
from pneumo_ros.runs.run import Run, run_for
from pneumo_ros.units import TURN, shown

LOWEST, HIGHEST = 3e4, 1.4e6  # Pa, the highest pressure that an axis reads while it moves, gauge or absolute
SECONDS = 30.0  # of the recording that are looked at
SIMPLER = 1.05  # times larger residuals that a simpler hypothesis may have: nothing is corrected without reason
APART = 1.5  # times larger residuals that make the second best hypothesis another one
FLOWS = (
    "arctan_flow.filling_coefficient", "arctan_flow.exhaust_coefficient", "choked_flow.conductance_filling",
    "choked_flow.conductance_exhaust",
)  # fmt: skip
FRICTION = ("lugre_friction.static_friction", "lugre_friction.coulomb_friction")
ROUGHLY = 1.5  # factor within which flow and friction are free: nobody knows them before the axis has moved
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
    """The hypotheses, the likeliest first; `recorded` is that of no correction, None where it makes no sense.

    decided: a fit of the machine has told the first one from those that explain the recording alike.
    """

    ranked: tuple[Hypothesis, ...]
    recorded: Hypothesis | None
    decided: bool = False

    @property
    def best(self) -> Hypothesis:
        """The likeliest."""
        return self.ranked[0]

    @property
    def certain(self) -> bool:
        """Whether the next hypothesis that says anything else is clearly worse."""
        return self.decided or len(self.alike) == 1

    @property
    def alike(self) -> tuple[Hypothesis, ...]:
        """Those that explain the recording nearly as well as the best, and that one."""
        return tuple(one for one in self.ranked if one.size <= APART * self.best.size)


def guess_rig(
    recorded: Recording | Sequence[Recording],
    model: Model,
    known: Sequence[str] | None = None,
    closed: Sequence[str] | None = None,
) -> Guess:
    """How a recording, or several of one rig, was wired, judged by `model`.

    `known`: words of the pressure sensors, and `closed`: the word of the closed signal, none where it is the machine
    file's; neither is then guessed. Raises DataError for a recording without command, position or pressures, where the
    piston hardly moves, or in which no hypothesis makes sense.
    """
    parts = [moving_part(one) for one in ([recorded] if isinstance(recorded, Recording) else recorded)]
    names = ", ".join(part.name for part in parts)
    for part in parts:
        if part.voltage is None or part.pressure_a is None or part.pressure_b is None:
            raise DataError(
                f"{part.name}: guessing the wiring takes a valve command, a position and both pressures. A machine "
                "that a force or an imposed motion drives needs no guess: give --read-as the units, and type pneumo "
                "compare BAG --model MODEL; where a sign or unit is wrong, it says so"
            )
    lengths = next((word for part in parts if (word := _length(part, model))), ())
    factor = POSITION_UNITS[lengths[0]] if lengths else 1.0
    travelled = factor * max(float(np.ptp(part.position)) for part in parts)
    if travelled < SLOWEST:
        raise DataError(
            f"{names}: the piston moves {1e3 * travelled:.2g} {shown('mm')}; record a run that moves it both ways"
        )
    found = list[Hypothesis]()
    for choice in itertools.product(
        _sensors(parts, known), ((), ("swapped-chambers",)), ((), ("reversed-position",)), ((), ("reversed-voltage",)),
        _zeros(parts, model, factor), _closed(parts, model) if closed is None else [tuple(closed)],
    ):  # fmt: skip
        unit, *others = choice
        if "reversed-voltage" in others[2]:
            others[-1] = _mirrored(others[-1], closed_signal(model))
        said = (*unit[:1], *lengths, *unit[1:], *itertools.chain.from_iterable(others))
        if (residuals := _residuals(parts, model, said)) is not None:
            found.append(Hypothesis(said, residuals))
    if not found:
        raise DataError(_senseless(parts, model))
    found = _comparable(found)
    least = min(one.size for one in found)
    ranked = sorted(
        found,
        key=lambda one: (one.size > SIMPLER * least, len(one.words) if one.size <= SIMPLER * least else 0, one.size),
    )
    plain = next((one for one in found if not one.words), None)
    return Guess(tuple(ranked), plain)


def _senseless(parts: Sequence[Recording], model: Model) -> str:
    """Why no hypothesis makes sense: pressures of oil, as far as the recording itself says so."""
    names = ", ".join(part.name for part in parts)
    if max(float(p.max()) for part in parts for p in (part.pressure_a, part.pressure_b) if p is not None) > FILLED:
        try:
            for part in parts:
                check_pressures(part)
        except DataError as problem:
            return str(problem)
    return f"{names}: no wiring makes sense with '{model.name}': is it this machine's recording?"


def moving_part(recording: Recording) -> Recording:
    """The part of SECONDS in which the piston moves most, at rest before it if that is possible."""
    time = recording.time
    if time[-1] <= SECONDS:
        return recording
    starts = np.arange(0.0, time[-1] - SECONDS + 1e-9, 0.25 * SECONDS)
    spans = [float(np.ptp(recording.position[(time >= s) & (time <= s + SECONDS)])) for s in starts]
    begin = float(starts[int(np.argmax(spans))])
    inside = (time >= begin) & (time <= begin + SECONDS)
    picked: dict[str, Any] = {name: values[inside] for name, values in recording.signals.items()}
    for name in ("command", "command_b"):
        times, command = getattr(recording, f"{name}_time"), getattr(recording, name)
        if times is not None and command is not None:
            keep = times <= begin + SECONDS
            picked |= {f"{name}_time": np.maximum(times[keep] - begin, 0.0), name: command[keep]}
    return recording.with_signals(picked, time=time[inside] - begin)


def _sensors(parts: Sequence[Recording], known: Sequence[str] | None) -> list[tuple[str, ...]]:
    """Units of the pressures that make sense by their highest value, each absolute and gauge; `known` alone, if any."""
    if known is not None:
        return [tuple(word for word in known if word in (*PRESSURE_UNITS, "gauge"))]
    both = [one for part in parts for one in (part.pressure_a, part.pressure_b) if one is not None]
    highest = max(float(np.quantile(one, 0.999)) for one in both)
    units = [name for name, factor in PRESSURE_UNITS.items() if LOWEST <= highest * factor <= HIGHEST]
    return [(*unit, *zero) for unit in (*((one,) for one in units), ()) for zero in ((), ("gauge",))]


def _comparable(found: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The hypotheses by the equations that all of them can be judged by: momentum needs motion that lasts."""
    shared = set.intersection(*(set(one.residuals) for one in found))
    return [Hypothesis(one.words, {n: rms for n, rms in one.residuals.items() if n in shared}) for one in found]


def _length(recording: Recording, model: Model) -> Sequence[str]:
    """The word for mm, or degrees, where the piston would travel, or stand away, many strokes in m, or radians."""
    moved, read = float(np.ptp(recording.position)), float(np.abs(recording.position).max())
    far = moved > 2.0 * model["piston.stroke"] or read > 5.0 * model["piston.stroke"]
    return () if not far else ("deg",) if model.coordinate == TURN else ("mm",)


def _zeros(parts: Sequence[Recording], model: Model, factor: float) -> list[tuple[str, ...]]:
    """Zeros of the encoder: mid stroke, either end, as far as the positions lie inside the stroke with them."""
    half = 0.5 * model["piston.stroke"]
    low, high = (factor * float(side([side(one.position) for one in parts])) for side in (np.min, np.max))
    found: list[tuple[str, ...]] = []
    for zero in (0.0, half, -half):
        if low - zero >= -1.1 * half and high - zero <= 1.1 * half:
            found.append((_zero(zero, model),) if zero else ())
    return found or [(_zero(0.5 * (low + high), model),)]


def _zero(position: float, model: Model) -> str:
    """The word of an encoder that reads `position` at mid stroke."""
    return f"zero={position:g}rad" if model.coordinate == TURN else f"zero={1e3 * position:g}mm"


def _closed(parts: Sequence[Recording], model: Model) -> list[tuple[str, ...]]:
    """Closed signals: that of the machine file, and where all commands have one sign, the middles of usual ranges."""
    commands = [one.voltage for one in parts if one.voltage is not None]
    low, high = (float(side([side(one) for one in commands])) for side in (np.min, np.max))
    found: list[tuple[str, ...]] = [()]
    if low > -0.1 * high or high < -0.1 * low:
        usual = (math.copysign(5.0, low + high), math.copysign(2.5, low + high), 0.5 * round(low + high))
        known = closed_signal(model)
        found += [(f"closed={one - known:g}V",) for one in dict.fromkeys(usual) if one != known]
    return found


def _mirrored(words: tuple[str, ...], known: float) -> tuple[str, ...]:
    """The word of a closed signal where the command is reversed: about that signal, not about 0 V.

    `known` [V] closes the valve by the machine file.
    """
    if known == 0.0:
        return words
    beside = next((found[1] for word in words if (found := number(word)) is not None), 0.0)
    return (f"closed={beside + 2.0 * known:g}V",)


def _residuals(parts: Sequence[Recording], model: Model, words: tuple[str, ...]) -> dict[str, float] | None:
    """Residual of each equation with a correction; None where it makes no sense."""
    atmosphere = model.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
    mended = [corrected(one, words, atmosphere) for one in parts]
    for pressure in (signal for one in mended for signal in (one.pressure_a, one.pressure_b)):
        if pressure is None or np.quantile(pressure, 0.01) < 0.5 * atmosphere or np.quantile(pressure, 0.99) > 1.6e6:
            return None
    try:
        runs = [run_for(one, model) for one in mended]
        found = _scaled_residuals(model, runs)
    except PneumoError:
        return None
    judged = {name: rms for name, rms in found.items() if math.isfinite(rms) and rms > 0.0}
    return judged if len(judged) > 1 else None


def _scaled_residuals(model: Model, runs: Sequence[Run]) -> dict[str, float]:
    """Rms of each equation's residual over all runs, with the scale of flow, or of friction, that makes it least.

    Each equation is linear in its scale, so that two values of it give them all. The scale takes all of a single
    window's residual, so no residual counts as less than the noise of the sensors.
    """
    halved = model.with_parameters({n: 0.5 * model[n] for n in (*FLOWS, *FRICTION) if n in model.parameters})
    whole, half = ([equation_residuals(one, run) for run in runs] for one in (model, halved))
    found = {}
    for name in whole[0]:
        r, other = (np.concatenate([one[name].value for one in many]) for many in (whole, half))
        if len(r) != len(other) or not len(r):
            found[name] = float("nan")
            continue
        slope = 2.0 * (r - other)
        square = float(slope @ slope)
        most = _factor(model, FRICTION if name == "momentum" else (*FLOWS, "arctan_flow.voltage_gain"))
        scale = min(max(-float(slope @ r) / square, 1.0 / most - 1.0), most - 1.0) if square > 0.0 else 0.0
        noise = np.concatenate([one[name].noise for one in whole])
        found[name] = float(np.sqrt(max(np.mean((r + scale * slope) ** 2), np.mean(noise**2))))
    return found


def _factor(model: Model, names: Sequence[str]) -> float:
    """The factor within which the sizes of `names` are free: more than usual where the machine file says so."""
    wide = [model.uncertainty[name] / abs(model[name]) for name in names if name in model.uncertainty and model[name]]
    return max(ROUGHLY, 1.0 + 2.0 * max(wide, default=0.0))
