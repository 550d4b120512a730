"""Topics between a coupled simulator and the one that moves its rod: a state in, sensor readings and a force out."""

from typing import TYPE_CHECKING

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

from pneumo_ros.axis.simulator.coupled import Coupled
from pneumo_ros.errors import PneumoError
from pneumo_ros.records.contract import COUPLED, COUPLED_EFFORT, COUPLED_MASS
from pneumo_ros.ros import readers
from pneumo_ros.ros.qos import PUBLISH, RELIABLE

if TYPE_CHECKING:
    from pneumo_ros.ros.simulator.node import Simulator

PAUSE = 5.0  # s between two warnings from one line


class Coupling:
    """Every new state of the rod is answered with one effort; states of a time that was answered are not."""

    def __init__(self, node: "Simulator", simulation: Coupled) -> None:
        """Subscribe; the joint is that of the parameter joint_name."""
        self._node, self._simulation, self._log = node, simulation, node.get_logger()
        self._reader, self._stamp = readers.JointReader(node.parameters["joint_name"]), 0
        self._effort = node.create_publisher(Float64MultiArray, COUPLED_EFFORT, PUBLISH)
        node.create_subscription(JointState, COUPLED, self._state, RELIABLE, raw=True)
        node.create_subscription(Float64, COUPLED_MASS, self._mass, RELIABLE, raw=True)

    def _mass(self, message: bytes) -> None:
        mass = readers.number(message)
        if 0.0 < mass < float("inf"):
            self._simulation.remote.mass = mass
        else:
            sentence = f"an effective mass of {mass} kg is refused; it takes a finite number above 0"
            self._log.warning(sentence, throttle_duration_sec=PAUSE)

    def _state(self, message: bytes) -> None:
        node, sample = self._node, self._reader.read(message)
        if sample is None or sample.velocity is None:
            names = ", ".join(self._reader.names(message)) or "none"
            sentence = f"{COUPLED} lacks position or velocity of {node.parameters['joint_name']}; its joints: {names}"
            self._log.warning(sentence, throttle_duration_sec=PAUSE)
        elif not node.engine.paused and sample.stamp != self._stamp:
            self._stamp = sample.stamp
            self._answer(sample.stamp * 1e-9, sample.position, sample.velocity)

    def _answer(self, time: float, position: float, velocity: float) -> None:
        try:
            with self._node.engine.lock:
                force = self._simulation.follow(time, position, velocity)
        except PneumoError as error:
            self._log.warning(f"{error}; no effort is sent", throttle_duration_sec=PAUSE)
            return
        self._node.engine.send()
        self._effort.publish(Float64MultiArray(data=[force]))
