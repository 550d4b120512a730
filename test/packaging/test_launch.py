"""Launch files start executables that exist and use every argument they declare; `launch` loads them where it is."""

import ast
import importlib.util
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "launch").glob("*.launch.py"))
EXECUTABLES = {"simulator", "controller", "axis", "recorder", "player", "experiment", "identification", "commission"}


def calls(path: Path, name: str) -> list[ast.Call]:
    """All calls of `name` in a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, ast.Call) and getattr(node.func, "id", "") == name]


def constant(call: ast.Call, keyword: str) -> str:
    """The text that a call gives as `keyword`."""
    (value,) = [entry.value for entry in call.keywords if entry.arg == keyword]
    assert isinstance(value, ast.Constant)
    return str(value.value)


def first(call: ast.Call) -> str:
    """The text that a call gives first."""
    assert isinstance(call.args[0], ast.Constant)
    return str(call.args[0].value)


def test_there_are_launch_files() -> None:
    assert {path.name for path in FILES} >= {"axis.launch.py", "record.launch.py"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_nodes_name_our_executables(path: Path) -> None:
    nodes = [node for node in calls(path, "Node") if constant(node, "package") == "pneumo_ros"]
    assert nodes
    for node in nodes:
        assert constant(node, "executable") in EXECUTABLES


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_packages_of_others_are_declared(path: Path) -> None:
    declared = {element.text for element in ElementTree.parse(ROOT / "package.xml").getroot().findall("exec_depend")}
    used = {constant(node, "package") for node in calls(path, "Node")} - {"pneumo_ros"}
    assert used <= declared


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_argument_is_explained_and_used(path: Path) -> None:
    declared = calls(path, "DeclareLaunchArgument")
    assert all(len(constant(call, "description")) > 10 for call in declared)
    assert {first(call) for call in declared} == {first(call) for call in calls(path, "LaunchConfiguration")}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_loads_with_launch(path: Path) -> None:
    pytest.importorskip("launch_ros", reason="there are no wheels of launch; it comes with a ROS 2 distribution")
    specification = importlib.util.spec_from_file_location("launch_under_test", path)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    assert len(module.generate_launch_description().entities) > len(module.ARGUMENTS)
