"""~/follow_joint_trajectory, where control_msgs is installed."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rclpy.action import ActionServer, CancelResponse
from rclpy.task import Future

from pneumo_ros.axis.controller.progress import INVALID_GOAL, SUCCESSFUL, Progress, Verdict
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.controller.requests import nanoseconds

try:  # there are no wheels of it; it comes with a ROS 2 distribution
    from control_msgs.action import FollowJointTrajectory
except ImportError:
    FollowJointTrajectory = None

if TYPE_CHECKING:
    from pneumo_ros.ros.controller.node import Controller

PERIOD = 0.05  # s between two looks at the progress, and between two messages of feedback
PATIENCE = 2.0  # s for the goal to be reached after its time, where the request names none


class Following:
    """The action server. A goal is refused by its result, which says why; a new goal replaces the one before."""

    def __init__(self, node: "Controller", action: Any) -> None:
        """`action` is FollowJointTrajectory, or a type with the same fields."""
        self._node, self._type = node, action
        self._server = ActionServer(
            node, action, "~/follow_joint_trajectory", self._execute, cancel_callback=lambda goal: CancelResponse.ACCEPT
        )

    async def _execute(self, goal: Any) -> Any:
        loop = self._node.loop
        try:
            trajectory, _ = self._node.inputs.follow(goal.request.trajectory)
        except UsageError as error:
            self._node.get_logger().warning(f"goal refused: {error}")
            return self._result(goal, Verdict(INVALID_GOAL, str(error)))
        progress = self._progress(goal.request, trajectory)
        while True:
            await self._pause()
            if goal.is_cancel_requested:
                if loop.guide.motion.follows(trajectory):
                    loop.guide.halt(self._node.loop_now())
                goal.canceled()
                return self._type.Result(error_code=SUCCESSFUL, error_string="canceled")
            assert loop.guide.position is not None
            verdict = progress.verdict(self._node.loop_now(), loop.guide.position, loop.guide.motion)
            if verdict is not None:
                return self._result(goal, verdict)
            self._tell(goal)

    def _progress(self, request: Any, trajectory: Any) -> Progress:
        name, usual = self._node.parameters["joint_name"], self._node.parameters["goal_tolerance"]
        goal = tolerance(request.goal_tolerance, name, usual)
        path = tolerance(request.path_tolerance, name, math.inf)
        return Progress(trajectory, goal, path, nanoseconds(request.goal_time_tolerance) * 1e-9 or PATIENCE)

    async def _pause(self) -> None:
        future: Future = Future()
        timer = self._node.create_timer(PERIOD, lambda: future.done() or future.set_result(None))
        try:
            await future
        finally:
            self._node.destroy_timer(timer)

    def _result(self, goal: Any, verdict: Verdict) -> Any:
        (goal.succeed if verdict.code == SUCCESSFUL else goal.abort)()
        return self._type.Result(error_code=verdict.code, error_string=verdict.reason)

    def _tell(self, goal: Any) -> None:
        wanted, position = self._node.loop.wanted, self._node.loop.guide.position
        feedback = self._type.Feedback()
        feedback.header.stamp = self._node.get_clock().now().to_msg()
        feedback.joint_names = [self._node.parameters["joint_name"]]
        if wanted is not None and position is not None:
            feedback.desired.positions, feedback.desired.velocities = [wanted.position], [wanted.velocity]
            feedback.actual.positions = [position]
            feedback.error.positions = [wanted.position - position]
        goal.publish_feedback(feedback)


def tolerance(given: Sequence[Any], joint: str, usual: float) -> float:
    """Tolerance of position [m] of `joint` among JointTolerance messages: 0 means the `usual` one, -1 means any."""
    found = next((one.position for one in given if one.name == joint), 0.0)
    return math.inf if found < 0.0 else found or usual
