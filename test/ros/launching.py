"""Reads launch files without ROS's launch, which has no wheels: only the parts that our files use.

`commands` gives what `ros2 launch` would start, as commands of Python modules. Where launch refuses something, an
assertion fails here, and anything unknown to these classes is an error.
"""

import importlib.util
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from unittest import mock

import yaml

ROOT = Path(__file__).parents[2]
Arguments = Mapping[str, str]


class _Substitution:
    """Text that depends on the launch arguments."""

    def __init__(self, content: Any) -> None:
        self.content = content

    def perform(self, arguments: Arguments) -> str:
        raise NotImplementedError


class LaunchConfiguration(_Substitution):
    def perform(self, arguments: Arguments) -> str:
        return arguments[self.content]


class FindPackageShare(_Substitution):
    def perform(self, arguments: Arguments) -> str:
        assert self.content == "pneumo_ros"
        return str(ROOT)  # config and launch lie there as they do in the package's share


class PathJoinSubstitution(_Substitution):
    def perform(self, arguments: Arguments) -> str:
        return str(Path(*(_text(part, arguments) for part in self.content)))


class Command(_Substitution):
    """Is not run: its text replaces its output."""

    def perform(self, arguments: Arguments) -> str:
        return _text(self.content, arguments)


class PythonExpression(_Substitution):
    def perform(self, arguments: Arguments) -> str:
        return str(eval(_text(self.content, arguments), {}))


class ParameterValue:
    def __init__(self, value: Any, *, value_type: type) -> None:
        self.value, self.value_type = value, value_type


class DeclareLaunchArgument:
    def __init__(self, name: str, *, default_value: Any = None, description: str) -> None:
        self.name, self.default = name, default_value


class IfCondition:
    def __init__(self, expression: Any) -> None:
        self.expression = expression

    def holds(self, arguments: Arguments) -> bool:
        said = _text(self.expression, arguments).strip().lower()
        assert said in ("true", "1", "false", "0"), f"launch takes no condition '{said}'"
        return said in ("true", "1")


class Node:
    def __init__(
        self,
        *,
        package: str,
        executable: str,
        namespace: Any = "",
        parameters: list[Any] | None = None,
        arguments: list[Any] | None = None,
        remappings: list[tuple[str, str]] | None = None,
        output: str = "log",
        condition: IfCondition | None = None,
        on_exit: Any = None,
    ) -> None:
        self.package, self.executable, self.namespace, self.condition = package, executable, namespace, condition
        self.parameters, self.arguments, self.on_exit = parameters or [], arguments or [], on_exit


class Shutdown:
    def __init__(self, *, reason: str) -> None:
        self.reason = reason


MODULES = {
    "launch": {"LaunchDescription": list, "LaunchContext": SimpleNamespace},
    "launch.actions": {"DeclareLaunchArgument": DeclareLaunchArgument, "Shutdown": Shutdown},
    "launch.events": {},
    "launch.events.process": {"ProcessExited": SimpleNamespace},
    "launch.conditions": {"IfCondition": IfCondition},
    "launch.substitutions": {
        "Command": Command,
        "LaunchConfiguration": LaunchConfiguration,
        "PathJoinSubstitution": PathJoinSubstitution,
        "PythonExpression": PythonExpression,
    },
    "launch_ros": {},
    "launch_ros.actions": {"Node": Node},
    "launch_ros.parameter_descriptions": {"ParameterValue": ParameterValue},
    "launch_ros.substitutions": {"FindPackageShare": FindPackageShare},
}


def commands(file: str, place: Path, **given: object) -> dict[str, list[str]]:
    """Commands by "namespace/executable" of this package that launch/`file` starts with the arguments given.

    Parameters go to files in `place`, as launch writes them.
    """
    nodes, arguments = _started(file, given)
    ours = [one for one in nodes if one.package == "pneumo_ros"]
    return {f"{_text(one.namespace, arguments)}/{one.executable}": _command(one, place, arguments) for one in ours}


