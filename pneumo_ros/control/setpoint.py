"""What a control law is to follow: wanted motion at one instant, and as a function of time."""

from collections.abc import Callable
from typing import NamedTuple


class Setpoint(NamedTuple):
    """Wanted motion at one instant: position [m], velocity [m/s], acceleration [m/s2], jerk [m/s3]."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


Reference = Callable[[float], Setpoint]  # time [s] -> Setpoint
