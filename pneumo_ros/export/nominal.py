"""Usual sizes of states, which an integrator needs to know what is small."""

from pneumo_ros.export.machine import Variable

_BY_NAME = {"y": 0.1, "v": 0.1}
_BY_UNIT = {"Pa": 1e5, "m": 1e-5, "m/s": 0.1, "kg/s": 1e-3, "V": 1.0, "K": 300.0, "s": 1.0}


def nominal(state: Variable) -> float:
    """Usual size of a state in its unit: micrometres for deflections and play, 0.1 m for the piston's position."""
    return _BY_NAME.get(state.name, _BY_UNIT.get(state.unit, 1.0))