def others(file: str, **given: object) -> dict[str, tuple[list[str], dict[str, str]]]:
    """Command-line arguments and parameters, as text, of what launch/`file` starts from other packages."""
    nodes, arguments = _started(file, given)
    found = {}
    for one in nodes:
        if one.package != "pneumo_ros":
            values = {
                k: _text(v, arguments) for entry in one.parameters if isinstance(entry, dict) for k, v in entry.items()
            }
            files = {_text(entry, arguments): "" for entry in one.parameters if not isinstance(entry, dict)}
            found[one.executable] = ([_text(part, arguments) for part in one.arguments], {**values, **files})
    return found


def after_exit(file: str, executable: str, code: int, **given: object) -> list[str]:
    """Reasons for which launch ends everything when `executable` has ended with exit code `code`."""
    nodes, arguments = _started(file, given)
    (one,) = [node for node in nodes if node.executable == executable]
    context = SimpleNamespace(launch_configurations=arguments)
    return [action.reason for action in one.on_exit(SimpleNamespace(returncode=code), context)]


def _started(file: str, given: Mapping[str, object]) -> tuple[list[Node], dict[str, str]]:
    """The nodes whose conditions hold, and all launch arguments."""
    entities = _load(file).generate_launch_description()
    declared = {entity.name: entity.default for entity in entities if isinstance(entity, DeclareLaunchArgument)}
    assert set(given) <= set(declared), f"{file} has the arguments {sorted(declared)}"
    assert all(str(value) for value in given.values()), "ros2 launch refuses NAME:= without a value"
    values = {**declared, **given}
    assert None not in values.values(), f"arguments without default: {values}"
    arguments: dict[str, str] = {}
    for name, value in values.items():  # a default may depend on the arguments before it
        arguments[name] = _text(value, arguments)
    nodes = [entity for entity in entities if isinstance(entity, Node)]
    return [one for one in nodes if one.condition is None or one.condition.holds(arguments)], arguments


def _command(node: Node, place: Path, arguments: Arguments) -> list[str]:
    namespace = _text(node.namespace, arguments)
    command = ["-m", f"pneumo_ros.ros.{node.executable}", "--ros-args", "-r", f"__ns:=/{namespace}"]
    for number, entry in enumerate(node.parameters):
        path = _text(entry, arguments)
        if isinstance(entry, dict):
            path = str(place / f"launch_{namespace}_{node.executable}_{number}.yaml")
            values = {name: _value(value, arguments) for name, value in entry.items()}
            Path(path).write_text(yaml.dump({"/**": {"ros__parameters": values}}), encoding="utf-8")
        command += ["--params-file", path]
    return command


def _value(value: Any, arguments: Arguments) -> Any:
    """A parameter: a plain value; text of a stated type; other text is read as YAML."""
    if isinstance(value, _Substitution):
        return yaml.safe_load(value.perform(arguments))
    if not isinstance(value, ParameterValue):
        return value
    text = _text(value.value, arguments)
    made = yaml.safe_load(text) if value.value_type is bool else value.value_type(text)
    assert isinstance(made, value.value_type), f"launch makes no {value.value_type} of '{text}'"
    return made


def _text(value: Any, arguments: Arguments) -> str:
    if isinstance(value, _Substitution):
        return value.perform(arguments)
    if isinstance(value, ParameterValue):
        return _text(value.value, arguments)
    if isinstance(value, list):
        return "".join(_text(part, arguments) for part in value)
    return str(value)


def _load(file: str) -> ModuleType:
    """The launch file as a module, with the classes above in place of ROS's."""
    stand_ins = {name: SimpleNamespace(**content) for name, content in MODULES.items()}
    specification = importlib.util.spec_from_file_location(f"read_{file.partition('.')[0]}", ROOT / "launch" / file)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    with mock.patch.dict(sys.modules, stand_ins):
        specification.loader.exec_module(module)
    return module
