"""A probe in the role of one axis' manipulator stack: sends its messages, and gives the piston's position."""

import time
from collections.abc import Sequence
from typing import Any

from rclpy.qos import QoSProfile, ReliabilityPolicy
from ros.probe import RELIABLE, Probe
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pneumo_ros.control.model_law import REOPEN
from pneumo_ros.control.stops import WIDEST

TOLERANCE = 2e-4  # m, of the controller's cascade
ACCEPTED = REOPEN * 2**WIDEST * TOLERANCE  # m: 4.8 mm, at rest after many stops at wrong places
LATEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)  # a slow test must not read old messages


class AxisProbe(Probe):
    """Names are those of the contract; `joint` is the joint of this axis."""

    def __init__(self, namespace: str, joint: str = "piston") -> None:
        super().__init__(namespace, LATEST)
        self.joint = joint

    def publisher(self, kind: Any, topic: str, qos: QoSProfile = RELIABLE) -> Any:
        """A publisher with a subscriber."""
        key = f"{topic} {qos.reliability.name}"
        if key not in self._publishers:
            self._publishers[key] = self.node.create_publisher(kind, topic, qos)
            self.matched(self._publishers[key])
            time.sleep(0.3)  # a subscriber finds its publisher later than it is found
        return self._publishers[key]

    @property
    def position(self) -> float:
        """Position of the piston [m]."""
        return float(self.wait(lambda: self.heard["joint_states"], "a joint state")[-1].position[0])

    @property
    def speed(self) -> float:
        """Velocity of the piston [m/s]."""
        return abs(float(self.heard["joint_states"][-1].velocity[0]))

    @property
    def voltage(self) -> float:
        """The last command [V]."""
        return float(self.heard["valve/command"][-1].data)

    def arrives(self, position: float, within: float = ACCEPTED) -> None:
        """Wait until the piston rests there, as near as a law promises on a computer that is late."""
        self.wait(lambda: abs(self.position - position) < within and self.speed < 2e-3, f"rest at {position} m")

    def comes_to_rest(self) -> None:
        """Wait until the piston has moved less than a millimetre in 0.4 s."""

        def rested() -> bool:
            begin = self.position
            time.sleep(0.4)
            return abs(self.position - begin) < 1e-3

        self.wait(rested, "rest")

    def rests(self, seconds: float, within: float = 3e-3) -> None:
        """Fails if the piston moves in the next `seconds`."""
        begin, end = self.position, time.monotonic() + seconds
        while time.monotonic() < end:
            assert abs(self.position - begin) < within
            time.sleep(0.01)

    # --- what a stack sends -----------------------------------------------------------------------------------------

    def aim(self, position: float) -> None:
        """A position reference."""
        self.publisher(Float64, "position/reference").publish(Float64(data=position))

    def command_joints(
        self,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float] = (),
        qos: QoSProfile = RELIABLE,
    ) -> None:
        """A message of JointStateTopicSystem: all joints of its block, positions, and velocities if it has them."""
        message = JointState(name=list(names), position=list(positions), velocity=list(velocities))
        message.header.stamp = self.node.get_clock().now().to_msg()
        self.publisher(JointState, "joint_commands", qos).publish(message)

    def trajectory(self, points: Sequence[tuple[float, ...]], names: Sequence[str] = (), stamp: Any = None) -> None:
        """A trajectory of points (time, position, velocity, acceleration), or the first few of these.

        Each joint of `names` gets the same numbers.
        """
        message = JointTrajectory(joint_names=list(names or [self.joint]))
        for at, *numbers in points:
            point = JointTrajectoryPoint()
            point.time_from_start.sec, point.time_from_start.nanosec = divmod(round(at * 1e9), 1_000_000_000)
            for field, number in zip(("positions", "velocities", "accelerations"), numbers, strict=False):
                setattr(point, field, [number] * len(message.joint_names))
            message.points.append(point)
        if stamp is not None:
            message.header.stamp = stamp
        self.publisher(JointTrajectory, "joint_trajectory").publish(message)

    def supply(self, pressure: float) -> None:
        """The supply pressure as measured."""
        self.publisher(FluidPressure, "supply/pressure").publish(FluidPressure(fluid_pressure=pressure))
