"""Sends a sample: /clock, both pressures, then the joint state, with which a subscriber has the whole sample."""

from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState

from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.records.contract import JOINT_STATES, PRESSURE_A, PRESSURE_B
from pneumo_ros.ros import messages
from pneumo_ros.ros.qos import PUBLISH


class Outlet:
    """The publishers of the plant's sensors."""

    def __init__(self, node: Node, joint: str, clock: bool) -> None:
        """`joint`: name of the joint; `clock`: whether to send /clock."""
        self.joint_states = node.create_publisher(JointState, JOINT_STATES, PUBLISH)
        self._pressure_a = node.create_publisher(FluidPressure, PRESSURE_A, PUBLISH)
        self._pressure_b = node.create_publisher(FluidPressure, PRESSURE_B, PUBLISH)
        self._clock = node.create_publisher(Clock, "/clock", PUBLISH) if clock else None
        self._time = messages.clock()
        self._a, self._b = messages.pressure("chamber_a"), messages.pressure("chamber_b")
        self._joint, self._joint_without_velocity = messages.joint_state(joint), messages.joint_state(joint, False)

    def send(self, simulation: Simulation, stamp: int) -> None:
        """Send the present reading with `stamp` [ns]."""
        reading, variance = simulation.reading, simulation.sensors.pressure_variance
        if self._clock:
            self._clock.publish(self._time.fill(stamp))
        self._pressure_a.publish(self._a.fill(stamp, reading.pressure_a, variance))
        self._pressure_b.publish(self._b.fill(stamp, reading.pressure_b, variance))
        if reading.velocity is None:
            message = self._joint_without_velocity.fill(stamp, reading.position, simulation.effort)
        else:
            message = self._joint.fill(stamp, reading.position, reading.velocity, simulation.effort)
        self.joint_states.publish(message)
