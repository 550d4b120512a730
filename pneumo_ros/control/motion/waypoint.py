"""The points of a trajectory, and the check of a list of them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from pneumo_ros.errors import UsageError


class Waypoint(NamedTuple):
    """Position [m] at `time` [s] after the start; velocity [m/s] and acceleration [m/s2] if they are wanted."""

    time: float
    position: float
    velocity: float | None = None
    acceleration: float | None = None

    def slowed(self, factor: float) -> "Waypoint":
        """The same place `factor` times later, at velocities and accelerations that fit."""
        velocity = None if self.velocity is None else self.velocity / factor
        acceleration = None if self.acceleration is None else self.acceleration / factor**2
        return Waypoint(self.time * factor, self.position, velocity, acceleration)


def check_waypoints(waypoints: Sequence[Waypoint]) -> None:
    """Raise UsageError unless times rise from 0 or more, all numbers are finite and the last point is at rest."""
    if not waypoints:
        raise UsageError("the trajectory has no points")
    before = -math.inf
    for number, point in enumerate(waypoints, 1):
        if not all(value is None or math.isfinite(value) for value in point):
            raise UsageError(f"point {number} of the trajectory holds a number that is not finite: {tuple(point)}")
        if point.time < 0.0 or point.time <= before:
            raise UsageError(
                f"point {number} of the trajectory is at {point.time:g} s, "
                + ("before its start" if point.time < 0.0 else f"not after the one at {before:g} s")
            )
        before = point.time
    if waypoints[-1].velocity:
        raise UsageError(f"the trajectory ends at {waypoints[-1].velocity:g} m/s; its last velocity must be 0")


def ahead(waypoints: Sequence[Waypoint], passed: float) -> list[Waypoint]:
    """The points later than `passed` [s], on a clock that starts there; UsageError if all of them are over."""
    later = [point._replace(time=point.time - passed) for point in waypoints if point.time > passed]
    if waypoints and not later:
        raise UsageError(f"the trajectory ended {passed - waypoints[-1].time:.3g} s ago")
    return later
