"""Header stamps of samples: the wall's time of their deadlines, or simulated time."""

import time

_STEP = 10_000_000  # ns; a larger change of the system clock was set, not slewed


class WallStamps:
    """Wall time [ns] of moments on CLOCK_MONOTONIC, as even as these; follows the system clock when it is set."""

    def __init__(self) -> None:
        self._offset = self._measure()
        self._checked = time.monotonic_ns()

    def at(self, moment: int) -> int:
        """Wall time of `moment` [ns, CLOCK_MONOTONIC]."""
        if moment - self._checked > 1_000_000_000:
            self._checked = moment
            offset = self._measure()
            if abs(offset - self._offset) > _STEP:
                self._offset = offset
        return moment + self._offset

    @staticmethod
    def _measure() -> int:
        """Wall clock minus monotonic clock; the fastest of three readings, as any may be interrupted."""
        readings = []
        for _ in range(3):
            before, wall, after = time.monotonic_ns(), time.time_ns(), time.monotonic_ns()
            readings.append((after - before, wall - (before + after) // 2))
        return min(readings)[1]
