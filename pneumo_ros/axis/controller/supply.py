"""The supply pressure as measured: lost, shut off, or what the machine file says."""

import math

from pneumo_ros.errors import UsageError

DEAD = 1.3  # times atmospheric pressure: the highest pressure of a supply that is shut off
CHANGE = 0.02  # relative; a smaller change leaves the limits as they are


class Supply:
    """`pressure` [Pa abs] is None where nobody measures it; below `least` it counts as lost."""

    def __init__(self) -> None:
        """Not measured yet."""
        self.pressure: float | None = None
        self.least = 0.0
        self._noted: float | None = None

    @property
    def lost(self) -> bool:
        """Whether the pressure is known to be too low to move anything."""
        return self.pressure is not None and self.pressure < self.least

    def take(self, pressure: float) -> bool:
        """Take a measurement [Pa abs]; whether it changed by more than CHANGE. UsageError if not finite."""
        if not math.isfinite(pressure):
            raise UsageError(f"supply pressure {pressure!r} is no finite number")
        self.pressure = pressure
        if self._noted is not None and abs(pressure - self._noted) <= CHANGE * self._noted:
            return False
        self._noted = pressure
        return True

    def require_shut_off(self, atmosphere: float, unseen: bool) -> None:
        """Raise UsageError unless the supply is shut off, as measured or, if not measured, as `unseen` says."""
        if self.pressure is None and not unseen:
            raise UsageError(
                "no supply/pressure shows that the supply is shut off; shut it, then set vent_unseen to true"
            )
        if not self.shut_off(atmosphere):
            raise UsageError(
                f"the supply pressure is {self.pressure:.4g} Pa; shut it off first, "
                f"to {DEAD * atmosphere:.4g} Pa or less"
            )

    def shut_off(self, atmosphere: float) -> bool:
        """Whether the supply is shut off or not measured; `atmosphere` [Pa abs]."""
        return self.pressure is None or self.pressure <= DEAD * atmosphere
