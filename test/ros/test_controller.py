"""The controller as a process, with the test as its plant."""

import math
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from ros.probe import BEST_EFFORT, Probe, probe
from ros.processes import Running, node, running
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.control import Measurement, Pid, Setpoint
from pneumo_ros.control.motion import Limits, Profile

NAME = "piston"


class Plant:
    """Sends joint states and gathers the commands."""

    def __init__(self, one: Probe) -> None:
        self.probe = one
        self.publisher = one.node.create_publisher(JointState, "joint_states", BEST_EFFORT)
        self.commands = one.heard["valve/command"]
        one.matched(self.publisher, one.reference)
        one.wait(lambda: one.node.count_publishers("valve/command"), "a controller")
        time.sleep(0.3)  # until both sides know
        self.time = 1_000_000_000

    def send(self, position: float, velocity: float | None = None, step: int = 2_000_000) -> None:
        """A joint state, one `step` [ns] after the last one."""
        self.time += step
        message = JointState(name=["boom", NAME], position=[9.0, position])
        message.velocity = [9.0, velocity] if velocity is not None else []
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(self.time, 1_000_000_000)
        self.publisher.publish(message)

    def answer(self, position: float, velocity: float | None = None) -> float:
        """The command for a joint state."""
        have = len(self.commands)
        self.send(position, velocity)
        self.probe.wait(lambda: len(self.commands) > have, "a command")
        return self.commands[-1].data

    def push(self, sign: float = 1.0) -> None:
        """Joint states at rest, until the wanted motion has opened the valve to one side."""
        for _ in range(1000):
            if sign * self.answer(0.0) > 0.78:
                return
        raise AssertionError(f"the valve stays closed: {self.commands[-1].data} V")

    def want(self, position: float) -> None:
        """Send a reference."""
        self.probe.reference.publish(Float64(data=position))
        time.sleep(0.1)


@contextmanager
def controlled(folder: Path, namespace: str, **parameters: object) -> Iterator[tuple[Running, Plant]]:
    """A controller and its plant."""
    given = {"measurement_timeout": 60.0, **parameters}
    command = node("controller", "-r", f"__ns:=/{namespace}", **given)
    with running(*command, cwd=folder) as process, probe(namespace) as one:
        yield process, Plant(one)


def test_every_measurement_gets_the_command_of_the_law(tmp_path: Path) -> None:
    """To the bit: the node changes nothing, and joint and velocity are found by name."""
    steady = {"reference.shape": "constant", "reference.position": 0.05}
    with controlled(tmp_path, "law", **steady) as (process, plant):
        positions = [0.0, -2e-3, -2.1e-3, -2.2e-3, -2e-3, -1.8e-3, -1.6e-3]  # off enough for an answer
        answers = [plant.answer(y) for y in positions[:4]] + [plant.answer(y, 0.02) for y in positions[4:]]
        law, profile = Pid(), Profile(Setpoint(0.0), 0.0, 0.05, Limits())
        times = [2_000_000 * k * 1e-9 for k in range(len(positions))]
        speeds = [None] * 4 + [0.02] * 3
        measurements = [Measurement(t, y, v) for t, y, v in zip(times, positions, speeds, strict=True)]
        assert answers == [law.step(profile(one.time), one) for one in measurements]
        assert len(set(answers)) == len(answers)
        assert len(plant.commands) == len(positions)
        assert process.end() == 0


def test_without_a_reference_the_valve_stays_closed(tmp_path: Path) -> None:
    with controlled(tmp_path, "idle") as (process, plant):
        assert [plant.answer(0.001 * k) for k in range(5)] == [0.0] * 5
        assert "no reference yet" in plant.probe.health("idle/controller")[0]
        plant.want(0.05)
        plant.push()
        assert process.end() == 0


def test_silence_is_answered_with_0_v_and_said(tmp_path: Path) -> None:
    with controlled(tmp_path, "silence", measurement_timeout=0.2) as (process, plant):
        plant.want(0.3)
        plant.push()
        process.wait_for("no measurement for 0.2 s: sending 0 V")
        plant.probe.wait(lambda: plant.commands[-1].data == 0.0, "0 V")
        message, _ = plant.probe.health("silence/controller")
        assert "measurements are missing" in message
        plant.push()
        process.wait_for("measurements are back")
        assert process.said.count("sending 0 V") == 1
        assert process.end() == 0


def test_what_is_not_a_number_is_refused_and_counted(tmp_path: Path) -> None:
    with controlled(tmp_path, "numbers") as (process, plant):
        plant.want(0.3)
        plant.push()
        have = len(plant.commands)
        plant.send(math.nan)
        plant.send(math.inf)
        plant.want(math.nan)
        time.sleep(0.2)
        assert len(plant.commands) == have  # no answer to a position that is not a number
        plant.push()  # and the reference is the old one
        _, values = plant.probe.health("numbers/controller")
        assert values["rejected_inputs"] == "3"
        assert process.end() == 0


