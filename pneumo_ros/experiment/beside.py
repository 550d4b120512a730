"""A programme about the signal that closes the valve, with voltages that the valve takes beside it."""

from dataclasses import replace

import numpy as np

from pneumo_ros.experiment.programme import MAX_VOLTAGE, Programme, Trial
from pneumo_ros.experiment.voltages import Constant, Ramps, Steps, Sweep, Voltage


def counted_from(programme: Programme, closed: float, *, says_closed: bool = False) -> Programme:
    """The programme with voltages counted from `closed` [V]; a valve of 0 to 10 V takes 5 V on either side.

    Constant voltages beyond that are left out where others remain, and all that is larger is cut.
    """
    most = MAX_VOLTAGE - abs(closed)
    inside = tuple(one for one in programme.trials if not (one.direction and one.voltage.largest > most))
    trials = tuple(_cut(one, most) for one in inside or programme.trials)
    right, left = (min(one, most) for one in (programme.return_right, programme.return_left))
    return replace(
        programme, trials=trials, return_right=right, return_left=left, closed=closed, says_closed=says_closed
    )


def _cut(trial: Trial, most: float) -> Trial:
    return trial if trial.voltage.largest <= most else replace(trial, voltage=_within(trial.voltage, most))


def _within(voltage: Voltage, most: float) -> Voltage:
    if isinstance(voltage, Constant):
        return Constant(float(np.clip(voltage.volts, -most, most)))
    if isinstance(voltage, Steps):
        return Steps(tuple((seconds, float(np.clip(volts, -most, most))) for seconds, volts in voltage.levels))
    if isinstance(voltage, Sweep):
        return replace(voltage, amplitude=min(voltage.amplitude, most))
    assert isinstance(voltage, Ramps)
    return replace(voltage, volts=min(voltage.volts, most))
