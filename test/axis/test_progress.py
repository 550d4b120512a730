"""The end of a trajectory that a client waits for."""

from pneumo_ros.axis.controller.progress import (
    GOAL_TOLERANCE_VIOLATED,
    PATH_TOLERANCE_VIOLATED,
    SUCCESSFUL,
    Progress,
)
from pneumo_ros.control import Setpoint
from pneumo_ros.control.motion import Limits, Motion, Trajectory, Waypoint


def begun() -> tuple[Motion, Trajectory]:
    """A trajectory of 2 s to 0.1 m, under way."""
    motion = Motion(Limits())
    trajectory = Trajectory(Setpoint(0.0), 0.0, [Waypoint(2.0, 0.1, 0.0)])
    motion.follow(trajectory, 0.0)
    return motion, trajectory


def test_near_the_goal_at_the_end_is_success_and_not_before() -> None:
    motion, trajectory = begun()
    progress = Progress(trajectory, 0.003)
    assert progress.verdict(1.0, 0.05, motion) is None
    assert progress.verdict(2.0, 0.09, motion) is None
    found = progress.verdict(2.5, 0.098, motion)
    assert found is not None
    assert found.code == SUCCESSFUL


def test_patience_ends() -> None:
    motion, trajectory = begun()
    found = Progress(trajectory, 0.003).verdict(4.1, 0.09, motion)
    assert found is not None
    assert found.code == GOAL_TOLERANCE_VIOLATED
    assert found.reason == "0.01 m from the goal 2 s after the end, allowed is 0.003"


def test_the_path_may_be_watched() -> None:
    motion, trajectory = begun()
    assert Progress(trajectory, 0.003).verdict(1.0, 0.02, motion) is None
    found = Progress(trajectory, 0.003, path_tolerance=0.01).verdict(1.0, 0.02, motion)
    assert found is not None
    assert found.code == PATH_TOLERANCE_VIOLATED


def test_giving_up_is_reported() -> None:
    motion, trajectory = begun()
    motion.at(1.0, -0.1)
    found = Progress(trajectory, 0.003).verdict(1.0, -0.1, motion)
    assert found is not None
    assert found.code == PATH_TOLERANCE_VIOLATED
    assert "the piston is -0.15 m off" in found.reason
    motion, trajectory = begun()
    motion.aim(0.05, None, 1.0, 0.05)
    found = Progress(trajectory, 0.003).verdict(1.1, 0.05, motion)
    assert found is not None
    assert found.reason == "another motion was requested"
