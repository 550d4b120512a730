"""A simulator in step with another one: the state of the rod comes as a message, its force goes back as one."""

import threading
from pathlib import Path

import numpy as np
from ros.probe import RELIABLE, Probe, probe, stamp
from ros.processes import PATIENCE, node, running
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

from pneumo_ros.plant import load_model

AXIS = load_model("axis")
MASS, STEP, STEPS = 12.0, 2e-3, 400
BEGIN = 5.0  # s on the clock of the other side


class Mechanism:
    """A free mass on the other side, which waits for each force before it takes its step."""

    def __init__(self, one: Probe) -> None:
        self._state = one.node.create_publisher(JointState, "coupled/joint_states", RELIABLE)
        self._mass = one.node.create_publisher(Float64, "coupled/effective_mass", RELIABLE)
        one.node.create_subscription(Float64MultiArray, "coupled/effort", self._effort, RELIABLE)
        self._one, self._force, self._answered = one, 0.0, threading.Event()
        one.matched(self._state, self._mass, one.command)

    def _effort(self, message: Float64MultiArray) -> None:
        (self._force,) = message.data
        self._answered.set()

    def ask(self, time: float, position: float, velocity: float, joint: str = "piston") -> float:
        """The force [N] for this state."""
        self._answered.clear()
        message = JointState(name=["other", joint], position=[9.0, position], velocity=[0.0, velocity])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * 1e9), 1_000_000_000)
        self._state.publish(message)
        assert self._answered.wait(PATIENCE), "no effort"
        return self._force

    def run(self, volts: float) -> np.ndarray:
        """Positions [m] at the end of each step."""
        self._mass.publish(Float64(data=MASS))
        self._one.send(volts)
        self._one.wait(lambda: self._one.health("coupled/simulator")[1]["commands"] != "0", "the command")
        y = v = 0.0
        found = []
        for k in range(STEPS):
            v += self.ask(BEGIN + k * STEP, y, v) / MASS * STEP
            y += v * STEP
            found.append(y)
        return np.array(found)


def test_a_mass_in_another_simulator_moves_as_the_whole_machine(tmp_path: Path) -> None:
    command = node("simulator", "-r", "__ns:=/coupled", coupled=True, publish_rate=500.0, command_timeout=0.0)
    with running(*command, cwd=tmp_path) as plant, probe("coupled") as one:
        plant.wait_for("ready")
        other = Mechanism(one)
        one.wait(lambda: "no state of the rod" in one.health("coupled/simulator")[0], "a warning")
        y = other.run(2.5)
        one.wait(lambda: len(one.heard["joint_states"]) >= STEPS, "all readings")
        assert plant.end() == 0
    model = AXIS.with_parameters({"piston.mass": MASS})
    whole = model.simulate(np.full(STEPS, 2.5), model.state(), sample_time=STEP)[:, 0]
    assert np.abs(y - whole).max() < 0.02 * np.ptp(whole)
    readings = one.heard["joint_states"][-STEPS:]
    assert [stamp(message) for message in readings] == [round((BEGIN + k * STEP) * 1e9) for k in range(STEPS)]
    assert [message.position[0] for message in readings[1:]] == list(y[:-1])


def test_states_of_other_joints_and_outside_the_stroke_get_no_force(tmp_path: Path) -> None:
    with (
        running(*node("simulator", "-r", "__ns:=/coupled", coupled=True), cwd=tmp_path) as plant,
        probe("coupled") as one,
    ):
        plant.wait_for("ready")
        other = Mechanism(one)
        assert not one.trigger("simulator/step").success
        other.ask(BEGIN, 0.0, 0.0)
        for message, said in (
            (JointState(name=["elbow"], position=[0.0], velocity=[0.0]), "lacks position or velocity of piston"),
            (JointState(name=["piston"], position=[5.0], velocity=[0.0]), "outside of its stroke"),
        ):
            other._state.publish(message)
            plant.wait_for(said)
        other._mass.publish(Float64(data=-1.0))
        plant.wait_for("mass of -1.0 kg is refused")
        assert abs(other.ask(BEGIN + STEP, 0.0, 0.0)) < 200.0
        assert plant.end() == 0
