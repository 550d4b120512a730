"""Motion through waypoints."""

from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

from pneumo_ros.control.motion.polynomial import Polynomial, cubic, linear, quintic
from pneumo_ros.control.motion.waypoint import Waypoint, check_waypoints
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.errors import UsageError

NEAR = 0.005  # m; farther away, a trajectory that begins at once would begin with a jump


class Trajectory:
    """Reference through `waypoints`, from `start` at time `begin` [s], at rest at the last one afterwards.

    Between two points the motion is quintic where both have velocity and acceleration, cubic where both have a
    velocity, linear otherwise; the start always has both.
    """

    def __init__(self, start: Setpoint, begin: float, waypoints: Sequence[Waypoint]) -> None:
        """Raises UsageError as `check_waypoints` does, and if the first point is at 0 s and over 5 mm from `start`."""
        check_waypoints(waypoints)
        away = waypoints[0].position - start.position
        if waypoints[0].time == 0.0 and abs(away) > NEAR:
            raise UsageError(
                f"the trajectory begins at {waypoints[0].position:.4g} m, {abs(away):.3g} m away from the piston; "
                f"allowed is {NEAR:g} m; move the first point or give it a later time"
            )
        later = [point for point in waypoints if point.time > 0.0]
        self.begin = begin
        here = Waypoint(0.0, start.position, start.velocity, start.acceleration)
        self.pieces = [_piece(begin, one, two) for one, two in pairwise([here, *later])]
        self.end = self.pieces[-1].end if self.pieces else begin
        self.goal = waypoints[-1].position
        self._begins = [piece.begin for piece in self.pieces]
        self._first = start

    def __call__(self, time: float) -> Setpoint:
        """The setpoint at `time` [s]; the start before `begin`."""
        if time >= self.end:
            return Setpoint(self.goal)
        if time < self.begin:
            return self._first
        return self.pieces[bisect_right(self._begins, time) - 1](time)


def _piece(origin: float, one: Waypoint, two: Waypoint) -> Polynomial:
    begin, end = origin + one.time, origin + two.time
    if one.velocity is None or two.velocity is None:
        return linear(begin, end, one.position, two.position)
    first = Setpoint(one.position, one.velocity, one.acceleration or 0.0)
    last = Setpoint(two.position, two.velocity, two.acceleration or 0.0)
    smooth = one.acceleration is not None and two.acceleration is not None
    return (quintic if smooth else cubic)(begin, end, first, last)
