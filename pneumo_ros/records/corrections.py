"""Corrections of recordings that break the contract: other units, gauge pressures, swapped or dead sensors."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.recording import Array, Recording

PRESSURE_UNITS = {"hPa": 1e2, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "psi": 6894.757293168}  # [Pa]
LENGTH_UNITS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254}  # [m]
ANGLE_UNITS = {"deg": math.pi / 180.0, "mrad": 1e-3, "rev": 2.0 * math.pi}  # [rad]
POSITION_UNITS = LENGTH_UNITS | ANGLE_UNITS
FORCE_UNITS = {"kN": 1e3, "lbf": 4.4482216152605}  # [N], of effort and load cell
OTHERS = (
    "gauge", "gauge-supply", "swapped-chambers", "reversed-position", "reversed-voltage", "reversed-force",
)  # fmt: skip
LEFT_OUT = {  # word -> fields of a recording that are not used: those of a dead sensor, or of a valve without a model
    "no-pressure-a": ("pressure_a",), "no-pressure-b": ("pressure_b",), "no-supply": ("supply_pressure",),
    "no-effort": ("effort",), "no-load-cell": ("load_cell",),
    "no-command": ("voltage", "command_time", "command", "command_b_time", "command_b"),
}  # fmt: skip
WORDS = (*PRESSURE_UNITS, *POSITION_UNITS, *FORCE_UNITS, *OTHERS, *LEFT_OUT)
NUMBERS = {  # word=NUMBER, and its units
    "zero": {"": 1.0, "m": 1.0, "mm": 1e-3, "rad": 1.0, "deg": ANGLE_UNITS["deg"]},
    "closed": {"": 1.0, "V": 1.0},
}
EXAMPLES = ("zero=125mm", "closed=5V")
_NUMBER = re.compile(r"(?P<name>\w+)=(?P<value>[-+0-9.eE]+)(?P<unit>[a-zA-Z]*)")


def parse_words(text: str) -> tuple[str, ...]:
    """The words of `--read-as WORD,WORD`. Raises UsageError for an unknown word, and for two units of pressure."""
    spelling = {word.lower(): word for word in WORDS}
    given = [word.strip() for word in text.split(",") if word.strip()]
    if wrong := [word for word in given if word.lower() not in spelling and number(word) is None]:
        allowed = (*WORDS, *EXAMPLES)
        raise UsageError(f"--read-as: {unknown_name('word', wrong[0], allowed)}")
    words = tuple(dict.fromkeys(spelling.get(word.lower(), word) for word in given))
    for what, kinds in (("pressures", PRESSURE_UNITS), ("positions", POSITION_UNITS), ("forces", FORCE_UNITS)):
        if len(units := [word for word in words if word in kinds]) > 1:
            raise UsageError(f"--read-as: {what} are in one unit, not in {' and '.join(units)}")
    return words


def number(word: str) -> tuple[str, float] | None:
    """Name and value in SI units of a word such as zero=125mm or closed=5V; None for another word."""
    match = _NUMBER.fullmatch(word)
    if match is None or match["name"] not in NUMBERS or match["unit"] not in NUMBERS[match["name"]]:
        return None
    try:
        value = float(match["value"])
    except ValueError:
        return None
    return (match["name"], value * NUMBERS[match["name"]][match["unit"]]) if math.isfinite(value) else None


@dataclass(frozen=True)
class Wiring:
    """What the words of --read-as say, for an axis that is moved while it is read, or that plays such a rig."""

    length: float = 1.0  # [m] one unit of the position
    zero: float = 0.0  # [m] read at mid stroke
    way: float = 1.0  # -1: reversed
    sign: float = 1.0  # -1: reversed
    closed: float = 0.0  # [V] sent where the machine takes 0 V
    unit: float = 1.0  # [Pa] one unit of the pressures
    gauge: bool = False  # pressures are above the atmosphere's
    swapped: bool = False  # the sensor of chamber a shows chamber b

    def position(self, read: float) -> float:
        """Position [m] from mid stroke, of what the sensor sends."""
        return self.way * (read * self.length - self.zero)

    def velocity(self, read: float | None) -> float | None:
        """Velocity [m/s] of what the sensor sends."""
        return None if read is None else self.way * self.length * read

    def command(self, volts: float) -> float:
        """The command to send [V] for `volts` at the machine's valve."""
        return self.sign * volts + self.closed

    def pressure(self, read: float, atmosphere: float) -> float:
        """Absolute pressure [Pa] of what a sensor sends; `atmosphere` [Pa, absolute]."""
        return read * self.unit + (atmosphere if self.gauge else 0.0)

    def chamber(self, topic: str) -> str:
        """The chamber, a or b, that the sensor on the topic of chamber `topic` is plugged to."""
        return {"a": "b", "b": "a"}[topic] if self.swapped else topic

    def shown_position(self, position: float) -> float:
        """What the sensor sends at `position` [m]; the inverse of `position`."""
        return (self.way * position + self.zero) / self.length

    def shown_pressures(self, a: float, b: float, atmosphere: float) -> tuple[float, float]:
        """What both sensors send at absolute pressures [Pa]; the inverse of `pressure` and `chamber`."""
        rise = atmosphere if self.gauge else 0.0
        first, second = ((one - rise) / self.unit for one in ((b, a) if self.swapped else (a, b)))
        return first, second

    def volts(self, sent: float) -> float:
        """The voltage [V] at the machine's valve for a command that was sent; the inverse of `command`."""
        return self.sign * (sent - self.closed)


