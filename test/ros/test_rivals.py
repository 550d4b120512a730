"""Two plants, or two controllers, in one namespace: the later one ends with exit code 2 and names the remedy."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from ros.probe import Probe, probe
from ros.processes import Running, node, running
from ros.scripted_plant import scripted_plant
from ros.test_experiment import experiment, in_trial
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

TOPIC = {"simulator": "chamber_a/pressure", "controller": "valve/command"}
ROLE = {"simulator": "plant", "controller": "controller"}
SECOND = """
import sys
from pneumo_ros.ros import rivals
rivals.WAIT = 0.0  # as where discovery takes longer than the wait
from pneumo_ros.ros.{name} import main
sys.exit(main())
"""


def command(name: str, space: str) -> list[str]:
    """Command of a node in a namespace."""
    return node(name, "-r", f"__ns:=/{space}")


@contextmanager
def begun(name: str, space: str, folder: Path) -> Iterator[tuple[Running, Probe]]:
    """A node that publishes, which has to end with exit code 0, and a probe in its namespace."""
    with running(*command(name, space), cwd=folder) as first, probe(space) as one:
        one.wait(lambda: one.node.count_publishers(TOPIC[name]), f"a {name}", 60.0)
        yield first, one
        assert first.process.poll() is None, first.said
        assert first.end() == 0, first.said


def status(one: Probe, name: str) -> Any:
    """The next status of node `name` on /diagnostics."""
    one.health(name)
    return [s for message in one.heard["/diagnostics"] for s in message.status if s.name == name][-1]


@pytest.mark.parametrize("name", TOPIC)
def test_the_second_one_says_who_is_there_and_what_to_type(name: str, tmp_path: Path) -> None:
    space = f"second_{name}"
    with begun(name, space, tmp_path) as (first, one), running(*command(name, space), cwd=tmp_path) as second:
        assert second.end(None) == 2, second.said
        assert f"/{space}/{name} is already the {ROLE[name]} in namespace /{space}" in second.said
        assert "--ros-args -r __ns:=/cylinder_2" in second.said
        first.wait_for(f"was started as a second {ROLE[name]} in namespace /{space}")
        one.wait(lambda: one.node.count_publishers(TOPIC[name]) == 1, "one publisher alone")


@pytest.mark.parametrize("name", TOPIC)
def test_a_second_one_that_is_discovered_late_ends_while_it_runs(name: str, tmp_path: Path) -> None:
    space = f"late_{name}"
    late = ["-c", SECOND.format(name=name), "--ros-args", "-r", f"__ns:=/{space}"]
    with begun(name, space, tmp_path), running(*late, cwd=tmp_path) as second:
        assert second.end(None) == 2, second.said
        assert f"/{space}/{name} is already the {ROLE[name]}" in second.said


@pytest.mark.parametrize("name", TOPIC)
def test_of_two_started_at_once_exactly_one_stays(name: str, tmp_path: Path) -> None:
    line = command(name, f"twins_{name}")
    with running(*line, cwd=tmp_path) as one, running(*line, cwd=tmp_path) as other:
        end = time.monotonic() + 60.0
        while one.process.poll() is None and other.process.poll() is None:
            assert time.monotonic() < end, "both stayed"
            time.sleep(0.05)
        gone, stays = (one, other) if one.process.poll() is not None else (other, one)
        assert gone.end(None) == 2, gone.said
        time.sleep(3.5)  # longer than a late discovery
        assert stays.process.poll() is None, stays.said
        assert stays.end() == 0, stays.said


def test_a_controller_does_not_start_beside_another_program_that_commands_the_valve(tmp_path: Path) -> None:
    with probe("foreign") as one:
        one.node.create_publisher(Float64, "valve/command", 10)
        time.sleep(0.5)
        with running(*command("controller", "foreign"), cwd=tmp_path) as late:
            late.wait_for("/foreign/probe")
            if "/foreign/probe publishes /foreign/valve/command, too" in late.said:  # discovered late
                assert late.end() == 0
            else:
                assert late.end(None) == 2
                assert "/foreign/probe is already the controller in namespace /foreign" in late.said


def test_a_running_controller_reports_another_program_until_it_is_gone(tmp_path: Path) -> None:
    name = "reported/controller"
    with begun("controller", "reported", tmp_path) as (first, one):
        other = one.node.create_publisher(Float64, "valve/command", 10)
        first.wait_for("/reported/probe publishes /reported/valve/command, too")
        found = status(one, name)
        assert found.level == DiagnosticStatus.ERROR
        assert "there can be one controller in a namespace" in found.message
        one.node.destroy_publisher(other)
        one.wait(lambda: status(one, name).level != DiagnosticStatus.ERROR, "an end of the error")


def test_a_simulator_takes_joint_states_of_others_for_a_warning_and_pressures_for_an_error(tmp_path: Path) -> None:
    name = "shared/simulator"
    with begun("simulator", "shared", tmp_path) as (first, one):
        one.matched(one.command)
        assert "publishes" not in status(one, name).message  # a node that commands the valve is not a plant
        one.node.create_publisher(JointState, "joint_states", 10)
        one.wait(lambda: "/shared/probe publishes /shared/joint_states" in status(one, name).message, "a warning")
        assert status(one, name).level == DiagnosticStatus.WARN
        one.node.create_publisher(FluidPressure, "chamber_b/pressure", 10)
        first.wait_for("there can be one plant in a namespace")
        assert status(one, name).level == DiagnosticStatus.ERROR


def test_an_experiment_goes_on_while_a_controller_refuses_to_start(tmp_path: Path) -> None:
    line = experiment(tmp_path, "tried", rounds=40)  # 150 s: a busy machine takes 6 s to start the controller
    with scripted_plant("tried") as plant, running(*line, cwd=tmp_path) as process:
        in_trial(plant, process)
        with running(*command("controller", "tried"), cwd=tmp_path) as late:
            assert late.end(None) == 2, late.said
            assert "/tried/experiment is already the controller in namespace /tried" in late.said
        process.wait_for("was started as a second controller")
