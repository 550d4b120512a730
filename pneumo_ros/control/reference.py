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


def moves(levels: Sequence[float], hold: float, duration: float) -> Reference:
    """Like `steps`, but from one level to the next within `duration` [s] along x = 10 t^3 - 15 t^4 + 6 t^5.

    Of all motions that begin and end at rest this has the least jerk (T. Flash and N. Hogan, The Coordination of Arm
    Movements, J. Neuroscience 5, 1985). It starts at the first level. Raises UsageError as `steps`, and for a duration
    that is not positive or longer than `hold`.
    """
    held = steps(levels, hold)
    _positive(duration=duration)
    if duration > hold:
        raise UsageError(f"duration is {duration:g} s, longer than the hold of {hold:g} s")

    def motion(time: float) -> Setpoint:
        begin = math.floor(time / hold + 1e-9) * hold
        at, way = held(time), held(time).position - held(max(begin - 0.5 * hold, 0.0)).position
        x = (time - begin) / duration
        return at if x >= 1.0 or way == 0.0 else _least_jerk(at.position - way, way, max(x, 0.0), duration)

    return motion


def _least_jerk(begin: float, way: float, x: float, duration: float) -> Setpoint:
    speed, rate, jerk = way / duration, way / duration**2, way / duration**3
    return Setpoint(
        begin + way * x**3 * (10.0 - 15.0 * x + 6.0 * x * x),
        speed * 30.0 * (x * (1.0 - x)) ** 2,
        rate * 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
        jerk * 60.0 * (1.0 - 6.0 * x + 6.0 * x * x),
    )


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
