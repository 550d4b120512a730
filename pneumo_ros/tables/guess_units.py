"""Units of columns without one in their heading, by the range of their values; gauge pressures; unsigned integers."""

import numpy as np

from pneumo_ros.records.recording import Array
from pneumo_ros.tables.units import Unit

# the highest value of a usual machine in each unit
_PRESSURES = (("MPa", 1.2), ("bar", 13.0), ("psi", 145.0), ("kPa", 1300.0), ("hPa", 1e4))
_METRES, _MILLIMETRES = 5.0, 5e3  # farther than such a machine moves
_GAUGE, _ABSOLUTE = 5e4, 1.5e5  # Pa: pressures that fall below are gauge; those that stay above do not show it
_BITS = (8, 16, 32)
# position's unit -> the rate of the position over a velocity in each unit
_RATES = {
    "m": {"m/s": 1.0, "mm/s": 1e-3}, "mm": {"mm/s": 1.0, "m/s": 1e3}, "um": {"mm/s": 1e3, "m/s": 1e6},
    "in": {"in/s": 1.0}, "rad": {"rad/s": 1.0, "deg/s": 0.01745, "rpm": 0.1047},
    "deg": {"deg/s": 1.0, "rad/s": 57.3, "rpm": 6.0},
}  # fmt: skip


def unit_by_range(signal: str, low: float, high: float, words: str) -> tuple[str, str]:
    """A unit for values from `low` to `high`, and a sentence on what could not be decided, empty where all was."""
    most = max(abs(low), abs(high))
    if "pressure" in signal:
        unit = next((name for name, limit in _PRESSURES if most < limit), "Pa")
        return unit, f"{signal} has no unit; {unit} fits its range"
    if signal in ("position", "reference"):
        if any(word in words for word in ("angle", "theta", "joint", "rad")):
            return ("rad", "") if most < 20.0 else ("deg", "")
        unit = "m" if most < _METRES else "mm" if most < _MILLIMETRES else "um"
        return unit, f"{signal} has no unit; {unit} fits its range" + (", and so does rad" if unit == "m" else "")
    if signal == "command":
        unit = "1" if most <= 1.0 else "V" if most <= 24.0 else "%" if most <= 100.0 else "mV"
        return unit, f"command has no unit; {unit} fits its range"
    unit = {"velocity": "m/s"}.get(signal, "N")
    return unit, f"{signal} has no unit; {unit} is a guess"


def gauge_by_range(signal: str, unit: Unit, low: float) -> tuple[bool, str]:
    """Whether a pressure that falls to `low` [unit] is gauge, and a sentence on what could not be decided."""
    if unit.gauge is not None:
        return unit.gauge, ""
    lowest = unit.factor * low
    if lowest < _GAUGE:
        return True, ""
    if lowest > _ABSOLUTE:
        return False, f"{signal} never falls near the atmosphere's pressure: it may be gauge; then type gauge: true"
    return False, ""


def velocity_unit(position_unit: str, slope: float) -> tuple[str, str] | None:
    """Unit of a velocity, where `slope` is the rate of the position over it; None where no unit fits."""
    for name, ratio in _RATES.get(position_unit, {}).items():
        if 0.7 * ratio < abs(slope) < 1.4 * ratio:
            return name, f"{slope / ratio:.3g} times the rate of the position"
    return None


def unsigned_bits(values: Array) -> int | None:
    """Bits of the integers whose negative values were written as positive ones; None where they were not."""
    good = values[np.isfinite(values)]
    if not len(good) or good.min() < 0.0 or (good != np.rint(good)).any():
        return None
    for bits in _BITS:
        full = 2.0**bits
        high = good >= 0.75 * full
        if good.max() < full and high.any() and (good <= 0.25 * full).any() and (high | (good <= 0.25 * full)).all():
            return bits
    return None