def wiring(words: Sequence[str]) -> Wiring:
    """The wiring that `words` (of WORDS) say."""
    numbers = dict(found for word in words if (found := number(word)) is not None)
    return Wiring(
        _unit(POSITION_UNITS, words),
        numbers.get("zero", 0.0),
        -1.0 if "reversed-position" in words else 1.0,
        -1.0 if "reversed-voltage" in words else 1.0,
        numbers.get("closed", 0.0),
        _unit(PRESSURE_UNITS, words),
        "gauge" in words,
        "swapped-chambers" in words,
    )


def corrected(recording: Recording, words: Sequence[str], atmospheric_pressure: float) -> Recording:
    """`recording` in SI units and with absolute pressures, when `words` (of WORDS) say how it was recorded.

    `atmospheric_pressure` [Pa] is added to gauge pressures. zero=NUMBER: the position [m] that is read at mid stroke;
    closed=NUMBER: the command [V] that closes the valve. What a word of LEFT_OUT names becomes None.
    """
    wired = wiring(words)
    force = _unit(FORCE_UNITS, words) * (-1.0 if "reversed-force" in words else 1.0)
    rise = atmospheric_pressure if wired.gauge else 0.0
    a, b = (_scaled(pressure, wired.unit, rise) for pressure in (recording.pressure_a, recording.pressure_b))
    if wired.swapped:
        a, b = b, a
    sign, closed = wired.sign, -wired.sign * wired.closed
    absent = {name: None for word in words if word in LEFT_OUT for name in LEFT_OUT[word]}
    supplied = atmospheric_pressure if "gauge-supply" in words else rise
    mended = replace(
        recording,
        position=wired.way * (recording.position * wired.length - wired.zero),
        velocity=_scaled(recording.velocity, wired.way * wired.length),
        pressure_a=a,
        pressure_b=b,
        supply_pressure=_scaled(recording.supply_pressure, wired.unit, supplied),
        effort=_scaled(recording.effort, force),
        load_cell=_scaled(recording.load_cell, force),
        voltage=_scaled(recording.voltage, sign, closed),
        command=_scaled(recording.command, sign, closed),
        command_b=_scaled(recording.command_b, sign, closed),
    )
    return replace(mended, **absent)  # type: ignore[arg-type]


def _unit(units: Mapping[str, float], words: Sequence[str]) -> float:
    return next((factor for word, factor in units.items() if word in words), 1.0)


def _scaled(signal: Array | None, factor: float, rise: float = 0.0) -> Array | None:
    return None if signal is None else signal * factor + rise
