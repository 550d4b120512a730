"""Whether a run is plausible: the model detects mistakes of wiring, signs and gauge pressures.

Each mistake is corrected on trial. If that makes the residuals of the equations several times smaller, the mistake was
made: no missing effect does the same (the tests hide every known effect).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import resting_states
from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError
from pneumo_ros.measured import MEASURED
from pneumo_ros.plant import Model
from pneumo_ros.reading.idle import idle_notes
from pneumo_ros.reading.motion import check_sealed, imposed_note
from pneumo_ros.runs.run import Run
from pneumo_ros.units import shown

_GAIN = 2.5  # times smaller residuals, geometric mean over the equations, that prove a mistake
_GROWS = 1.5  # times larger residuals of a chamber disprove it: the cause is hidden friction or a closed valve
_POOR = 0.2  # residual over signal above which mistakes are looked for
_MOVES = 0.01  # m of motion: with less, leaks look like exchanged or reversed signals
_VENTED = 0.5  # of the atmospheric pressure: chambers of a running axis are above it
_BLOCK = 0.05  # s
_MIDDLES = (5.0, 2.5, -2.5, -5.0)  # V
_MOMENTUM, _FLOW = ("N", 1.0), ("g/s", 1e3)  # units of the residuals


@dataclass(frozen=True)
class _Mistake:
    """How to undo a mistake in a run, its description, its word for --read-as, and its remedy."""

    undo: Callable[[Run], Run]
    what: str
    word: str
    mend: str


def check_run(model: Model, run: Run) -> list[str]:
    """Sentences on faults that leave `run` usable: stuck piston, hanging sensor, unchanged commands.

    Raises DataError when the run leaves the stroke of `model`, a sensor is dead, chambers are swapped, position
    or voltage are reversed, or pressures are gauge pressures.
    """
    if run.by_pressures:
        check_sealed(run)
    notes = idle_notes(model, run)
    found = _mistake(model, run)
    if found is not None:
        raise DataError(found)
    return [*notes, *imposed_note(model, run)]


def supply_is_gauge(model: Model, run: Run) -> bool:
    """Whether the flows into the chambers agree much better with the atmosphere's pressure added to the supply's."""
    measuring = model.measuring(("measured_supply",))
    if model.force_driven or measuring.inputs == model.inputs:
        return False
    higher = {**run.further, "measured_supply": run.further["measured_supply"] + model["air.atmospheric_pressure"]}
    both = [_chambers(measuring, one) for one in (run, replace(run, further=higher))]
    return _gain(*both) > _GAIN


def _chambers(model: Model, run: Run) -> dict[str, float]:
    return {name: rms for name, rms in _residuals(model, run).items() if name != "momentum"}


def _mistake(model: Model, run: Run) -> str | None:
    """The sentence for the mistake that explains the residuals best; None when there is none."""
    recorded = _residuals(model, run)
    low = _lowest(run)
    vented = not model.force_driven and low < 0.95 * model["air.atmospheric_pressure"]
    if not vented and not _poor(model, run, recorded):
        return None
    moves = np.ptp(run.position) > _MOVES
    possible = [mistake for mistake in _mistakes(model, run) if moves or mistake.word == "gauge"]
    if not possible:
        return None
    tried = {mistake: _residuals(model, mistake.undo(run)) for mistake in possible}
    gains = {mistake: _gain(recorded, undone) for mistake, undone in tried.items()}
    best = max(gains, key=lambda mistake: gains[mistake])
    empty = best.word == "gauge" and low < _VENTED * model["air.atmospheric_pressure"]
    if gains[best] < (1.0 if empty else _GAIN):
        return None
    reading = f"; a vented chamber reads {1e-3 * low:.3g} kPa" if best.word == "gauge" else ""
    return (
        f"{run.name}: {best.what}{reading}. As recorded, the residuals of '{model.name}' are {_sizes(recorded)}; "
        f"corrected, {_sizes(tried[best])}. Type --read-as {best.word}, or {best.mend}"
    )


def _mistakes(model: Model, run: Run) -> list[_Mistake]:
    """Possible mistakes in a recording of this kind of axis."""
    if model.self_driven:
        return []  # gain, goal and position go together: none of them is wrong by itself
    if model.force_driven:
        return _of_force(model, run)
    rise = model["air.atmospheric_pressure"]
    swapped = _swapped(lambda run: replace(run, pressure_a=run.pressure_b, pressure_b=run.pressure_a))
    gauge = _Mistake(
        lambda run: _raised(run, rise),
        "the pressures seem to be gauge pressures, not absolute ones",
        "gauge",
        f"add the atmosphere's {rise:.6g} Pa where they are published",
    )
    reversed_voltage = _Mistake(
        lambda run: replace(run, input=-run.input),
        "valve/command seems to have the wrong sign; a positive voltage fills chamber a",
        "reversed-voltage",
        "change the sign where the command is recorded",
    )
    commanded = bool(np.ptp(run.input) > 0.0)
    return [
        *([swapped] if len(run.sensed(model.chambers)) > 1 else []),
        gauge,
        _backwards("change the sign where the position is published"),
        *([reversed_voltage, *_off_centre(run)] if commanded or not model.imposed else []),
    ]


def _of_force(model: Model, run: Run) -> list[_Mistake]:
    """Possible mistakes where a force, measured or that of the pressures, drives the piston."""
    if not run.by_pressures:
        kilo = _Mistake(
            lambda run: replace(run, input=1e3 * run.input),
            "the force seems to be in kN, not in N",
            "kN",
            "multiply it by 1000 where it is published",
        )
        return [_backwards("--read-as reversed-force if it is the force that has the wrong sign"), kilo]
    area_a, area_b = model["piston.area_a"], model["piston.area_b"]
    swapped = _swapped(lambda run: replace(run, input=area_a * run.further["p_b"] - area_b * run.further["p_a"]))
    both = {"p_a", "p_b"} <= set(run.further)
    return [_backwards("change the sign where the position is published"), *([swapped] if both else [])]


def _backwards(mend: str) -> _Mistake:
    return _Mistake(
        lambda run: replace(run, position=-run.position, further=_reversed(run.further)),
        "the position seems to count the wrong way; it grows when the rod extends",
        "reversed-position",
        mend,
    )


def _swapped(undo: Callable[[Run], Run]) -> _Mistake:
    return _Mistake(
        undo,
        "chamber_a/pressure and chamber_b/pressure seem to be exchanged; chamber a grows when the rod extends",
        "swapped-chambers",
        "exchange the two topics, or the sensors' plugs, where they are published",
    )


def _off_centre(run: Run) -> list[_Mistake]:
    """The middle of usual ranges of one sign, 0 to 10 V and 0 to 5 V, where commands lie on both sides of it."""
    low, high = float(np.min(run.input)), float(np.max(run.input))
    if low < -0.1 * high and high > -0.1 * low:
        return []
    return [
        _Mistake(
            lambda run, closed=closed: replace(run, input=run.input - closed),  # type: ignore[misc]
            f"the valve seems to be closed at {closed:g} V, not at 0 V",
            f"closed={closed:g}V",
            f"add valve_null_offset to the effects of the machine file, with offset: {-closed:g}",
        )
        for closed in _MIDDLES
        if low < closed < high
    ]


def _residuals(model: Model, run: Run) -> dict[str, float]:
    """Root mean square of the residual of each equation that can be judged."""
    found = {name: residual.rms for name, residual in equation_residuals(model, run).items()}
    return {name: rms for name, rms in found.items() if np.isfinite(rms) and rms > 0.0}


def _gain(recorded: dict[str, float], undone: dict[str, float]) -> float:
    """How many times smaller the residuals become, geometric mean over the equations; 0 when a chamber's grows."""
    both = [name for name in recorded if name in undone]
    if not both or any(undone[name] > _GROWS * recorded[name] for name in both if name != "momentum"):
        return 0.0
    return float(np.exp(np.mean([np.log(recorded[n] / undone[n]) for n in both])))


