"""Sends a sample: /clock, both pressures, the load cell if a force acts from outside, and the joint state at last.

A subscriber that has the joint state has the whole sample.
"""

from collections.abc import Sequence

from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState

from pneumo_ros.axis.simulator.sensors import Reading
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.records.contract import JOINT_STATES, LOAD_CELL
from pneumo_ros.records.corrections import Wiring
from pneumo_ros.ros import messages
from pneumo_ros.ros.qos import PUBLISH


class Outlet:
    """The publishers of the plant's sensors."""

    def __init__(self, node: Node, joint: str, clock: bool, wired: Wiring, chambers: Sequence[Chamber]) -> None:
        """`joint`: name of the joint; `clock`: whether to send /clock; `wired`: how the sensors of `chambers` are."""
        self._wired, self._plain = wired, wired == Wiring()
        self.joint_states = node.create_publisher(JointState, JOINT_STATES, PUBLISH)
        self._load_cell = node.create_publisher(JointState, LOAD_CELL, PUBLISH)
        self._load, self._loaded, self._before = messages.load_cell(joint), False, 0
        self._clock = node.create_publisher(Clock, "/clock", PUBLISH) if clock else None
        self._time = messages.clock()
        tube = f"{joint}_tube"  # the link in which urdf/cylinder.xacro has both chambers
        self._pressures = {
            one.field: (node.create_publisher(FluidPressure, one.topic, PUBLISH), messages.pressure(tube))
            for one in chambers
        }
        self._joint, self._joint_without_velocity = messages.joint_state(joint), messages.joint_state(joint, False)

    def send(self, simulation: Simulation, stamp: int) -> None:
        """Send the present reading with `stamp` [ns]."""
        reading, variance = simulation.reading, simulation.sensors.pressure_variance
        if not self._plain:
            reading, variance = self._shown(reading, simulation), variance / self._wired.unit**2
        if self._clock:
            self._clock.publish(self._time.fill(stamp))
        for field, (publisher, message) in self._pressures.items():
            publisher.publish(message.fill(stamp, getattr(reading, field), variance))
        if (load := simulation.load_cell) is not None:
            if not self._loaded:  # in a recording, nothing acts before the first force
                self._load_cell.publish(self._load.fill(self._before, 0.0))
            self._loaded = True
            self._load_cell.publish(self._load.fill(stamp, load))
        self._before = stamp
        if reading.velocity is None:
            message = self._joint_without_velocity.fill(stamp, reading.position, simulation.effort)
        else:
            message = self._joint.fill(stamp, reading.position, reading.velocity, simulation.effort)
        self.joint_states.publish(message)

    def _shown(self, true: Reading, simulation: Simulation) -> Reading:
        """The reading in the units, with the zeros, signs and plugs of the rig that is played."""
        wired, atmosphere = self._wired, simulation.model["air.atmospheric_pressure"]
        pressures = wired.shown_pressures(true.pressure_a, true.pressure_b, atmosphere)
        velocity = None if true.velocity is None else wired.way * true.velocity / wired.length
        return Reading(wired.shown_position(true.position), velocity, *pressures)
