"""The measurements that a control law reads."""

from typing import NamedTuple


class Measurement(NamedTuple):
    """One sample: time [s], position [m]; velocity [m/s] and pressures [Pa abs] if the plant sends them."""

    time: float
    position: float
    velocity: float | None = None
    pressure_a: float | None = None
    pressure_b: float | None = None
