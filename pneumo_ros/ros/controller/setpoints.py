"""The topic `setpoint`: the controller's present setpoint, for plots and recordings."""

import math

from rclpy.node import Node
from sensor_msgs.msg import JointState

from pneumo_ros.control import Setpoint
from pneumo_ros.records.contract import SETPOINT
from pneumo_ros.ros import messages
from pneumo_ros.ros.qos import PUBLISH

PERIOD = 0.01  # s; at the rate of measurements they would cost as much as the commands


class Setpoints:
    """Publishes position and velocity of setpoints, at most every 10 ms."""

    def __init__(self, node: Node, joint: str) -> None:
        """Setpoints of `joint`."""
        self._publisher = node.create_publisher(JointState, SETPOINT, PUBLISH)
        self._message = messages.joint_state(joint, effort=False)
        self._told = -math.inf

    def tell(self, wanted: Setpoint | None, time: float, stamp: int) -> None:
        """The setpoint at loop time `time` [s], stamped `stamp` [ns]."""
        if wanted is not None and time - self._told >= PERIOD:
            self._told = time
            self._publisher.publish(self._message.fill(stamp, wanted.position, wanted.velocity))