def _poor(model: Model, run: Run, recorded: dict[str, float]) -> bool:
    """Whether a residual is a large share of its equation's signal: drive force, or flow into a chamber."""
    return any(rms > _POOR * _size(model, run, name) for name, rms in recorded.items())


def _size(model: Model, run: Run, equation: str) -> float:
    """Root mean square of the drive force [N], or of the mass flow into a chamber [kg/s]."""
    if model.force_driven:
        return float(np.sqrt(np.mean(run.held**2)))
    if equation == "momentum":
        return float(np.sqrt(np.mean(model.effort(resting_states(model, run)) ** 2)))
    chamber = next(one for one in model.chambers if one.equation == equation)
    volume = model[chamber.volume] + chamber.way * model[chamber.area] * run.position
    content = run.signals[chamber.signal] * volume
    content /= model["air.gas_constant"] * model["air.temperature"]
    width = min(max(round(_BLOCK / run.sample_time), 1), len(run) // 2)
    means = content[: len(content) // width * width].reshape(-1, width).mean(axis=1)
    return float(np.sqrt(np.mean(np.diff(means) ** 2))) / (width * run.sample_time)


def _lowest(run: Run) -> float:
    """The lowest pressure of both chambers [Pa], without the lowest 1 % of the samples."""
    both = [np.percentile(p, 1) for p in (run.pressure_of("a"), run.pressure_of("b")) if p is not None]
    return float(min(both, default=np.inf))


def _raised(run: Run, rise: float) -> Run:
    a, b = (None if pressure is None else pressure + rise for pressure in (run.pressure_a, run.pressure_b))
    return replace(run, pressure_a=a, pressure_b=b)


def _reversed(further: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """Further inputs where the position counts the other way."""
    flips = {"imposed_velocity", *(one.input for one in MEASURED if one.flips)}
    return {name: -held if name in flips else held for name, held in further.items()}


def _sizes(residuals: dict[str, float]) -> str:
    """Residuals in words."""
    return ", ".join(
        f"{factor * rms:.2g} {shown(unit)} ({name.replace('_', ' ')})"
        for name, rms in residuals.items()
        for unit, factor in [_MOMENTUM if name == "momentum" else _FLOW]
    )
