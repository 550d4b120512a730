"""The motion that a control law follows: at one instant, and as a function of time."""

from collections.abc import Callable
from typing import NamedTuple


class Setpoint(NamedTuple):
    """Wanted motion at one instant: position [m], velocity [m/s], acceleration [m/s2], jerk [m/s3]."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0

    def ahead(self, time: float) -> "Setpoint":
        """The motion `time` [s] later, at the present jerk."""
        p, v, a, j = self
        return Setpoint(
            p + time * (v + time * (a / 2.0 + time * j / 6.0)), v + time * (a + time * j / 2.0), a + time * j, j
        )


Reference = Callable[[float], Setpoint]  # time [s] -> Setpoint
