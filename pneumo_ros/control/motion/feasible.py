"""Whether a trajectory can be followed, with numbers; and how much slower it would have to be."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.control.motion.capability import Capability
from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.motion.trajectory import Trajectory
from pneumo_ros.control.motion.waypoint import Waypoint
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.errors import UsageError

GRID = np.linspace(0.0, 1.0, 65)  # places checked on each piece, beside its turning points
SLOWEST = 100.0  # largest factor on times; a trajectory that needs more is refused
FINER = 1.2  # ratio of two factors that are tried
BISECTIONS = 16  # of the factor, to a part in 1e4
Array = NDArray[np.float64]


def require(trajectory: Trajectory, limits: Limits, capability: Capability) -> None:
    """Raise UsageError, with the worst place in numbers, unless `trajectory` stays within the positions of `limits`
    and needs no more speed and force than the machine has.
    """
    time, position, velocity, acceleration = _places(trajectory)
    outside = abs(position - position.clip(limits.low, limits.high))
    worst = int(outside.argmax())
    if outside[worst] > 1e-9:
        raise UsageError(
            f"the trajectory is at {position[worst]:.4g} m after {time[worst]:.3g} s, outside "
            f"{limits.low:g} to {limits.high:g} m"
        )
    lacking = capability.shortfall(velocity, acceleration)
    worst = int(lacking.argmax())
    if lacking[worst] > 0.0:
        raise UsageError(
            f"after {time[worst]:.3g} s the trajectory "
            + _beyond(float(velocity[worst]), float(acceleration[worst]), float(lacking[worst]), capability)
        )


def slowed(
    start: Setpoint, begin: float, waypoints: Sequence[Waypoint], limits: Limits, capability: Capability
) -> tuple[Trajectory, float]:
    """The trajectory through `waypoints`, slowed as far as necessary, and the factor on its times, 1 or more.

    Raises UsageError as `require` does where slowing does not help, as with positions outside the limits.
    """
    wanted = Trajectory(start, begin, waypoints)
    if _fits(wanted, limits, capability):
        return wanted, 1.0
    factor = _factor(wanted, capability)
    while not _fits(found := _stretched(start, begin, waypoints, factor), limits, capability):
        factor *= FINER
        if factor > SLOWEST:
            require(wanted, limits, capability)  # raises with the reason
    return found, factor


def _factor(wanted: Trajectory, capability: Capability) -> float:
    """The factor on times that leaves enough force if the trajectory starts at rest; else it may need more."""
    _, _, velocity, acceleration = _places(wanted)
    quick, slow = 1.0, SLOWEST
    for _ in range(BISECTIONS):
        middle = (quick * slow) ** 0.5
        if capability.shortfall(velocity / middle, acceleration / middle**2).max() > 0.0:
            quick = middle
        else:
            slow = middle
    return slow


def _stretched(start: Setpoint, begin: float, waypoints: Sequence[Waypoint], factor: float) -> Trajectory:
    return Trajectory(start, begin, [point.slowed(factor) for point in waypoints])


def _fits(trajectory: Trajectory, limits: Limits, capability: Capability) -> bool:
    try:
        require(trajectory, limits, capability)
    except UsageError:
        return False
    return True


def _places(trajectory: Trajectory) -> tuple[Array, Array, Array, Array]:
    """Times since the begin, positions, velocities, accelerations (places,), the extreme ones among them.

    Turning points are where velocity or acceleration changes its sign, by linear interpolation on the grid.
    """
    if not trajectory.pieces:
        return np.zeros(1), np.array([trajectory.goal]), np.zeros(1), np.zeros(1)
    begins = np.array([[piece.begin - trajectory.begin] for piece in trajectory.pieces])
    times = np.array([[piece.end - piece.begin] for piece in trajectory.pieces]) * GRID
    coefficients = np.array([piece.coefficients for piece in trajectory.pieces])
    found = [_at(coefficients, begins, times)]
    for rates in found[0][2:]:
        piece, place = np.nonzero(rates[:, :-1] * rates[:, 1:] < 0.0)
        one, two = rates[piece, place], rates[piece, place + 1]
        turning = times[piece, place] + (times[piece, place + 1] - times[piece, place]) * one / (one - two)
        found.append(_at(coefficients[piece], begins[piece], turning[:, None]))
    time, position, velocity, acceleration = (np.concatenate([rows[k].ravel() for rows in found]) for k in range(4))
    return time, position, velocity, acceleration


def _at(coefficients: Array, begins: Array, times: Array) -> tuple[Array, Array, Array, Array]:
    """Times, positions, velocities, accelerations (pieces, places) of polynomials (pieces, 6)."""
    powers = coefficients.T[:, :, None]
    values = [np.zeros_like(times) for _ in range(3)]
    for order, value in enumerate(values):
        for k in range(5, order - 1, -1):
            value *= times
            value += math.perm(k, order) * powers[k]
    return begins + times, values[0], values[1], values[2]


def _beyond(velocity: float, acceleration: float, lacking: float, capability: Capability) -> str:
    """Why a motion cannot be followed."""
    side = 1.0 if velocity >= 0.0 else -1.0
    top = capability.top_speed(side)
    at = f"at a supply pressure of {capability.supply:.3g} Pa"
    if abs(velocity) > top:
        return f"wants {velocity:.3g} m/s; the piston reaches {side * top:.3g} m/s {at}"
    return f"wants {acceleration:.3g} m/s2 at {velocity:.3g} m/s, {lacking:.3g} N more than is available {at}"
