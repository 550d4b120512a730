"""Whether a trajectory can be followed, said with numbers; and how much slower it would have to be."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from pneumo_ros.control.motion.capability import Capability
from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.motion.trajectory import Trajectory
from pneumo_ros.control.motion.waypoint import Waypoint
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.errors import UsageError

BETWEEN = 8  # places looked at between two turning points: the force may be largest anywhere
SLOWEST = 100.0  # what would have to be slower than that is refused
BISECTIONS = 20  # of the factor


def require(trajectory: Trajectory, limits: Limits, capability: Capability) -> None:
    """Raise UsageError, with the worst place in numbers, unless `trajectory` stays within the positions of `limits`
    and needs no more speed and force than there is.
    """
    seen = list(_places(trajectory))
    time, wanted = max(seen, key=lambda place: abs(place[1].position - limits.clip(place[1].position)))
    if abs(wanted.position - limits.clip(wanted.position)) > 1e-9:
        raise UsageError(
            f"the trajectory is at {wanted.position:.4g} m after {time - trajectory.begin:.3g} s, outside "
            f"{limits.low:g} to {limits.high:g} m"
        )
    time, wanted = max(seen, key=lambda place: capability.shortfall(place[1]))
    if capability.shortfall(wanted) > 0.0:
        raise UsageError(_beyond(time - trajectory.begin, wanted, capability))


def slowed(
    start: Setpoint, begin: float, waypoints: Sequence[Waypoint], limits: Limits, capability: Capability
) -> tuple[Trajectory, float]:
    """The trajectory through `waypoints`, as much slower as it must be, and the factor on its times, 1 or more.

    Raises UsageError as `require` does where slowing does not help, as with positions outside the limits.
    """
    if _fits(start, begin, waypoints, 1.0, limits, capability):
        return Trajectory(start, begin, waypoints), 1.0
    require(_stretched(start, begin, waypoints, SLOWEST), limits, capability)
    quick, slow = 1.0, SLOWEST
    for _ in range(BISECTIONS):
        middle = (quick * slow) ** 0.5
        if _fits(start, begin, waypoints, middle, limits, capability):
            slow = middle
        else:
            quick = middle
    return _stretched(start, begin, waypoints, slow), slow


def _stretched(start: Setpoint, begin: float, waypoints: Sequence[Waypoint], factor: float) -> Trajectory:
    return Trajectory(start, begin, [point.slowed(factor) for point in waypoints])


def _fits(
    start: Setpoint,
    begin: float,
    waypoints: Sequence[Waypoint],
    factor: float,
    limits: Limits,
    capability: Capability,
) -> bool:
    try:
        require(_stretched(start, begin, waypoints, factor), limits, capability)
    except UsageError:
        return False
    return True


def _places(trajectory: Trajectory) -> Iterator[tuple[float, Setpoint]]:
    """Times and setpoints wherever one of their numbers may be extreme, and between."""
    yield trajectory.end, trajectory(trajectory.end)
    for piece in trajectory.pieces:
        times = np.unique(list(piece.extremes()))
        for one, two in pairwise(times):
            for time in np.linspace(one, two, BETWEEN):
                yield float(time), piece(float(time))


def _beyond(time: float, wanted: Setpoint, capability: Capability) -> str:
    """Why a setpoint cannot be followed."""
    side = 1.0 if wanted.velocity >= 0.0 else -1.0
    top = capability.top_speed(side)
    what = f"after {time:.3g} s the trajectory wants "
    at = f"at a supply pressure of {capability.supply:.3g} Pa"
    if abs(wanted.velocity) > top:
        return f"{what}{wanted.velocity:.3g} m/s; the piston reaches {side * top:.3g} m/s {at}"
    return (
        f"{what}{wanted.acceleration:.3g} m/s2 at {wanted.velocity:.3g} m/s, "
        f"{capability.shortfall(wanted):.3g} N more than there is {at}"
    )
