"""Corrections of recordings that break the contract: other units, gauge pressures, swapped topics."""

import math
import re
from collections.abc import Sequence
from dataclasses import replace

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.recording import Array, Recording

PRESSURE_UNITS = {"hPa": 1e2, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "psi": 6894.757293168}  # [Pa]
LENGTH_UNITS = {"mm": 1e-3}  # [m]
OTHERS = ("gauge", "swapped-chambers", "reversed-position", "reversed-voltage")
WORDS = (*PRESSURE_UNITS, *OTHERS[:1], *LENGTH_UNITS, *OTHERS[1:])
NUMBERS = {"zero": {"": 1.0, "m": 1.0, "mm": 1e-3}, "closed": {"": 1.0, "V": 1.0}}  # word=NUMBER, and its units
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
    if len(units := [word for word in words if word in PRESSURE_UNITS]) > 1:
        raise UsageError(f"--read-as: pressures are in one unit, not in {' and '.join(units)}")
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


def corrected(recording: Recording, words: Sequence[str], atmospheric_pressure: float) -> Recording:
    """`recording` in SI units and with absolute pressures, when `words` (of WORDS) say how it was recorded.

    `atmospheric_pressure` [Pa] is added to gauge pressures. zero=NUMBER: the position [m] that is read at mid stroke;
    closed=NUMBER: the command [V] that closes the valve.
    """
    numbers = dict(found for word in words if (found := number(word)) is not None)
    length = LENGTH_UNITS["mm"] if "mm" in words else 1.0
    way = -1.0 if "reversed-position" in words else 1.0
    unit = next((factor for word, factor in PRESSURE_UNITS.items() if word in words), 1.0)
    rise = atmospheric_pressure if "gauge" in words else 0.0
    a, b = (_scaled(pressure, unit, rise) for pressure in (recording.pressure_a, recording.pressure_b))
    if "swapped-chambers" in words:
        a, b = b, a
    sign = -1.0 if "reversed-voltage" in words else 1.0
    closed = -sign * numbers.get("closed", 0.0)
    return replace(
        recording,
        position=way * (recording.position * length - numbers.get("zero", 0.0)),
        velocity=_scaled(recording.velocity, way * length),
        pressure_a=a,
        pressure_b=b,
        supply_pressure=_scaled(recording.supply_pressure, unit, rise),
        voltage=_scaled(recording.voltage, sign, closed),
        command=_scaled(recording.command, sign, closed),
    )


def _scaled(signal: Array | None, factor: float, rise: float = 0.0) -> Array | None:
    return None if signal is None else signal * factor + rise
