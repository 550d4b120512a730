"""The supply pressure as measured: lost, shut off, or what the machine file says."""

import math

from pneumo_ros.errors import UsageError

DEAD = 1.3  # times atmospheric pressure: the highest pressure of a supply that is shut off
SILENT = 5.0  # s; an older pressure is not known any more
CHANGE = 0.02  # relative; a smaller change leaves the limits as they are


class Supply:
    """`pressure` [Pa abs] is None where nobody measures it; below `least` it counts as lost."""

    def __init__(self) -> None:
        """Not measured yet."""
        self.pressure: float | None = None
        self.silent = False  # whether it was measured once, and nobody sends it any more
        self._time = 0.0
        self.least = 0.0
        self._noted: float | None = None

    @property
    def lost(self) -> bool:
        """Whether the pressure is known to be too low to move anything."""
        return self.pressure is not None and self.pressure < self.least

    def age(self, time: float) -> None:
        """At `time` [s] of the loop: a pressure that nobody has sent for SILENT is not known any more.

        A supply that was lost stays lost.
        """
        if self.pressure is not None and not self.lost and time - self._time > SILENT:
            self.pressure, self.silent = None, True

    def take(self, pressure: float, time: float = 0.0) -> bool:
        """Take a measurement [Pa abs] at `time` [s]; whether it changed by more than CHANGE.

        Raises UsageError if it is not finite.
        """
        if not math.isfinite(pressure):
            raise UsageError(f"supply pressure {pressure!r} is no finite number")
        self.pressure, self.silent, self._time = pressure, False, time
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
