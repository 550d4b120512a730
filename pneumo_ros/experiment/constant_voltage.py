"""Constant-voltage runs: each gives a point of the static friction map, and a breakaway before it."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.experiment.programme import MAX_VOLTAGE, Programme, Trial
from pneumo_ros.experiment.room import dead_zone, room_of
from pneumo_ros.experiment.voltages import Constant
from pneumo_ros.plant import Model

# V beyond the dead zone. Speed grows steeply up to 1 V and hardly beyond: most steps are small.
STEPS = (0.015, 0.025, 0.045, 0.08, 0.15, 0.3, 1.0, 6.2)
SECONDS = 8.0  # of motion
PATIENCE = 25.0  # s: longest time until the pressures break the piston away
_LONGER, _LEAST = 1.3, 0.15  # times the predicted way; of the room


def constant_voltage(model: Model, voltages: Sequence[float] = (), seconds: float = SECONDS) -> Programme:
    """Each voltage [V] both ways, slowest first; default: eight steps beyond the dead zone of `model`.

    Each run needs `seconds` of motion; its travel is limited to 1.3 times the prediction. Raises UsageError for
    voltages that are not above 0 and at most 10 V, or so close that their names are equal.
    """
    for volts in voltages:
        if not 0.0 < volts <= MAX_VOLTAGE:
            raise UsageError(f"a voltage is {volts:g} V; allowed is more than 0 to {MAX_VOLTAGE:g} V, run both ways")
    right, left = dead_zone(model)
    steps = [step for step in STEPS if max(right, left) + step <= MAX_VOLTAGE]
    pairs = [(v, v) for v in sorted(voltages)] or [(right + step, left + step) for step in steps]
    signed = [volts for to_right, to_left in pairs for volts in (to_right, -to_left)]
    room = room_of(model)
    trials = []
    for volts in signed:
        way = min(max(_LONGER * _way(model, volts, seconds, room["low"]), _LEAST * room["high"]), 2.0 * room["high"])
        trials.append(Trial(name_of(volts), Constant(round(volts, 6)), seconds, PATIENCE, way))
    return Programme("constant-voltage", model.name, trials=tuple(trials), **room)


def name_of(volts: float) -> str:
    """constant_p1100 for +1.100 V, constant_m1100 for -1.100 V."""
    return f"constant_{'p' if volts > 0.0 else 'm'}{abs(round(1000.0 * volts)):04d}"


def _way(model: Model, volts: float, seconds: float, low: float) -> float:
    """Predicted travel [m] in `seconds` of motion, from rest near the end that the piston comes from.

    A piston that leaves nothing of a chamber at its end, where the model ends, has gone the whole way.
    """
    sample, start = 0.01, low if volts > 0.0 else -low
    held = np.full(round((PATIENCE + seconds) / sample), volts)
    try:
        y = model.simulate(held, model.state(y=start), sample_time=sample)[:, 0]
    except NumericalError:
        return 2.0 * abs(low)
    away = np.abs(y - start)
    moved = int(np.argmax(away > 2e-3))
    return float(away[min(moved + round(seconds / sample), len(away) - 1)]) if moved else 0.0
