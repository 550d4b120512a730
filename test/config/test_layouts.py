"""Layouts of rviz, PlotJuggler and Foxglove, and ros2_control's controllers: they load and name existing topics."""

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml

from pneumo_ros.plant import load_model
from pneumo_ros.plant.machine_file import shipped_machines
from pneumo_ros.records.contract import GLOBAL_TYPES, JOINT, TYPES

CONFIG = Path(__file__).parents[2] / "pneumo_ros" / "config"
TOPICS = {*(f"/{name}" for name in TYPES), *GLOBAL_TYPES}
FIELDS = {
    "sensor_msgs/msg/JointState": {"position", "velocity", "effort"},
    "sensor_msgs/msg/FluidPressure": {"fluid_pressure", "variance"},
    "std_msgs/msg/Float64": {"data"},
}


def topic_of(text: str) -> str:
    """The topic of the contract at the start of a text."""
    found = [topic for topic in TOPICS if text.startswith(topic)]
    assert found, f"no such topic: {text}"
    return max(found, key=len)


@pytest.mark.parametrize("path", sorted(CONFIG.glob("plotjuggler/*.xml")), ids=lambda path: path.name)
def test_plotjuggler_curves_are_fields_of_topics(path: Path) -> None:
    root = ElementTree.parse(path).getroot()
    curves = [str(curve.get("name")) for curve in root.iter("curve")]
    assert len(curves) >= 8
    for curve in curves:
        topic = topic_of(curve)
        inner = curve.removeprefix(f"{topic}/").split("/")
        assert inner[-1] in FIELDS[TYPES[topic.lstrip("/")]]
        assert inner[:-1] in ([], [JOINT])
    selected = {topic.get("name") for topic in root.iter("topic")}
    assert selected == {topic_of(curve) for curve in curves}
    for splitter in root.iter("DockSplitter"):
        assert len(splitter) == int(str(splitter.get("count"))) == len(str(splitter.get("sizes")).split(";"))


@pytest.mark.parametrize("path", sorted(CONFIG.glob("foxglove/*.json")), ids=lambda path: path.name)
def test_foxglove_paths_are_fields_of_topics_and_every_panel_has_a_place(path: Path) -> None:
    layout = json.loads(path.read_text(encoding="utf-8"))
    assert set(panels(layout["layout"])) == set(layout["configById"])
    series = [one["value"] for panel in layout["configById"].values() for one in panel.get("paths", ())]
    assert len(series) >= 7
    for value in series:
        topic, field = re.fullmatch(r"(/[\w/]+)\.(\w+)(?:\[0\])?", value).groups()  # type: ignore[union-attr]  # or fail
        assert field in FIELDS[TYPES[topic.lstrip("/")]]
    services = [panel["serviceName"] for panel in layout["configById"].values() if "serviceName" in panel]
    assert services == ["/controller/stop"]


def panels(node: Any) -> list[str]:
    """Names of all panels of a layout's tree."""
    return [node] if isinstance(node, str) else [*panels(node["first"]), *panels(node["second"])]


@pytest.mark.parametrize("path", sorted(CONFIG.glob("rviz/*.rviz")), ids=lambda path: path.name)
def test_rviz_shows_the_robot_as_it_is_described(path: Path) -> None:
    manager = yaml.safe_load(path.read_text(encoding="utf-8"))["Visualization Manager"]
    (robot,) = [one for one in manager["Displays"] if one["Class"] == "rviz_default_plugins/RobotModel"]
    assert robot["Description Topic"]["Durability Policy"] == "Transient Local"
    assert manager["Global Options"]["Fixed Frame"] == "base_link"


def test_there_are_layouts_of_each_kind() -> None:
    assert {path.parent.name for path in CONFIG.rglob("*") if path.suffix in (".xml", ".json", ".rviz")} == {
        "plotjuggler",
        "foxglove",
        "rviz",
    }


def test_what_lies_beside_the_machine_files_is_one() -> None:
    """Commands list them by name."""
    for name in shipped_machines():
        assert load_model(name).effects


def test_ros2_control_gives_air_the_room_it_needs() -> None:
    given = yaml.safe_load((CONFIG / "ros2_control" / "controllers.yaml").read_text(encoding="utf-8"))
    control = given["joint_trajectory_controller"]["ros__parameters"]
    assert control["joints"] == [JOINT]
    assert control["interpolate_from_desired_state"] is True
    assert 0.001 <= control["constraints"][JOINT]["goal"] <= 0.003
    assert control["command_interfaces"] == ["position", "velocity"]
