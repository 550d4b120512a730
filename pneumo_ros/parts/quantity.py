"""Quantities as people write them: "6barg", "0.6 MPa", "87 psi", "250 mm"; values in SI units."""

import math
import re

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name

INCH, POUND, PSI = 0.0254, 0.45359237, 6894.757293168  # m, kg, Pa: by definition
GRAVITY = 9.80665  # m/s2, by definition
CONDUCTANCE = 1e-8  # m3/(s Pa) in 1 dm3/(s bar)
LOOP_RESISTANCE = 500.0  # ohm: a signal of 4 to 20 mA counts as 2 to 10 V, the usual resistor of such inputs

UNITS: dict[str, dict[str, float]] = {
    "length": {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": INCH, '"': INCH},
    "mass": {"g": 1e-3, "kg": 1.0, "t": 1e3, "lb": POUND},
    "pressure": {"Pa": 1.0, "hPa": 1e2, "mbar": 1e2, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "psi": PSI},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "frequency": {"Hz": 1.0, "kHz": 1e3},
    "voltage": {"V": 1.0, "mV": 1e-3, "mA": 1e-3 * LOOP_RESISTANCE},
    "flow": {
        "l/min": 1e-3 / 60.0, "Nl/min": 1e-3 / 60.0, "l/s": 1e-3, "m3/h": 1.0 / 3600.0, "m3/s": 1.0,
        "scfm": 0.3048**3 / 60.0,
    },
    "conductance": {
        "m3/(s Pa)": 1.0, "dm3/(s bar)": CONDUCTANCE, "l/(s bar)": CONDUCTANCE, "dm3/(s MPa)": 0.1 * CONDUCTANCE,
    },
    "angle": {"deg": math.pi / 180.0, "rad": 1.0},
    "speed": {"m/s": 1.0, "mm/s": 1e-3},
    "number": {"1": 1.0, "%": 0.01},
}  # fmt: skip
SI = {
    "length": "m", "mass": "kg", "pressure": "Pa", "time": "s", "frequency": "Hz", "voltage": "V", "flow": "m3/s",
    "conductance": "m3/(s Pa)", "angle": "rad", "speed": "m/s", "number": "1",
}  # fmt: skip
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.DOTALL)
LONGEST = 60  # letters of a quantity


def parse(text: str, dimension: str, what: str, *, plain: str = "", example: str = "") -> float:
    """The value in SI units of a quantity of that dimension (a key of `UNITS`), named `what` in errors.

    A number without a unit is in `plain`, if there is one. UsageError, with the nearest units, for anything else.
    """
    number, unit = split(text, what, example)
    return number * scale(unit or plain, dimension, f"{what} is {brief(text)}", example)


def split(text: str, what: str, example: str = "") -> tuple[float, str]:
    """Number and unit of a text; UsageError where it does not begin with a finite number."""
    match = _NUMBER.fullmatch(text) if len(text) <= LONGEST else None
    if match is None or not math.isfinite(float(match[1])):
        raise UsageError(f"{what} is {brief(text)}; it takes a number with its unit{_such(example)}")
    return float(match[1]), match[2]


def scale(unit: str, dimension: str, said: str, example: str = "") -> float:
    """SI units in one `unit`; UsageError, which begins with what was `said`, with the nearest units."""
    units = UNITS[dimension]
    spelt = {name.replace(" ", "").lower(): name for name in units}
    found = units.get(unit) or units.get(spelt.get(unit.replace(" ", "").lower(), ""))
    if found is None or (dimension in ("pressure", "voltage") and unit[:1] in "mM" and unit not in units):
        if not unit:
            raise UsageError(f"{said}, without a unit; known are {', '.join(units)}{_such(example)}")
        raise UsageError(f"{said}: {unknown_name('unit', unit, units)}{_such(example)}")
    return found


def pressure(text: str, what: str, atmosphere: float) -> float:
    """Absolute pressure [Pa]: barg, bar(g), psig and units without a letter mean gauge; bara, psia, ... absolute."""
    number, unit = split(text, what, "6barg")
    bare = re.sub(r"[\s_]*\(?(abs|[ga])\)?$", "", unit)
    bare = unit if unit in UNITS["pressure"] or bare not in UNITS["pressure"] else bare
    absolute = unit != bare and unit[len(bare) :].strip("() _").startswith("a")
    return number * scale(bare, "pressure", f"{what} is {brief(text)}", "6barg, 7bara") + (
        0.0 if absolute else atmosphere
    )


def _such(example: str) -> str:
    return f", such as {example}" if example else ""
