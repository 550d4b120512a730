"""Trajectories: the interpolation of the contract, and points that are slowed or refused with numbers."""

import math

import numpy as np
import pytest

from pneumo_ros.control import Machine, Setpoint, ValveInverse
from pneumo_ros.control.motion import Capability, Limits, Trajectory, Waypoint, ahead, require, slowed
from pneumo_ros.errors import UsageError

ABLE = Capability(Machine(), ValveInverse())
LIMITS = Limits()
REST = Setpoint(0.0)


def test_linear_without_velocities() -> None:
    motion = Trajectory(REST, 10.0, [Waypoint(1.0, 0.1), Waypoint(3.0, 0.0)])
    assert motion(10.5)[:2] == pytest.approx((0.05, 0.1))
    assert motion(12.0)[:2] == pytest.approx((0.05, -0.05))
    assert motion(13.0) == motion(99.0) == Setpoint(0.0)


def test_cubic_with_velocities() -> None:
    """The Hermite cubic: x = 3 s^2 - 2 s^3 from rest to rest."""
    motion = Trajectory(REST, 0.0, [Waypoint(2.0, 0.1, 0.0)])
    for s in np.linspace(0.0, 1.0, 7)[:-1]:
        wanted = (0.1 * (3 * s**2 - 2 * s**3), 0.1 * 6 * s * (1 - s) / 2.0, 0.1 * (6 - 12 * s) / 4.0)
        assert motion(2.0 * s)[:3] == pytest.approx(wanted)


def test_quintic_with_accelerations() -> None:
    """The minimum-jerk polynomial: x = 10 s^3 - 15 s^4 + 6 s^5 from rest to rest."""
    motion = Trajectory(REST, 0.0, [Waypoint(2.0, 0.1, 0.0, 0.0)])
    for s in np.linspace(0.0, 1.0, 7)[:-1]:
        assert motion(2.0 * s).position == pytest.approx(0.1 * (10 * s**3 - 15 * s**4 + 6 * s**5))


def test_positions_velocities_and_accelerations_are_met_at_every_point() -> None:
    start = Setpoint(0.01, 0.02, 0.1)
    points = [Waypoint(1.0, 0.05, 0.03, -0.2), Waypoint(1.7, 0.06, -0.01, 0.1), Waypoint(2.0, 0.05, 0.0, 0.0)]
    motion = Trajectory(start, 5.0, points)
    assert motion(5.0)[:3] == pytest.approx(start[:3])
    for point in points:
        for time in (5.0 + point.time - 1e-9, 5.0 + point.time):
            assert motion(time)[:3] == pytest.approx(point[1:], abs=1e-6)


def test_points_whose_time_is_over_are_left_out() -> None:
    points = [Waypoint(1.0, 0.1, 0.1), Waypoint(3.0, 0.3, 0.0)]
    assert ahead(points, 1.5) == [Waypoint(1.5, 0.3, 0.0)]
    assert ahead(points, 0.0) == points
    with pytest.raises(UsageError, match=r"ended 2 s ago"):
        ahead(points, 5.0)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([], "no points"),
        ([Waypoint(1.0, math.nan)], "point 1 .* not finite"),
        ([Waypoint(1.0, 0.1, math.inf)], "not finite"),
        ([Waypoint(1.0, 0.1), Waypoint(1.0, 0.2)], "point 2 .* not after the one at 1 s"),
        ([Waypoint(-1.0, 0.1)], "before its start"),
        ([Waypoint(1.0, 0.1, 0.05)], "ends at 0.05 m/s"),
        ([Waypoint(0.0, 0.1), Waypoint(1.0, 0.2)], "0.1 m away from the piston"),
    ],
)
def test_what_is_no_trajectory(points: list[Waypoint], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        Trajectory(REST, 0.0, points)


def test_the_stroke_is_kept_between_points_too() -> None:
    """Both points lie within the stroke, the cubic between them does not."""
    bold = Trajectory(Setpoint(0.95), 0.0, [Waypoint(2.0, 0.98, -0.1), Waypoint(4.0, 0.9, 0.0)])
    peak = max(bold(time).position for time in np.linspace(0.0, 4.0, 4001))
    assert peak > 1.0
    with pytest.raises(UsageError, match=rf"at {peak:.4g} m after .* outside -1 to 1 m"):
        require(bold, LIMITS, ABLE)
    require(Trajectory(Setpoint(0.95), 0.0, [Waypoint(2.0, 1.0, 0.0)]), LIMITS, ABLE)


def test_what_the_supply_cannot_do_is_refused_with_numbers() -> None:
    """0.147 m/s is the top speed of retraction (steady speeds of the model), and 0.15 m/s the peak of this cubic."""
    there = Trajectory(REST, 0.0, [Waypoint(1.0, 0.1, 0.0)])
    back = Trajectory(REST, 0.0, [Waypoint(1.0, -0.1, 0.0)])
    require(there, LIMITS, ABLE)
    with pytest.raises(UsageError, match=r"wants -0.15 m/s; the piston reaches -0.147 m/s at .* 7e\+05 Pa"):
        require(back, LIMITS, ABLE)
    with pytest.raises(UsageError, match=r"m/s2 at .* N more than is available"):
        require(Trajectory(REST, 0.0, [Waypoint(0.008, 0.0006, 0.0)]), LIMITS, ABLE)


def test_it_is_slowed_as_much_as_it_must_be() -> None:
    points = [Waypoint(1.0, -0.1, 0.0), Waypoint(2.0, 0.0, 0.0)]
    motion, factor = slowed(REST, 0.0, points, LIMITS, ABLE)
    assert 1.0 < factor < 1.1
    require(motion, LIMITS, ABLE)
    assert motion.end == pytest.approx(2.0 * factor)
    hardly = [point.slowed(0.995 * factor) for point in points]
    with pytest.raises(UsageError):
        require(Trajectory(REST, 0.0, hardly), LIMITS, ABLE)
    assert slowed(REST, 0.0, [point.slowed(2.0) for point in points], LIMITS, ABLE)[1] == 1.0
    with pytest.raises(UsageError, match="outside"):
        slowed(REST, 0.0, [Waypoint(1.0, 1.2, 0.0)], LIMITS, ABLE)
