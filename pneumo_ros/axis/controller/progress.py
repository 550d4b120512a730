"""Progress of a trajectory that an action client waits for. No ROS in here."""

import math
from typing import NamedTuple

from pneumo_ros.control.motion import Motion, Trajectory

# control_msgs/action/FollowJointTrajectory, error_code
SUCCESSFUL, INVALID_GOAL, PATH_TOLERANCE_VIOLATED, GOAL_TOLERANCE_VIOLATED = 0, -1, -4, -5


class Verdict(NamedTuple):
    """How a trajectory ended: code of the action's result, and the reason."""

    code: int
    reason: str


class Progress:
    """Watches one trajectory until it is done.

    At its end the piston has `patience` [s] to come within `goal_tolerance` [m]; on the way it may not be more than
    `path_tolerance` [m] off.
    """

    def __init__(
        self, trajectory: Trajectory, goal_tolerance: float, path_tolerance: float = math.inf, patience: float = 2.0
    ) -> None:
        self.trajectory, self._goal, self._path, self._patience = trajectory, goal_tolerance, path_tolerance, patience

    def verdict(self, time: float, position: float, motion: Motion) -> Verdict | None:
        """How it ended, None while it goes on; at loop time `time` [s], with the piston at `position` [m]."""
        if not motion.follows(self.trajectory):
            return Verdict(PATH_TOLERANCE_VIOLATED, motion.reason or "another motion was requested")
        error = self.trajectory(time).position - position
        if time < self.trajectory.end:
            if abs(error) > self._path and time >= self.trajectory.begin:
                return Verdict(PATH_TOLERANCE_VIOLATED, f"{abs(error):.3g} m off on the way, allowed is {self._path:g}")
            return None
        if abs(error) <= self._goal:
            return Verdict(SUCCESSFUL, "")
        if time < self.trajectory.end + self._patience:
            return None
        return Verdict(
            GOAL_TOLERANCE_VIOLATED,
            f"{abs(error):.3g} m from the goal {self._patience:g} s after the end, allowed is {self._goal:g}",
        )
