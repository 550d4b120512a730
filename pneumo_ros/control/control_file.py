"""Control files: the law, its gains and the smoothing of the valve, as ROS parameters of the controller."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

from pneumo_ros.control.law import Law
from pneumo_ros.control.laws import LAWS
from pneumo_ros.control.machine import Machine
from pneumo_ros.control.valve import ValveInverse
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.files import yaml_number
from pneumo_ros.nearest import unknown_name

SMOOTHING = ValveInverse().smoothing


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
    """The control file at a path, or the one of that name that comes with the package (`cascade`, ...).

    Raises DataError when it cannot be read, UsageError for what is no control file, a law or gain of unknown name
    (with the nearest), or a gain out of range.
    """
    path, shipped = Path(name_or_path), files("pneumo_ros.config").joinpath(f"control/{name_or_path}.yaml")
    try:
        own = path.is_file() or path.name != str(name_or_path) or not shipped.is_file()
        document = yaml.safe_load((path if own else shipped).read_text(encoding="utf-8"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise DataError(
            f"control file {name_or_path} cannot be read ({error}); give a YAML file or one of: {', '.join(LAWS)}"
        ) from error
    try:
        return _control(document)
    except UsageError as error:
        raise UsageError(f"control file {name_or_path}: {error}") from error


def _control(document: Any) -> Control:
    try:
        given = document["/**"]["ros__parameters"]
        law = given["law"]
    except (TypeError, KeyError) as error:
        raise UsageError("it takes '/**:', 'ros__parameters:' and in there 'law: ...'") from error
    if law not in LAWS:
        raise UsageError(unknown_name("law", str(law), LAWS))
    gains = given.get(law) or {}
    LAWS[law](gains)  # whether they are gains of it
    smoothing = (given.get("valve") or {}).get("smoothing", SMOOTHING)
    return Control(law, {name: float(value) for name, value in gains.items()}, float(smoothing))
