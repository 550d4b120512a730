"""Units of measured columns: dimension, factor and shift to SI, and whether pressures are above the atmosphere's."""

from typing import NamedTuple

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

_INCH, _POUND, _GRAVITY = 0.0254, 0.45359237, 9.80665  # m, kg and m/s2: exact by definition
_PSI = _POUND * _GRAVITY / _INCH**2
_DEGREE = 0.017453292519943295  # rad


class Unit(NamedTuple):
    """value in SI = factor * value + shift; `gauge` None says nothing on what a pressure is measured against."""

    dimension: str
    factor: float
    shift: float = 0.0
    gauge: bool | None = None


SI = {
    "length": "m", "angle": "rad", "time": "s", "velocity": "m/s", "angular velocity": "rad/s", "pressure": "Pa",
    "force": "N", "torque": "N m", "voltage": "V", "current": "A", "ratio": "1", "temperature": "K",
    "acceleration": "m/s2", "power": "W", "mass flow": "kg/s",
}  # fmt: skip

UNITS = {
    "m": Unit("length", 1.0), "cm": Unit("length", 1e-2), "mm": Unit("length", 1e-3), "um": Unit("length", 1e-6),
    "nm": Unit("length", 1e-9), "in": Unit("length", _INCH), "ft": Unit("length", 12.0 * _INCH),
    "rad": Unit("angle", 1.0), "mrad": Unit("angle", 1e-3), "deg": Unit("angle", _DEGREE),
    "rev": Unit("angle", 360.0 * _DEGREE),
    "s": Unit("time", 1.0), "ms": Unit("time", 1e-3), "us": Unit("time", 1e-6), "ns": Unit("time", 1e-9),
    "min": Unit("time", 60.0),
    "m/s": Unit("velocity", 1.0), "cm/s": Unit("velocity", 1e-2), "mm/s": Unit("velocity", 1e-3),
    "in/s": Unit("velocity", _INCH), "ft/s": Unit("velocity", 12.0 * _INCH),
    "rad/s": Unit("angular velocity", 1.0), "deg/s": Unit("angular velocity", _DEGREE),
    "rpm": Unit("angular velocity", 6.0 * _DEGREE),
    "Pa": Unit("pressure", 1.0), "hPa": Unit("pressure", 1e2), "kPa": Unit("pressure", 1e3),
    "MPa": Unit("pressure", 1e6), "bar": Unit("pressure", 1e5), "mbar": Unit("pressure", 1e2),
    "psi": Unit("pressure", _PSI), "atm": Unit("pressure", 101325.0),
    "bara": Unit("pressure", 1e5, gauge=False), "barg": Unit("pressure", 1e5, gauge=True),
    "psia": Unit("pressure", _PSI, gauge=False), "psig": Unit("pressure", _PSI, gauge=True),
    "N": Unit("force", 1.0), "mN": Unit("force", 1e-3), "kN": Unit("force", 1e3),
    "lbf": Unit("force", _POUND * _GRAVITY), "kgf": Unit("force", _GRAVITY),
    "N m": Unit("torque", 1.0), "N mm": Unit("torque", 1e-3), "kN m": Unit("torque", 1e3),
    "lbf in": Unit("torque", _POUND * _GRAVITY * _INCH), "lbf ft": Unit("torque", 12.0 * _POUND * _GRAVITY * _INCH),
    "V": Unit("voltage", 1.0), "mV": Unit("voltage", 1e-3),
    "A": Unit("current", 1.0), "mA": Unit("current", 1e-3),
    "1": Unit("ratio", 1.0), "%": Unit("ratio", 1e-2),
    "K": Unit("temperature", 1.0), "degC": Unit("temperature", 1.0, 273.15),
    "degF": Unit("temperature", 5.0 / 9.0, 459.67 * 5.0 / 9.0),
    "m/s2": Unit("acceleration", 1.0), "W": Unit("power", 1.0),
    "kg/s": Unit("mass flow", 1.0), "g/s": Unit("mass flow", 1e-3), "Nl/min": Unit("mass flow", 1.185e-3 / 60.0),  # ANR
}  # fmt: skip
# other spellings
_ALIASES = {
    "metre": "m", "meter": "m", "inch": "in", "inches": "in", '"': "in", "feet": "ft", "radian": "rad",
    "radians": "rad", "degree": "deg", "degrees": "deg", "°": "deg", "sec": "s", "second": "s", "seconds": "s",
    "msec": "ms", "usec": "us", "µs": "us", "μs": "us", "µm": "um", "μm": "um", "mps": "m/s", "ips": "in/s",
    "1/min": "rpm", "°/s": "deg/s", "bar(a)": "bara", "bar(g)": "barg", "bar abs": "bara", "bar rel": "barg",
    "lb": "lbf", "lbs": "lbf", "pounds": "lbf", "kp": "kgf", "nm": "nm", "Nm": "N m", "N*m": "N m", "N.m": "N m",
    "N·m": "N m", "Nmm": "N mm", "kNm": "kN m", "in-lbf": "lbf in", "ft-lbf": "lbf ft", "volt": "V", "volts": "V",
    "amp": "A", "amps": "A", "percent": "%", "-": "1", "°C": "degC", "°F": "degF", "m/s^2": "m/s2", "m/s²": "m/s2",
}  # fmt: skip


def find_unit(name: str) -> Unit | None:
    """The unit called `name`, in any of its spellings; None for an unknown one."""
    text = " ".join(name.split())
    for given in (text, text.replace(" ", "")):
        if (known := _ALIASES.get(given, given)) in UNITS:
            return UNITS[known]
    # capitals decide only where two units differ in nothing else
    alike = {_ALIASES.get(known, known) for known in (*UNITS, *_ALIASES) if known.lower() == text.lower()}
    return UNITS[alike.pop()] if len(alike) == 1 else None


def unit_of(name: str) -> Unit:
    """The unit called `name`. Raises UsageError for an unknown one."""
    found = find_unit(name)
    if found is None:
        raise UsageError(unknown_name("unit", name, UNITS))
    return found
