"""Trajectory messages as waypoints of one joint."""

from collections.abc import Sequence

import pytest
from builtin_interfaces.msg import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pneumo_ros.control.motion import Waypoint
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.controller.requests import waypoints_of


def point(**numbers: Sequence[float]) -> JointTrajectoryPoint:
    """A point after 1.5 s."""
    return JointTrajectoryPoint(time_from_start=Duration(sec=1, nanosec=500_000_000), **numbers)


def test_the_joint_is_found_by_name() -> None:
    message = JointTrajectory(joint_names=["boom", "piston"])
    message.points = [
        point(positions=[9.0, 0.1]),
        point(positions=[9.0, 0.2], velocities=[9.0, 0.3], accelerations=[9.0, 0.4]),
    ]
    assert waypoints_of(message, "piston") == [Waypoint(1.5, 0.1), Waypoint(1.5, 0.2, 0.3, 0.4)]


@pytest.mark.parametrize("names", [[], ["boom"], ["piston", "piston"]])
def test_a_joint_that_is_missing_or_there_twice(names: list[str]) -> None:
    with pytest.raises(UsageError, match="this controller moves joint 'piston'"):
        waypoints_of(JointTrajectory(joint_names=names), "piston")


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({}, "0 positions for 2 joints"),
        ({"positions": [0.1]}, "1 positions for 2 joints"),
        ({"positions": [0.1, 0.2], "velocities": [0.1]}, "1 velocities for 2 joints"),
        ({"positions": [0.1, 0.2], "accelerations": [0.1, 0.2, 0.3]}, "3 accelerations for 2 joints"),
    ],
)
def test_arrays_of_another_length_are_refused(numbers: dict[str, list[float]], words: str) -> None:
    message = JointTrajectory(joint_names=["boom", "piston"], points=[point(**numbers)])
    with pytest.raises(UsageError, match=words):
        waypoints_of(message, "piston")
