"""Corrections of recordings that break the contract: other units, gauge pressures, swapped topics."""

from collections.abc import Sequence
from dataclasses import replace

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.recording import Array, Recording

PRESSURE_UNITS = {"hPa": 1e2, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "psi": 6894.757293168}  # [Pa]
LENGTH_UNITS = {"mm": 1e-3}  # [m]
OTHERS = ("gauge", "swapped-chambers", "reversed-position", "reversed-voltage")
WORDS = (*PRESSURE_UNITS, *OTHERS[:1], *LENGTH_UNITS, *OTHERS[1:])


def parse_words(text: str) -> tuple[str, ...]:
    """The words of `--read-as WORD,WORD`. Raises UsageError for an unknown word, and for two units of pressure."""
    spelling = {word.lower(): word for word in WORDS}
    given = [word.strip() for word in text.split(",") if word.strip()]
    if wrong := [word for word in given if word.lower() not in spelling]:
        raise UsageError(f"--read-as: {unknown_name('word', wrong[0], WORDS)}")
    words = tuple(dict.fromkeys(spelling[word.lower()] for word in given))
    if len(units := [word for word in words if word in PRESSURE_UNITS]) > 1:
        raise UsageError(f"--read-as: pressures are in one unit, not in {' and '.join(units)}")
    return words


def corrected(recording: Recording, words: Sequence[str], atmospheric_pressure: float) -> Recording:
    """`recording` in SI units and with absolute pressures, when `words` (of WORDS) say how it was recorded.

    `atmospheric_pressure` [Pa] is added to gauge pressures.
    """
    length = LENGTH_UNITS["mm"] if "mm" in words else 1.0
    length *= -1.0 if "reversed-position" in words else 1.0
    unit = next((factor for word, factor in PRESSURE_UNITS.items() if word in words), 1.0)
    rise = atmospheric_pressure if "gauge" in words else 0.0
    a, b = (_scaled(pressure, unit, rise) for pressure in (recording.pressure_a, recording.pressure_b))
    if "swapped-chambers" in words:
        a, b = b, a
    sign = -1.0 if "reversed-voltage" in words else 1.0
    return replace(
        recording,
        position=recording.position * length,
        velocity=_scaled(recording.velocity, length),
        pressure_a=a,
        pressure_b=b,
        supply_pressure=_scaled(recording.supply_pressure, unit, rise),
        voltage=_scaled(recording.voltage, sign),
        command=_scaled(recording.command, sign),
    )


def _scaled(signal: Array | None, factor: float, rise: float = 0.0) -> Array | None:
    return None if signal is None else signal * factor + rise
