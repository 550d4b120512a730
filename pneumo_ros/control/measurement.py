"""What a control law gets to see of the axis."""

from typing import NamedTuple


class Measurement(NamedTuple):
    """One sample: time [s], position [m], and where the plant sends them velocity [m/s] and pressures [Pa abs]."""

    time: float
    position: float
    velocity: float | None = None
    pressure_a: float | None = None
    pressure_b: float | None = None
