"""The map of a table, a YAML file: its time, its motion, its constants, and an entry for each signal."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records import contract
from pneumo_ros.tables.entry import EXAMPLE, Entry, number, parse_entry
from pneumo_ros.tables.signals import MOTIONS, SIGNALS
from pneumo_ros.tables.units import SI, unit_of
from pneumo_ros.yaml_text import load_yaml

SECTIONS = ("time", "motion", "constants", "signals", "others", "source")
ATMOSPHERE = "atmospheric_pressure"
USUAL_ATMOSPHERE = 101325.0  # Pa
OTHERS = "measured"  # topics of signals that have no name of their own begin with it
_TIME = "time: {column: t, unit: s}, or for a table without time {rate: 1000}"


@dataclass(frozen=True)
class Timing:
    """The column of time and its unit (None: that in its heading); or, without one, the rate [Hz] of the rows."""

    column: str | None
    unit: str | None
    rate: float | None


@dataclass(frozen=True)
class Map:
    """What the columns of a table are. `content` is the file's, for the recording to carry."""

    timing: Timing
    imposed: bool
    constants: Mapping[str, float]  # SI
    signals: Mapping[str, Entry]
    others: Mapping[str, Entry]
    content: Mapping[str, Any]

    @property
    def atmosphere(self) -> float:
        """Pressure of the atmosphere [Pa], which gauge pressures are measured against."""
        return self.constants.get(ATMOSPHERE, USUAL_ATMOSPHERE)


def load_map(path: str | Path) -> Map:
    """The map in the file at `path`. Raises UsageError when it cannot be read or has an error, which it names."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no UTF-8 text"
        raise UsageError(
            f"cannot read the map {path}: {reason}; type: pneumo import TABLE --guess --map {path}"
        ) from error
    try:
        return parse_map(load_yaml(text))
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from error


def parse_map(content: Any) -> Map:
    """The map in the content of a YAML file. Raises UsageError."""
    if not isinstance(content, Mapping) or not all(isinstance(key, str) for key in content):
        raise UsageError(f"a map has the sections {', '.join(SECTIONS)}, such as signals: {{pressure_a: {EXAMPLE}}}")
    if wrong := [key for key in content if key not in SECTIONS]:
        raise UsageError(unknown_name("section", wrong[0], SECTIONS))
    motion = content.get("motion", "free")
    if motion not in MOTIONS:
        raise UsageError(f"motion is {brief(motion)}; it takes {' or '.join(MOTIONS)}")
    signals = _section(content, "signals")
    if wrong := [name for name in signals if name not in SIGNALS]:
        raise UsageError(
            f"signals: {unknown_name('signal', wrong[0], SIGNALS)}; put what else is measured into the section others"
        )
    entries = {name: parse_entry(f"signals.{name}", given) for name, given in signals.items()}
    others = {name: parse_entry(f"others.{name}", given) for name, given in _section(content, "others").items()}
    for name in others:
        _check_other(name)
    for where, one in [*entries.items(), *others.items()]:
        _check_unit(where, one)
    constants = {name: _constant(name, given) for name, given in _section(content, "constants").items()}
    return Map(_timing(content.get("time")), motion == "imposed", constants, entries, others, dict(content))


def _section(content: Mapping[str, Any], name: str) -> dict[str, Any]:
    """One section, by names; empty where it is missing."""
    found = content.get(name)
    if found is None:
        return {}
    if not isinstance(found, Mapping) or not all(isinstance(key, str) for key in found):
        raise UsageError(f"{name} is {brief(found)}; it takes a line for each name, such as pressure_a: {EXAMPLE}")
    return dict(found)


def _timing(given: Any) -> Timing:
    """The section time."""
    if isinstance(given, str):
        return Timing(given, None, None)
    if not isinstance(given, Mapping) or ("column" in given) == ("rate" in given):
        raise UsageError(f"time is {brief(given)}; it takes {_TIME}")
    if wrong := [key for key in given if key not in ("column", "unit", "rate")]:
        raise UsageError(f"time: {unknown_name('key', str(wrong[0]), ('column', 'unit', 'rate'))}")
    if "rate" in given:
        rate = number("time.rate", given["rate"])
        if rate <= 0.0:
            raise UsageError(f"time.rate is {rate:g}; it takes the rows in a second, above 0")
        return Timing(None, None, rate)
    column, unit = given["column"], given.get("unit")
    if not isinstance(column, str) or not (unit is None or isinstance(unit, str)):
        raise UsageError(f"time is {brief(given)}; it takes {_TIME}")
    if unit is not None and unit_of(unit).dimension != "time":
        raise UsageError(f"time.unit is {unit}, a unit of {unit_of(unit).dimension}; it takes s, ms, us, ns or min")
    return Timing(column, unit, None)


def _check_other(name: str) -> None:
    """Raises UsageError for a name that makes no topic, or one of the contract."""
    if not name.replace("_", "a").isalnum() or not name.isascii() or not name[0].isalpha():
        raise UsageError(f"others.{name}: a name has letters, digits and underscores, and begins with a letter")
    if contract.split(f"{OTHERS}/{name}") is not None or name in SIGNALS:
        raise UsageError(
            f"others.{name}: this name has a meaning of its own; put it into signals, or name it otherwise"
        )


def _check_unit(name: str, entry: Entry) -> None:
    """Raises UsageError for an unknown unit, one of another dimension, and one that contradicts `gauge`."""
    if entry.unit is None:
        return
    unit = unit_of(entry.unit)
    allowed = SIGNALS[name].dimensions if name in SIGNALS else ()
    if allowed and unit.dimension not in allowed:
        raise UsageError(
            f"signals.{name}.unit is {entry.unit}, a unit of {unit.dimension}; {SIGNALS[name].words} is measured in "
            f"{' or '.join(SI[one] for one in allowed)}, or another unit of {' or '.join(allowed)}"
        )
    if entry.gauge is not None and unit.dimension != "pressure":
        raise UsageError(f"{name}.gauge is for pressures; its unit is {entry.unit}")
    if unit.gauge is not None and entry.gauge is not None and unit.gauge != entry.gauge:
        raise UsageError(
            f"{name}: unit {entry.unit} says that it is {'gauge' if unit.gauge else 'absolute'}, and gauge: "
            f"{str(entry.gauge).lower()} that it is not; leave one of them out"
        )


def _constant(name: str, given: Any) -> float:
    """A constant in SI units: a number, or {value, unit}."""
    if not isinstance(given, Mapping):
        found = number(f"constants.{name}", given)
    elif set(given) == {"value", "unit"}:
        unit = unit_of(str(given["unit"]))
        found = unit.factor * number(f"constants.{name}.value", given["value"]) + unit.shift
    else:
        raise UsageError(
            f"constants.{name} is {brief(given)}; it takes a number in SI units, or {{value: 1013, unit: mbar}}"
        )
    if name == ATMOSPHERE and not 3e4 <= found <= 1.2e5:
        raise UsageError(f"constants.{name} is {found:g} Pa; the atmosphere has 3e4 to 1.2e5 Pa; give its unit")
    return found
