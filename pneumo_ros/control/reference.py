"""Wanted motions as functions of time."""

import math
from collections.abc import Sequence

from pneumo_ros.control.setpoint import Reference, Setpoint
from pneumo_ros.errors import UsageError


def constant(position: float) -> Reference:
    """Always `position` [m]; UsageError unless it is finite."""
    _finite(position=position)
    held = Setpoint(float(position))
    return lambda time: held


def steps(levels: Sequence[float], hold: float) -> Reference:
    """Each of `levels` [m] for `hold` [s], over and over; UsageError for an empty list, numbers that are not finite
    or a hold that is not positive.
    """
    if not levels:
        raise UsageError("levels is empty; it takes positions in m, for example [0.0, 0.06]")
    for level in levels:
        _finite(levels=level)
    _positive(hold=hold)
    held = tuple(Setpoint(float(level)) for level in levels)
    return lambda time: held[int(math.floor(time / hold + 1e-9)) % len(held)]


def sine(amplitude: float, frequency: float, offset: float = 0.0, phase: float = 0.0) -> Reference:
    """offset + amplitude sin(2 pi frequency t + phase): m, Hz, m, rad; UsageError unless all are finite."""
    _finite(amplitude=amplitude, frequency=frequency, offset=offset, phase=phase)
    rate = 2.0 * math.pi * frequency

    def motion(time: float) -> Setpoint:
        up, across = amplitude * math.sin(rate * time + phase), amplitude * math.cos(rate * time + phase)
        return Setpoint(offset + up, rate * across, -(rate**2) * up, -(rate**3) * across)

    return motion


def _finite(**values: float) -> None:
    for name, value in values.items():
        if not math.isfinite(value):
            raise UsageError(f"{name} is {value!r}; it takes a finite number")


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"{name} is {value!r}; it takes a positive number")
