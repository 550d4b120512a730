"""Motion of piecewise constant jerk: its phases, and the setpoint at a given time."""

from collections.abc import Iterable
from typing import NamedTuple

from pneumo_ros.control.setpoint import Setpoint


class Phase(NamedTuple):
    """`duration` [s] of constant `jerk` [m/s3]."""

    duration: float
    jerk: float


def moved(start: Setpoint, jerk: float, time: float) -> Setpoint:
    """The setpoint after `time` [s] of constant `jerk` [m/s3] from `start`."""
    position = start.position + time * (start.velocity + time * (start.acceleration / 2.0 + time * jerk / 6.0))
    velocity = start.velocity + time * (start.acceleration + time * jerk / 2.0)
    return Setpoint(position, velocity, start.acceleration + time * jerk, jerk)


def end(start: Setpoint, phases: Iterable[Phase]) -> Setpoint:
    """The setpoint after all `phases`, one after the other, from `start`."""
    for phase in phases:
        start = moved(start, phase.jerk, phase.duration)
    return start


def velocity_change(start: Setpoint, velocity: float, acceleration: float, jerk: float) -> tuple[Phase, ...]:
    """Quickest way from the velocity and acceleration of `start` to a steady `velocity` [m/s], within limits.

    Jerk, none, opposite jerk: Lambrechts, Boerlage and Steinbuch, Control Engineering Practice 13 (2005) 145-157,
    sec. 2, from any initial acceleration. The velocity v0 + a0 |a0| / 2j, reached if the acceleration is ended at once,
    decides the direction of the push. An initial acceleration beyond the limit is brought back to it.
    """
    a0 = start.acceleration
    side = 1.0 if velocity >= start.velocity + a0 * abs(a0) / (2.0 * jerk) else -1.0
    a0, gain = side * a0, side * (velocity - start.velocity)
    peak = min(max(jerk * gain + 0.5 * a0 * a0, 0.0) ** 0.5, acceleration)
    begin = jerk if peak >= a0 else -jerk
    gained = (peak * peak - a0 * a0) / (2.0 * begin) + peak * peak / (2.0 * jerk)
    steady = max((gain - gained) / peak, 0.0) if peak > 0.0 else 0.0
    return (
        Phase(abs(peak - a0) / jerk, side * begin),
        Phase(steady, 0.0),
        Phase(peak / jerk, -side * jerk),
    )
