"""What a user says of a machine, as text: mounting, sensors, signal and flow of the valve."""

import math
import re
from collections.abc import Mapping

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.parts.figure import Figure, given
from pneumo_ros.parts.quantity import CONDUCTANCE, LONGEST, parse

MOUNTINGS = {"horizontal": 0.0, "vertical": 90.0, "vertical-down": -90.0}  # deg: the rod lifts, or lowers, the load
SENSORS = ("Pa", "hPa", "kPa", "bar", "MPa", "psi")
_PIECE = re.compile(r"\s*(?:(qn|Kv|Cv|C|b)\s*[=:]?\s*)?([+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^,;]*?)\s*", re.IGNORECASE)
_FIGURES = {
    "qn": ("nominal_flow", "flow", "l/min"),
    "c": ("conductance_filling", "conductance", "dm3/(s bar)"),
    "b": ("critical_ratio_filling", "number", "1"),
    "kv": ("kv", "number", "1"),
    "cv": ("cv", "number", "1"),
}
FLOW_FORMS = "'qn 700 l/min', 'C 2.8, b 0.3' (in dm3/(s bar)), 'Kv 0.4' or 'Cv 0.5'"


def tilt(text: str) -> float:
    """Angle [rad] of a mounting: a name of MOUNTINGS, or degrees, above 0 where the rod lifts the load."""
    if text in MOUNTINGS:
        return math.radians(MOUNTINGS[text])
    if text[:1].isalpha():
        raise UsageError(f"{unknown_name('mounting', text[:LONGEST], MOUNTINGS)} An angle works, too, such as 30deg")
    return parse(text, "angle", "the mounting", plain="deg", example="vertical, or 30deg")


def read_as(sensors: str) -> str:
    """The words of --read-as for pressure sensors such as gauge-bar or absolute-Pa; empty for absolute pascals."""
    zero, dash, unit = sensors.partition("-")
    if zero not in ("gauge", "absolute") or not dash or unit not in SENSORS:
        choices = [f"{one}-{name}" for one in ("gauge", "absolute") for name in SENSORS]
        raise UsageError(unknown_name("sensors", sensors[:LONGEST], choices))
    return ",".join(word for word in (zero, unit) if word not in ("absolute", "Pa"))


def signal(text: str) -> dict[str, Figure]:
    """Figures of LOW,CLOSED,HIGH in volts, such as 0,5,10, or 4,12,20mA; UsageError unless they rise.

    A unit after HIGH alone is that of all three. A current counts as the voltage that it makes in LOOP_RESISTANCE.
    """
    parts = text.split(",")
    if len(parts) != 3:
        raise UsageError(f"the signal is {brief(text)}; it takes LOW,CLOSED,HIGH, such as 0,5,10 (volts) or 4,12,20mA")
    unit = re.sub(r"^[\s\d.eE+-]*", "", parts[2]).strip() or "V"
    low, closed, high = (
        parse(one, "voltage", "the signal", plain=unit, example="0,5,10 or 4,12,20mA") for one in parts
    )
    if not low < closed < high:
        raise UsageError(f"the signal is {brief(text)}; LOW, CLOSED and HIGH rise, such as 0,5,10")
    return {f"signal_{name}": given(v, "V") for name, v in (("low", low), ("closed", closed), ("high", high))}


def flow(text: str) -> Mapping[str, Figure]:
    """Figures of a valve's flow, such as those of FLOW_FORMS; a flow without a name is a nominal flow."""
    found: dict[str, Figure] = {}
    for piece in re.split(r"[,;]", text):
        match = _PIECE.fullmatch(piece) if len(text) <= 2 * LONGEST else None
        if match is None:
            raise UsageError(f"the flow of the valve is {brief(text)}; it takes {FLOW_FORMS}")
        name, dimension, plain = _FIGURES[(match[1] or "qn").lower()]
        value = parse(match[2], dimension, "the flow of the valve", plain=plain, example=FLOW_FORMS)
        if not value > 0.0 or (dimension == "number" and name.startswith("critical") and value >= 1.0):
            raise UsageError(f"the flow of the valve is {brief(text)}; its figures are above 0, and b below 1")
        found[name] = given(value, {"flow": "m3/s", "conductance": "m3/(s Pa)"}.get(dimension, "1"))
    sizes = [name for name in found if not name.startswith("critical")]
    if len(sizes) != 1:
        raise UsageError(f"the flow of the valve is {brief(text)}; it takes one of {FLOW_FORMS}")
    return found


def conductance_text(conductance: float) -> str:
    """C in the unit of data sheets."""
    return f"{conductance / CONDUCTANCE:.3g} dm3/(s bar)"
