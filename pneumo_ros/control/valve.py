"""Inverse of the valve's dead zone: the voltage that gives a wanted opening."""

import math
from dataclasses import dataclass, replace

from pneumo_ros.errors import UsageError


@dataclass(frozen=True)
class ValveInverse:
    """Voltage for a wanted opening, both in V, and the limits of the voltage.

    Dead zone as in the plant (its `dead_zone` effect): opening = m_r (U - u_r) above u_r, m_l (U + u_l) below -u_l.
    Its exact inverse jumps by u_r + u_l at zero, and noise would make the valve chatter. `smoothing` [V] is the opening
    at which the jump is complete; below it the jump is linear. Raises UsageError for values that no valve has.
    """

    right_limit: float = 0.78
    left_limit: float = 0.78
    right_slope: float = 1.0
    left_slope: float = 1.0
    smoothing: float = 0.02
    max_voltage: float = 10.0

    def __post_init__(self) -> None:
        values = vars(self)
        bad = [name for name, value in values.items() if not math.isfinite(value) or value < 0.0]
        bad += [name for name in ("right_slope", "left_slope", "max_voltage") if values[name] <= 0.0]
        if bad:
            raise UsageError(f"{bad[0]} is {values[bad[0]]!r}; it takes a positive number")
        if self.max_voltage <= max(self.right_limit, self.left_limit):
            raise UsageError(
                f"max_voltage is {self.max_voltage:g} V, inside the dead zone of -{self.left_limit:g} to "
                f"{self.right_limit:g} V; the valve would never open"
            )

    def voltage(self, opening: float) -> float:
        """Voltage [V] for `opening` [V], within +-max_voltage."""
        if opening >= 0.0:
            return min(self.right_limit * self._share(opening) + opening / self.right_slope, self.max_voltage)
        return max(-self.left_limit * self._share(-opening) + opening / self.left_slope, -self.max_voltage)

    def clip(self, opening: float) -> float:
        """`opening` [V] within what the voltage limits allow."""
        high = self.right_slope * (self.max_voltage - self.right_limit)
        low = self.left_slope * (self.left_limit - self.max_voltage)
        return min(max(opening, low), high)

    def with_values(self, **values: float) -> "ValveInverse":
        """A valve with other values; UsageError for values that no valve has, TypeError for unknown names."""
        return replace(self, **values)

    def _share(self, size: float) -> float:
        return min(size / self.smoothing, 1.0) if self.smoothing > 0.0 else float(size > 0.0)
