"""Runs that each show one property: zero, leaks, pauses, reversals, the edge of the dead zone."""

from dataclasses import replace

from pneumo_ros.experiment.constant_voltage import constant_voltage
from pneumo_ros.experiment.programme import MAX_VOLTAGE, Programme, Trial
from pneumo_ros.experiment.room import MODERATE, dead_zone, room_of
from pneumo_ros.experiment.voltages import Constant, Steps, Sweep
from pneumo_ros.plant import Model

VENT = "shut the supply off and let its pressure out, so that both chambers can empty"
BLOCK_PISTON = "block the piston near mid stroke, so that it cannot move"
MARGIN = 0.2  # of the stroke kept free before either end
PAUSES = (0.1, 1.0, 10.0, 60.0)  # s
_MOVE, _BRAKE = 1.2, 0.25  # s of motion between pauses, and of braking before them
_LEVEL = 0.02  # s, steps of a triangle
_HOLD = 20.0  # s at closed valve


def vent(model: Model, seconds: float = 20.0) -> Programme:
    """Both chambers opened to the atmosphere in turn, supply shut off: sensors at a known pressure.

    Raises UsageError for a model without valve, as all functions here do.
    """
    right, left = dead_zone(model)
    levels = tuple((seconds / 4.0, sign) for sign in (right + 3.0, -left - 3.0) * 2)
    trial = Trial("vented", Steps(levels), seconds, anywhere=True)
    return Programme("vent", model.name, trials=(trial,), prepare=VENT, **room_of(model))


def hold(model: Model, seconds: float = 5.0) -> Programme:
    """Chambers filled by a move and held at closed valve for 20 s, at several positions; `seconds` limits the moves."""
    room = room_of(model)
    right, left = dead_zone(model)
    volts = {1: right + 3.0 * MODERATE, -1: left + 3.0 * MODERATE}
    trials = tuple(
        Trial(f"hold_{k}", Constant(round(sign * volts[sign], 6)), seconds, 10.0, share * room["high"])
        for k, (sign, share) in enumerate(((1, 0.9), (-1, 0.5), (1, 0.5)), start=1)
    )
    return Programme("hold", model.name, trials=trials, rest=_HOLD, **room)


def full_strokes(model: Model, seconds: float = 20.0) -> Programme:
    """Full strokes both ways, slowly and fast."""
    right, left = dead_zone(model)
    edge = max(right, left)
    chosen = [min(edge + volts, MAX_VOLTAGE) for volts in (0.1, 1.5)]
    return replace(constant_voltage(model, chosen, seconds), experiment="full-strokes")


def pauses(model: Model, seconds: float = 100.0) -> Programme:
    """Moves to and fro with pauses of 0.1, 1, 10 and 60 s before them, both ways except the longest."""
    right, left = dead_zone(model)
    volts = {1: right + 1.5 * MODERATE, -1: left + 1.5 * MODERATE}
    levels: list[tuple[float, float]] = []
    sign = 1
    for pause in (*(p for p in PAUSES[:-1] for _ in (0, 1)), PAUSES[-1]):
        levels += [(_MOVE, sign * volts[sign]), (_BRAKE, -sign * volts[-sign]), (pause, 0.0)]
        sign = -sign
    levels.append((_MOVE, sign * volts[sign]))
    trial = Trial("pauses", Steps(tuple((s, round(v, 3)) for s, v in levels)), seconds)
    return Programme("pauses", model.name, trials=(trial,), **room_of(model, MARGIN))


def fast_reversals(model: Model, seconds: float = 20.0) -> Programme:
    """Cosines of 1 to 3 Hz, valve wide open."""
    volts = max(dead_zone(model)) + 5.0
    trial = Trial("fast_reversals", Sweep(volts, 1.0, 3.0, seconds), seconds)
    return Programme("fast-reversals", model.name, trials=(trial,), **room_of(model, MARGIN))


def triangle(model: Model, seconds: float = 32.0) -> Programme:
    """The voltage rises and falls slowly, to just beyond the dead zone both ways."""
    trial = Trial("triangle", Steps(_triangle(model, 0.1, 8.0, seconds)), seconds)
    return Programme("triangle", model.name, trials=(trial,), **room_of(model, MARGIN))


def blocked_triangle(model: Model, seconds: float = 32.0) -> Programme:
    """The voltage rises and falls slowly while the piston is blocked: the valve alone."""
    trial = Trial("blocked_triangle", Steps(_triangle(model, 0.3, 8.0, seconds)), seconds, anywhere=True)
    return Programme("blocked-triangle", model.name, trials=(trial,), prepare=BLOCK_PISTON, **room_of(model))


def _triangle(model: Model, beyond: float, period: float, seconds: float) -> tuple[tuple[float, float], ...]:
    right, left = dead_zone(model)
    levels = []
    for k in range(round(seconds / _LEVEL)):
        phase = 4.0 * ((k * _LEVEL / period) % 1.0)
        share = phase if phase < 1.0 else 2.0 - phase if phase < 3.0 else phase - 4.0
        levels.append((_LEVEL, round(share * ((right if share > 0.0 else left) + beyond), 4)))
    return tuple(levels)
