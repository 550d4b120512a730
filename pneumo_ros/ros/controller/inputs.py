"""The topics that set the target of the piston."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory

from pneumo_ros.control.motion import Trajectory
from pneumo_ros.errors import UsageError
from pneumo_ros.records.contract import SUPPLY_PRESSURE
from pneumo_ros.ros import readers
from pneumo_ros.ros.controller.requests import nanoseconds, waypoints_of
from pneumo_ros.ros.qos import RELIABLE, SUBSCRIBE

if TYPE_CHECKING:
    from pneumo_ros.ros.controller.node import Controller

REFERENCE, TRAJECTORY, COMMANDS = "position/reference", "joint_trajectory", "joint_commands"
QUIET = 5.0  # s between two warnings of one kind of stream


class Inputs:
    """Subscriptions of a controller. Refused messages are counted, and logged with the reason."""

    def __init__(self, node: "Controller", joint: str) -> None:
        """Move `joint`; other joints in the same messages are ignored."""
        self._node, self._joint = node, joint
        self.refused = ""  # the last refusal, with its reason
        self._complained: dict[str, float] = {}  # kind of input -> when the log last reported it [s]
        self._commands = readers.JointReader(joint, whole=True)
        node.create_subscription(Float64, REFERENCE, self._reference, RELIABLE)
        node.create_subscription(JointTrajectory, TRAJECTORY, self._trajectory, RELIABLE)
        node.create_subscription(JointState, COMMANDS, self._command, RELIABLE, raw=True)
        node.create_subscription(FluidPressure, SUPPLY_PRESSURE, self._supply, SUBSCRIBE)

    def follow(self, message: JointTrajectory) -> tuple[Trajectory, float]:
        """Start a trajectory; returns it and its slow-down factor. Raises UsageError if it is refused."""
        node = self._node
        stamp = nanoseconds(message.header.stamp)
        delay = (stamp - node.stamp_now()) * 1e-9 if stamp else 0.0
        begun = node.loop.guide.follow(waypoints_of(message, self._joint), delay, node.loop_now())
        if begun[1] > 1.0:
            node.get_logger().info(f"trajectory slowed down {begun[1]:.3g} times")
        return begun

    def _reference(self, message: Float64) -> None:
        self._try("reference", lambda: self._aim(message.data, None))

    def _aim(self, position: float, velocity: float | None) -> None:
        if self._node.loop.guide.built_in is None:
            self._node.loop.guide.aim(position, velocity, self._node.loop_now())

    def _trajectory(self, message: JointTrajectory) -> None:
        if message.points:
            self._try("trajectory", lambda: self.follow(message))
        else:  # by convention of the joint_trajectory_controller: stop here
            self._try("trajectory", lambda: self._node.loop.guide.halt(self._node.loop_now()))

    def _command(self, data: bytes) -> None:
        sample = self._commands.read(data)
        if sample is not None:
            self._try("joint command", lambda: self._aim(sample.position, sample.velocity))
        elif self._joint in self._commands.names(data):
            self._try("joint command", _ambiguous)

    def _supply(self, message: FluidPressure) -> None:
        guide = self._node.loop.guide
        before = guide.supply.lost
        pressure = self._node.absolute(message.fluid_pressure)
        self._try("supply pressure", lambda: guide.supplied(pressure, self._node.loop_now()))
        if guide.supply.lost and not before:
            self._node.get_logger().error(f"supply pressure lost, {guide.supply.pressure:.4g} Pa: {self._node.closing}")
        elif before and not guide.supply.lost:
            self._node.get_logger().info("supply pressure is back; the piston stays until a new target arrives")

    def _try(self, what: str, act: Callable[[], object]) -> None:
        try:
            act()
        except UsageError as error:
            self._node.loop.refused += 1
            self.refused = f"{what} refused: {error}"
            self._complain(what)

    def _complain(self, what: str) -> None:
        """Log a refusal: every one of a trajectory, but of a stream, which would fill the log, only each QUIET s."""
        now = time.monotonic()
        if what == "trajectory" or now - self._complained.get(what, -QUIET) >= QUIET:
            self._complained[what] = now
            self._node.get_logger().warning(self.refused)


def _ambiguous() -> None:
    raise UsageError("there are fewer positions than names; use one <ros2_control> block for each cylinder")