def test_gains_change_under_way_or_not_at_all(tmp_path: Path) -> None:
    steady = {"reference.shape": "constant", "reference.position": 0.05, "following_error": 1.0}
    with controlled(tmp_path, "gains", **steady) as (process, plant):
        plant.time += 10_000_000
        usual = max(plant.answer(0.0) for _ in range(350))  # 0.7 s: the setpoint has arrived, the piston has not
        refused, reason = plant.probe.set("controller", pid__proportional=-1.0)
        assert not refused
        assert "pid.proportional" in reason
        assert not plant.probe.set("controller", max_voltage=0.5)[0]  # inside the dead zone
        assert not plant.probe.set("controller", reference__shape="circle")[0]
        assert plant.probe.get("controller", "pid.proportional") == 100.0
        assert plant.probe.set("controller", reference__levels=[0, 1]) == (True, "")  # whole numbers are accepted, too
        assert plant.probe.set("controller", pid__proportional=20) == (True, "")
        assert 0.78 < plant.answer(0.0) < usual - 2.0
        assert plant.probe.set("controller", reference__shape="constant", reference__position=-0.05) == (True, "")
        plant.push(-1.0)
        assert process.end() == 0


def test_a_clock_that_was_set_back_restarts_it(tmp_path: Path) -> None:
    with controlled(tmp_path, "loops") as (process, plant):
        plant.want(0.05)
        plant.time = 100_000_000_000
        plant.answer(0.0)
        plant.time = 5_000_000_000
        plant.push()
        assert plant.answer(0.0) > 0.78
        assert process.end() == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_its_last_command_is_0_v(tmp_path: Path, number: int) -> None:
    with controlled(tmp_path, "last") as (process, plant):
        plant.want(0.3)
        plant.push()
        assert process.end(number) == 0
        plant.probe.wait(lambda: plant.commands[-1].data == 0.0, "0 V")


def test_a_missing_joint_is_named(tmp_path: Path) -> None:
    with controlled(tmp_path, "joints", joint_name="arm") as (process, plant):
        plant.send(0.0)
        process.wait_for("joint_states has no position of joint 'arm' (parameter joint_name), but of: boom, piston")
        assert not plant.commands
        assert process.end() == 0


def test_it_takes_its_dead_zone_from_a_machine_file_and_refuses_what_it_does_not_know(tmp_path: Path) -> None:
    from importlib.resources import files

    config = files("pneumo_ros.config")
    machine = tmp_path / "machine.yaml"
    machine.write_text((config / "axis.yaml").read_text().replace("right_limit: 0.78", "right_limit: 0.9"))
    files_given = ("--params-file", str(config / "control" / "pid.yaml"), "--params-file", str(machine))
    with running(*node("controller", *files_given), cwd=tmp_path) as process, probe() as one:
        assert one.get("controller", "dead_zone.right_limit") == 0.9
        assert process.end() == 0
    with running(*node("controller", **{"pid.proportionl": 3.0}), cwd=tmp_path) as process:
        assert process.end(None) == 2
        assert "did you mean pid.proportional" in process.said


SPY = """
import sys
from pneumo_ros.control import Pid
from pneumo_ros.axis.controller import settings
from pneumo_ros.ros.controller import main


class Spy(Pid):
    reads_pressures = True

    def step(self, setpoint, measurement):
        return 1e-5 * (measurement.pressure_a or 0.0) - 1e-6 * (measurement.pressure_b or 0.0)


settings.LAWS["pid"] = Spy
sys.exit(main(sys.argv[1:]))
"""


def test_a_law_that_reads_pressures_gets_those_of_its_sample(tmp_path: Path) -> None:
    given = ["--ros-args", "-r", "__ns:=/spied", "-p", "measurement_timeout:=10.0", "-p", "closed_signal:=0V"]
    with running("-c", SPY, *given, cwd=tmp_path) as process, probe("spied") as one:
        plant = Plant(one)
        pressures = [one.node.create_publisher(FluidPressure, f"chamber_{c}/pressure", BEST_EFFORT) for c in "ab"]
        one.matched(*pressures)
        time.sleep(0.3)
        plant.want(0.1)
        for publisher, value in zip(pressures, (3e5, 2e5), strict=True):
            publisher.publish(FluidPressure(fluid_pressure=value))
        assert plant.answer(0.0) == pytest.approx(2.8)
        assert process.end() == 0
