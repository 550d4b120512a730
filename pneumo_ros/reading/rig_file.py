"""A rig file: which machine a rig is, how it is wired, which signal closes its valve, and how far it may go.

rig:
  machine: my.yaml
  namespace: cylinder_1
  joint: piston
  read_as: bar,gauge,zero=100mm   # as --read-as
  closed: 5V                      # the command that closes the valve
  safe: 5V                        # sent when measurements stop and at the end; without it, the closed signal
  range: 0V..10V                  # commands that the valve takes
  limits: -80mm..80mm             # positions from mid stroke that live work keeps to; -60deg..60deg where it turns
  topics: {joint_states: /plc/encoder, chamber_a/pressure: "/plc/values:data[3]"}   # of its recordings
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pneumo_ros.errors import DataError, UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import Model
from pneumo_ros.plant.axes_section import place_of
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.reading.read import ReadOptions
from pneumo_ros.records.corrections import ANGLE_UNITS, LENGTH_UNITS, parse_words, wiring
from pneumo_ros.records.foreign_topics import VALUES, parse_place
from pneumo_ros.units import COORDINATES, LINE, TURN
from pneumo_ros.yaml_text import load_yaml

HOW = "type: pneumo rig check BAG --model MACHINE --out rig.yaml"
VOLTS = {"": 1.0, "V": 1.0, "mV": 1e-3}
POSITIONS = {LINE: {"m": 1.0, **LENGTH_UNITS}, TURN: {"rad": 1.0, **ANGLE_UNITS}}  # SI in one unit
_LIMITS = {LINE: "-80mm..80mm", TURN: "-60deg..60deg"}  # examples
_TEXTS = ("machine", "namespace", "joint", "read_as")
NULL_OFFSET = 0.5  # V, by which a valve's own zero may differ from the signal that its data sheet names
_SPAN = ".."  # between the ends of a range


@dataclass(frozen=True)
class Travel:
    """Positions from mid stroke that live work keeps to, in the dimension that the file gives them."""

    low: float  # [m], or [rad] where `coordinate` is "rotation"
    high: float
    coordinate: str = ""  # "translation" or "rotation"; empty for plain numbers, which are of any machine
    text: str = field(default="", compare=False)  # as the file has it

    def along(self, coordinate: str, machine: str) -> tuple[float, float]:
        """The two ends in m, or in rad, for the `machine` of that name that moves along a line, or turns.

        Raises UsageError for lengths of a machine that turns, and for angles of one that moves along a line.
        """
        if self.coordinate not in ("", coordinate):
            given, moves = ("lengths", "turns") if coordinate == TURN else ("angles", "moves along a line")
            raise UsageError(
                f"the rig file's limits are {given}, {self.text}, and {machine} {moves}: its limits are in "
                f"{', '.join(POSITIONS[coordinate])}. Write limits: {_LIMITS[coordinate]} into the rig file, say, or "
                f"name another machine"
            )
        return self.low, self.high


@dataclass(frozen=True)
class Rig:
    """What a rig file says; None and empty where it says nothing. Voltages as the valve gets them."""

    machine: str = ""
    namespace: str = ""
    joint: str = ""
    read_as: str = ""
    closed: float | None = None  # [V]
    safe: float | None = None  # [V]
    range: tuple[float, float] | None = None  # [V]
    limits: Travel | None = None
    topics: Mapping[str, str] = field(default_factory=dict)  # name in the contract -> topic of this rig


KEYS = tuple(Rig.__dataclass_fields__)


def read_rig(path: str) -> Rig:
    """The entries of a rig file; a machine file is found beside it.

    Raises DataError when it cannot be read, UsageError, with the nearest names, when it is invalid.
    """
    try:
        document: Any = load_yaml(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no UTF-8 text"
        raise DataError(f"rig file {path} cannot be read ({reason}); {HOW}") from error
    given = document.get("rig") if isinstance(document, dict) else None
    if not isinstance(given, dict):
        raise UsageError(f"rig file {path} has no section 'rig'; {HOW}")
    try:
        rig = _rig({key: value for key, value in given.items() if value is not None})
    except UsageError as error:
        raise UsageError(f"rig file {path}: {error}") from error
    beside = Path(path).parent / rig.machine
    return Rig(**{**vars(rig), "machine": str(beside)}) if rig.machine and Path(place_of(beside)[0]).is_file() else rig


def _rig(given: Mapping[str, Any]) -> Rig:
    if unknown := [key for key in given if key not in KEYS]:
        raise UsageError(unknown_name("entry", str(unknown[0]), KEYS))
    for key in _TEXTS:
        if not isinstance(given.get(key, ""), str):
            raise UsageError(f"{key} is {brief(given[key])}; it takes a text")
    parse_words(given.get("read_as", ""))
    found: dict[str, Any] = {key: given[key] for key in _TEXTS if key in given}
    found |= {key: quantity(given[key], VOLTS, key, "5V") for key in ("closed", "safe") if key in given}
    if "range" in given:
        low, high, _ = _span(given["range"], VOLTS, "range", "0V..10V")
        found["range"] = low, high
    if "limits" in given:
        found["limits"] = _travel(given["limits"])
    found["topics"] = _topics(given.get("topics", {}))
    rig = Rig(**found)
    for name, volts in (("closed", rig.closed), ("safe", rig.safe)):
        if volts is not None and rig.range and not rig.range[0] <= volts <= rig.range[1]:
            raise UsageError(f"{name} is {volts:g} V, outside of the range of {rig.range[0]:g} to {rig.range[1]:g} V")
    return rig


def quantity(given: object, units: Mapping[str, float], name: str, example: str) -> float:
    """A number with its unit as text, or a number in the plain unit; UsageError for anything else."""
    return _with_unit(given, units, name, example)[0]


def _with_unit(given: object, units: Mapping[str, float], name: str, example: str) -> tuple[float, str]:
    text = f"{given:g}" if isinstance(given, int | float) and not isinstance(given, bool) else str(given).strip()
    number = text.rstrip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ ")
    unit = text[len(number) :].strip()
    try:
        value = float(number) * units[unit]
    except (ValueError, KeyError):
        value = math.nan
    if not math.isfinite(value):
        raise UsageError(f"{name} is {brief(given)}; it takes a number with its unit, such as {example}")
    return value, unit


def _span(given: object, units: Mapping[str, float], name: str, example: str) -> tuple[float, float, tuple[str, str]]:
    """Two ends, in SI units, and the units they were given in."""
    parts = given if isinstance(given, list) else str(given).split(_SPAN)
    if len(parts) != 2:
        raise UsageError(f"{name} is {brief(given)}; it takes two ends, such as {example}")
    (low, one), (high, other) = (_with_unit(end, units, name, example) for end in parts)
    if not low < high:
        raise UsageError(f"{name} is {brief(given)}; the first end must be below the second, such as {example}")
    return low, high, (one, other)


def _travel(given: object) -> Travel:
    """Limits, in any unit of positions; an end without a unit is in m, or rad, as the other one says."""
    example = " or ".join(_LIMITS.values())
    text = _SPAN.join(map(str, given)) if isinstance(given, list) else str(given)
    low, high, ends = _span(given, {"": 1.0, **POSITIONS[LINE], **POSITIONS[TURN]}, "limits", example)
    named = [one for one in COORDINATES if any(unit in POSITIONS[one] for unit in ends)]
    if len(named) > 1:
        raise UsageError(f"limits is {brief(given)}, a length and an angle; it takes two of one, such as {example}")
    return Travel(low, high, "".join(named), text)


def _topics(given: object) -> dict[str, str]:
    if not isinstance(given, dict) or not all(isinstance(value, str) for value in given.values()):
        raise UsageError(f"topics is {brief(given)}; it takes name: topic, such as joint_states: /plc/encoder")
    if unknown := [name for name in given if name not in VALUES]:
        raise UsageError(unknown_name("topic", str(unknown[0]), VALUES))
    if wrong := [place for place in given.values() if parse_place(place) is None]:
        raise UsageError(f"topics: {brief(wrong[0])} is no topic; it takes /plc/encoder, or /plc/values:data[3]")
    return {str(name): str(topic) for name, topic in given.items()}


def reading_of(rig: Rig, model: Model) -> ReadOptions:
    """How recordings of the rig are read for its machine; UsageError where file and machine contradict each other."""
    if rig.limits:
        rig.limits.along(model.coordinate, model.name)
    words = with_closed(parse_words(rig.read_as), rig.closed, closed_signal(model))
    return ReadOptions(rig.namespace or None, rig.joint or None, words, topics=tuple(rig.topics.items()))


def with_closed(words: tuple[str, ...], named: float | None, closed: float) -> tuple[str, ...]:
    """`words` of a wiring with which the machine's `closed` [V] becomes the signal `named` [V].

    The machine may know its valve's own zero, up to NULL_OFFSET beside what a data sheet names: this is kept. Raises
    UsageError where the words say another closed signal.
    """
    if named is None:
        return words
    sent = wiring(words).command(closed)
    if abs(sent - named) <= NULL_OFFSET:
        return words
    if any(word.startswith("closed=") for word in words):
        raise UsageError(f"the valve is said to close at {named:g} V, and by machine file and wiring at {sent:g} V")
    return (*words, f"closed={named - sent:.6g}V")
