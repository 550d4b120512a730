"""The signals of a machine that columns are mapped to: what each is measured in, and where a recording keeps it."""

from typing import NamedTuple

from pneumo_ros.measured import MEASURED
from pneumo_ros.records import contract

_WAY, _SPEED, _LOAD = ("length", "angle"), ("velocity", "angular velocity"), ("force", "torque")
_DRIVE = ("voltage", "ratio", "current")


class Signal(NamedTuple):
    """`dimensions` of `units` that it may be measured in; `topic` of the recording; `words` in one line."""

    dimensions: tuple[str, ...]
    topic: str
    words: str


SIGNALS = {
    "position": Signal(_WAY, contract.JOINT_STATES, "position"),
    "velocity": Signal(_SPEED, contract.JOINT_STATES, "velocity"),
    "force": Signal(_LOAD, contract.JOINT_STATES, "driving force"),
    "pressure_a": Signal(("pressure",), contract.PRESSURE_A, "pressure in chamber a"),
    "pressure_b": Signal(("pressure",), contract.PRESSURE_B, "pressure in chamber b"),
    **{one.name: Signal(one.dimensions, one.topic, one.meaning.partition(",")[0]) for one in MEASURED},
    "command": Signal(_DRIVE, contract.COMMAND, "valve command"),
}
MOTIONS = ("free", "imposed")
