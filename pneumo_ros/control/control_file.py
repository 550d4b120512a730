"""Control files: the law, its gains and the smoothing of the valve, as ROS parameters of the controller."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from pneumo_ros.control.law import Law
from pneumo_ros.control.laws import LAWS
from pneumo_ros.control.machine import Machine
from pneumo_ros.control.valve import ValveInverse
from pneumo_ros.errors import DataError, UsageError, brief
from pneumo_ros.files import yaml_number
from pneumo_ros.nearest import unknown_name
from pneumo_ros.yaml_text import load_yaml

SMOOTHING = ValveInverse().smoothing
SMOOTHEST = 10.0  # V


@dataclass(frozen=True)
class Control:
    """A law by name, its gains, and the smoothing [V] of the inverted dead zone."""

    law: str
    gains: Mapping[str, float]
    smoothing: float = SMOOTHING

    def make(self, effects: tuple[str, ...], parameters: Mapping[str, float]) -> Law:
        """The law for a machine that lists `effects`, with its parameters by dotted name; UsageError for bad gains."""
        dead_zone = {name: parameters.get(f"dead_zone.{name}", absent) for name, absent in _NO_DEAD_ZONE.items()}
        valve = ValveInverse(**dead_zone, smoothing=self.smoothing)
        return LAWS[self.law](self.gains, valve, Machine.of(effects, parameters))

    def text(self, heading: str) -> str:
        """The control file, with unit and meaning beside every gain; `heading` is its first comment."""
        kind = LAWS[self.law]
        given = kind(self.gains)
        lines = [f"# {line}" for line in heading.splitlines()]
        lines += ["/**:", "  ros__parameters:", f"    law: {self.law}", f"    {self.law}:"]
        for name, gain in kind.gains.items():
            lines.append(f"      {name}: {yaml_number(getattr(given, name))}  # [{gain.unit}] {gain.meaning}")
        meaning = "[V] opening by which the jump across the dead zone is complete"
        return "\n".join([*lines, "    valve:", f"      smoothing: {yaml_number(self.smoothing)}  # {meaning}", ""])


_NO_DEAD_ZONE = {"right_limit": 0.0, "left_limit": 0.0, "right_slope": 1.0, "left_slope": 1.0}


def load_control(name_or_path: str | Path) -> Control:
    """The control file at a path, or the shipped one of that name (`cascade`, ...).

    Raises DataError when it cannot be read, UsageError for a file of another kind, an unknown law or gain (with the
    nearest names), or a gain out of range.
    """
    path, shipped = Path(name_or_path), files("pneumo_ros.config").joinpath(f"control/{name_or_path}.yaml")
    try:
        own = path.is_file() or path.name != str(name_or_path) or not shipped.is_file()
        document = load_yaml((path if own else shipped).read_text(encoding="utf-8"))
    except (OSError, ValueError, UsageError) as error:
        raise DataError(
            f"control file {name_or_path} cannot be read ({error}); give a YAML file or one of: {', '.join(LAWS)}"
        ) from error
    try:
        return _control(document)
    except UsageError as error:
        raise UsageError(f"control file {name_or_path}: {error}") from error


def _control(document: Any) -> Control:
    try:
        given: dict[str, Any] = document["/**"]["ros__parameters"]
        law = given["law"]
    except (TypeError, KeyError, IndexError) as error:
        raise UsageError("it takes '/**:', 'ros__parameters:' and in there 'law: ...'") from error
    if not isinstance(law, str) or law not in LAWS:
        raise UsageError(unknown_name("law", law if isinstance(law, str) else brief(law), LAWS))
    gains, valve = _section(given, law), _section(given, "valve")
    made = LAWS[law](gains)  # checks the gains
    smoothing = valve.get("smoothing", SMOOTHING)
    if isinstance(smoothing, bool) or not isinstance(smoothing, int | float) or not 0.0 <= smoothing <= SMOOTHEST:
        raise UsageError(f"valve.smoothing is {brief(smoothing)}; it takes a voltage from 0 to {SMOOTHEST:g} V")
    return Control(law, {name: getattr(made, name) for name in gains}, float(smoothing))


def _section(given: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The entries of a section, which may be missing or empty."""
    entries = given.get(name) or {}
    if not isinstance(entries, dict) or not all(isinstance(key, str) for key in entries):
        raise UsageError(f"section {name} is {brief(entries)}; it takes entries, name: value")
    return entries
