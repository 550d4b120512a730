"""Where a piston may go, and how fast."""

import math
from dataclasses import dataclass, replace

from pneumo_ros.errors import UsageError


@dataclass(frozen=True)
class Limits:
    """Positions from `low` to `high` [m]; largest speed [m/s], acceleration [m/s2] and jerk [m/s3], both ways.

    Raises UsageError for values that leave no room to move.
    """

    low: float = -1.0
    high: float = 1.0
    speed: float = 0.12
    acceleration: float = 1.0
    jerk: float = 20.0

    def __post_init__(self) -> None:
        for name in ("speed", "acceleration", "jerk"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise UsageError(f"limit of {name} is {value!r}; it takes a positive number")
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise UsageError(f"limits of position are {self.low!r} to {self.high!r} m; the first must be smaller")

    def on_stroke(self, stroke: float) -> "Limits":
        """The same within +-`stroke` / 2 [m]."""
        return replace(self, low=max(self.low, -0.5 * stroke), high=min(self.high, 0.5 * stroke))

    def clip(self, position: float) -> float:
        """`position` [m], or the nearest one that is allowed."""
        return min(max(position, self.low), self.high)

    def require(self, position: float) -> None:
        """Raise UsageError unless `position` [m] is finite and within the limits."""
        if not math.isfinite(position):
            raise UsageError(f"position {position!r} is no finite number")
        if not self.low <= position <= self.high:
            raise UsageError(f"position {position:g} m is outside {self.low:g} to {self.high:g} m")
