"""Which nodes the launch files start, with which parameters."""

from contextlib import ExitStack, closing
from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from ros.axis_probe import AxisProbe
from ros.launching import ROOT, after_exit, commands, others
from ros.probe import probe
from ros.processes import running
from sensor_msgs.msg import FluidPressure

IDENTIFY = {"rig/simulator", "twin/simulator", "rig/experiment", "identified/identification"}


def parameters(command: list[str]) -> dict[str, object]:
    """The ROS arguments that launch itself writes."""
    path = Path(command[-1])
    assert path.name.startswith("launch_")
    return yaml.safe_load(path.read_text(encoding="utf-8"))["/**"]["ros__parameters"]


def test_the_axis_is_a_simulator_and_a_controller_of_the_same_machine(tmp_path: Path) -> None:
    nodes = commands("axis.launch.py", tmp_path)
    assert set(nodes) == {"/simulator", "/controller"}
    for command in nodes.values():
        assert str(ROOT / "config" / "axis.yaml") in command
    assert str(ROOT / "config" / "control" / "pid.yaml") in nodes["/controller"]
    mine = commands("axis.launch.py", tmp_path, control="mine.yaml")
    assert "mine.yaml" in mine["/controller"]
    assert "mine.yaml" not in mine["/simulator"]


def test_the_axis_is_recorded_if_a_folder_is_named(tmp_path: Path) -> None:
    nodes = commands("axis.launch.py", tmp_path, record="2030_01_02", namespace="cylinder_1")
    assert set(nodes) == {"cylinder_1/simulator", "cylinder_1/controller", "cylinder_1/recorder"}
    assert parameters(nodes["cylinder_1/recorder"]) == {"output": "2030_01_02"}  # which YAML reads as a number


def test_the_recorder_alone_needs_a_folder(tmp_path: Path) -> None:
    (command,) = commands("record.launch.py", tmp_path, output="2030_01_02").values()
    assert parameters(command) == {"output": "2030_01_02"}
    with pytest.raises(AssertionError, match="without default"):
        commands("record.launch.py", tmp_path)


def test_a_real_rig_is_not_simulated(tmp_path: Path) -> None:
    assert set(commands("identify.launch.py", tmp_path)) == IDENTIFY
    assert set(commands("identify.launch.py", tmp_path, simulate="false")) == IDENTIFY - {"rig/simulator"}


def test_the_experiment_is_made_for_the_machine_of_the_twin_and_the_twin_is_the_target(tmp_path: Path) -> None:
    nodes = commands("identify.launch.py", tmp_path, twin="model_1", twin_params="guess.yaml", folder="1")
    assert parameters(nodes["rig/experiment"])["model"] == "guess.yaml"
    assert parameters(nodes["rig/experiment"])["output"] == "1"
    identification = parameters(nodes["identified/identification"])
    assert identification["target"] == "/model_1/simulator"
    assert identification["model"] == "guess.yaml"
    assert identification["folder"] == "1"


def test_an_experiment_that_died_ends_everything_and_says_where_its_recordings_are() -> None:
    assert after_exit("identify.launch.py", "experiment", 0) == []
    (reason,) = after_exit("identify.launch.py", "experiment", 3, folder="runs_1")
    assert "exit code 3" in reason
    assert "runs_1" in reason


def test_a_simulated_rig_may_be_silent_longer_than_a_real_one(tmp_path: Path) -> None:
    for given, seconds in (({}, 2.0), ({"simulate": "false"}, 0.2), ({"timeout": "5.0"}, 5.0)):
        nodes = commands("identify.launch.py", tmp_path, **given)
        assert parameters(nodes["rig/experiment"])["measurement_timeout"] == seconds


def test_below_ros2_control_the_plant_lives_in_a_namespace(tmp_path: Path) -> None:
    nodes = commands("ros2_control.launch.py", tmp_path, namespace="rig")
    assert set(nodes) == {"rig/simulator", "rig/controller"}
    (alone,) = commands("ros2_control.launch.py", tmp_path, simulate="false", control="mine.yaml").values()
    files = [after for word, after in pairwise(alone) if word == "--params-file"]
    assert files[:2] == ["mine.yaml", str(ROOT / "config" / "axis.yaml")]
    assert parameters(alone)["rig"] == ""
    above = others("ros2_control.launch.py", namespace="rig", rviz="true")
    assert set(above) == {"robot_state_publisher", "ros2_control_node", "spawner", "rviz2"}
    made = above["robot_state_publisher"][1]["robot_description"]
    assert made == f"xacro {ROOT}/urdf/axis.urdf.xacro namespace:=rig stroke:=2.0 plugin:=JointStateTopicSystem"
    for file in (*above["ros2_control_node"][1], above["rviz2"][0][1]):
        assert Path(file).is_file()


def test_the_arm_is_one_simulator_of_two_axes_with_joints_of_their_own(tmp_path: Path) -> None:
    nodes = commands("two_axes.launch.py", tmp_path, lift_control="mine.yaml")
    assert set(nodes) == {"/simulator", "lift/controller", "reach/controller"}
    assert all(str(ROOT / "config" / "arm" / "pruning.yaml") in command for command in nodes.values())
    joints = {axis: f"{axis}_piston" for axis in ("lift", "reach")}
    carrying = {"lift.initial.p_a": 3.33e5, "lift.initial.p_b": 3e5}
    assert parameters(nodes["/simulator"]) == {f"{axis}.joint_name": joint for axis, joint in joints.items()} | carrying
    for axis, joint in joints.items():
        assert parameters(nodes[f"{axis}/controller"]) == {"joint_name": joint}
    assert [name for name, command in nodes.items() if "mine.yaml" in command] == ["lift/controller"]
    mine = commands("two_axes.launch.py", tmp_path, params="my_arm.yaml", simulate="false")
    assert set(mine) == {"lift/controller", "reach/controller"}
    assert all("my_arm.yaml" in command for command in mine.values())
    above = others("two_axes.launch.py")
    assert set(above) == {"joint_state_publisher", "robot_state_publisher"}
    assert "/lift/joint_states" in above["joint_state_publisher"][1]["source_list"]


@pytest.mark.check
def test_both_axes_of_the_arm_move_on_one_supply(tmp_path: Path) -> None:
    nodes = commands("two_axes.launch.py", tmp_path)
    with ExitStack() as stack:
        processes = [stack.enter_context(running(*command, cwd=tmp_path)) for command in nodes.values()]
        whole = stack.enter_context(probe(""))
        supply = whole.hear("supply/pressure", FluidPressure, 10)
        one = {axis: stack.enter_context(closing(AxisProbe(axis, f"{axis}_piston"))) for axis in ("lift", "reach")}
        for axis, ax in one.items():
            ax.wait(lambda ax=ax: ax.heard["valve/command"] and ax.heard["joint_states"], f"a command of {axis}", 60.0)
            assert list(ax.heard["joint_states"][-1].name) == [f"{axis}_piston"]
        begin = len(supply)
        one["lift"].aim(0.1)
        one["reach"].aim(-0.1)
        one["lift"].arrives(0.1)
        one["reach"].arrives(-0.1)
        assert min(message.fluid_pressure for message in supply[begin:]) < 6.95e5  # Pa, of 7e5: both draw from it
        assert [process.end() for process in processes] == [0, 0, 0]
