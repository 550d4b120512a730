"""The way to a target within limits of speed, acceleration and jerk, from any motion."""

from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.motion.phases import Phase, end, moved, velocity_change
from pneumo_ros.control.setpoint import Setpoint

BISECTIONS = 40  # of the cruising speed: to a part in 1e12
RESERVE = 0.95  # largest share of the speed limit that a moving target may use


class Profile:
    """Reference that leads from `start` at time `begin` [s] to `target` [m] within `limits`, and stays there.

    The velocity changes to a cruising speed, is kept, and changes to that of the target, each change as in
    `velocity_change`. For a target that moves at `drift` [m/s] the same is computed relative to it, with other limits
    of speed. If the start leaves no other way, the profile passes the target and comes back.
    """

    def __init__(self, start: Setpoint, begin: float, target: float, limits: Limits, drift: float = 0.0) -> None:
        """`drift` beyond 95 % of the speed limit counts as 95 %."""
        reach = RESERVE * limits.speed
        self.begin, self.target, self.drift = begin, target, min(max(drift, -reach), reach)
        self._limits = limits
        phases = self._solve(start)
        self._starts: list[tuple[float, Setpoint, float]] = []
        time, state = begin, start
        for phase in phases:
            if phase.duration > 0.0:
                self._starts.append((time, state, phase.jerk))
                time, state = time + phase.duration, moved(state, phase.jerk, phase.duration)
        self.end = time

    def __call__(self, time: float) -> Setpoint:
        """The setpoint at `time` [s]; the first one before `begin`."""
        if time >= self.end or not self._starts:
            return Setpoint(self.target + self.drift * (time - self.begin), self.drift)
        for start, state, jerk in reversed(self._starts):
            if time >= start:
                return moved(state, jerk, time - start)
        return self._starts[0][1]

    def _solve(self, start: Setpoint) -> tuple[Phase, ...]:
        seen = Setpoint(0.0, start.velocity - self.drift, start.acceleration)  # from the moving target
        distance = self.target - start.position
        side = 1.0 if distance >= end(seen, self._change(seen, 0.0)).position else -1.0
        fastest = side * self._limits.speed - self.drift
        beyond = side * (distance - end(seen, self._both(seen, fastest)).position)
        if beyond >= 0.0:
            first, last = self._change(seen, fastest), self._change(Setpoint(0.0, fastest), 0.0)
            return (*first, Phase(beyond / abs(fastest), 0.0), *last)
        return self._both(seen, self._cruise(seen, distance, fastest))

    def _cruise(self, seen: Setpoint, distance: float, fastest: float) -> float:
        """The cruising speed that leads exactly to the wanted distance."""
        side = 1.0 if fastest > 0.0 else -1.0
        near, far = 0.0, fastest
        kept = seen.velocity
        if 0.0 < side * kept < side * fastest and side * (end(seen, self._both(seen, kept)).position - distance) <= 0.0:
            near = kept  # rather go on than brake twice
        for _ in range(BISECTIONS):
            middle = 0.5 * (near + far)
            if side * (end(seen, self._both(seen, middle)).position - distance) <= 0.0:
                near = middle
            else:
                far = middle
        return near

    def _both(self, seen: Setpoint, cruise: float) -> tuple[Phase, ...]:
        return (*self._change(seen, cruise), *self._change(Setpoint(0.0, cruise), 0.0))

    def _change(self, start: Setpoint, velocity: float) -> tuple[Phase, ...]:
        return velocity_change(start, velocity, self._limits.acceleration, self._limits.jerk)


def braking(start: Setpoint, begin: float, limits: Limits) -> Profile:
    """The quickest way to rest within `limits`, as a profile to its end."""
    phases = velocity_change(start, 0.0, limits.acceleration, limits.jerk)
    return Profile(start, begin, end(start, phases).position, limits)
