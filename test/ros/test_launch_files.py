"""Which nodes the launch files start, with which parameters."""

from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from ros.launching import ROOT, after_exit, commands, others

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


def test_the_arm_has_two_axes_with_joints_of_their_own(tmp_path: Path) -> None:
    nodes = commands("two_axes.launch.py", tmp_path, reach_params="reach.yaml", lift_control="mine.yaml")
    assert set(nodes) == {f"{axis}/{name}" for axis in ("lift", "reach") for name in ("simulator", "controller")}
    for name, command in nodes.items():
        given = {"joint_name": f"{name.partition('/')[0]}_piston"}
        carrying = {"initial.p_a": 3.33e5, "initial.p_b": 3e5} if name == "lift/simulator" else {}
        assert parameters(command) == given | carrying
    assert str(ROOT / "config" / "arm" / "lift.yaml") in nodes["lift/simulator"]
    assert "reach.yaml" in nodes["reach/controller"]
    assert "reach.yaml" not in nodes["lift/controller"]
    assert [name for name, command in nodes.items() if "mine.yaml" in command] == ["lift/controller"]
    above = others("two_axes.launch.py")
    assert set(above) == {"joint_state_publisher", "robot_state_publisher"}
    assert "/lift/joint_states" in above["joint_state_publisher"][1]["source_list"]
