"""Emptying both chambers through a valve that cannot open both at once."""

from collections.abc import Mapping

MARGIN = 1.05  # times the atmosphere's pressure: a chamber below it counts as empty
PERIOD = 1.0  # s, of opening one side and then the other
SHARE = 0.5  # of the largest voltage; both edges are then nearly fully open
LONGEST = 20.0  # s


class Vent:
    """With the supply shut off, a closed-centre 5/3 valve opened either way empties both chambers: one through its
    exhaust edge, the other back into the shut supply line or, where that is blocked, half a period later.

    Done when both pressures are within 5 % of the atmosphere's; without pressures, and at the latest, after 20 s.
    """

    def __init__(self, begin: float, atmospheric_pressure: float, max_voltage: float) -> None:
        """Begin at time `begin` [s]."""
        self.done = False
        self._begin, self._empty, self._voltage = begin, MARGIN * atmospheric_pressure, SHARE * max_voltage

    def voltage(self, time: float, pressures: Mapping[str, float | None]) -> float:
        """Voltage [V] at `time` [s], from the pressures [Pa abs] of the chambers where they are known; 0 when done."""
        known = [value for value in pressures.values() if value is not None]
        empty = len(known) == len(pressures) and max(known) <= self._empty
        self.done = self.done or empty or time - self._begin > LONGEST
        if self.done:
            return 0.0
        return self._voltage if (time - self._begin) % PERIOD < 0.5 * PERIOD else -self._voltage
