"""The valve command as it comes in: refused, clipped, timed within a sample, and dropped when it is too old."""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray


class ValveInput:
    """Commands with their times of arrival, and the voltage in force.

    `accept` may be called by another thread than `hold`.
    """

    def __init__(self, max_voltage: float, timeout: float, closed: float = 0.0) -> None:
        """Clip at +-`max_voltage` [V]; the valve closes `timeout` [s, simulated] after the last command, 0: never.

        `closed` [V]: the signal that closes it.
        """
        self.max_voltage, self.timeout, self.closed = max_voltage, timeout, closed
        self.accepted = self.refused = self.clipped = self.expired = 0
        self._arrived: deque[tuple[int, float]] = deque(maxlen=10_000)
        self.reset()

    def reset(self) -> None:
        """Valve closed, no command yet; the counts go on."""
        self.voltage, self._since = self.closed, -math.inf
        self._arrived.clear()

    def close_at(self, signal: float) -> None:
        """The machine is another one, whose valve is closed at `signal` [V]: a closed valve stays closed."""
        if self.voltage == self.closed:
            self.voltage = signal
        self.closed = signal

    def accept(self, voltage: float, arrival: int) -> bool:
        """Take a command [V] that arrived at `arrival` [ns]; False if it is not finite. Both it and clipping count."""
        if not math.isfinite(voltage):
            self.refused += 1
            return False
        if abs(voltage) > self.max_voltage:
            self.clipped += 1
            voltage = math.copysign(self.max_voltage, voltage)
        self.accepted += 1
        self._arrived.append((arrival, voltage))
        return True

    def age(self, time: float) -> float:
        """Simulated time [s] since the last command in force; infinite if there was none."""
        return time - self._since

    def hold(self, held: NDArray[np.float64], begin: int, part: float, time: float, step: float) -> None:
        """Fill `held` (parts,) with the voltage in force during each part of a sample.

        The sample begins at `begin` [ns] on the clock of arrivals, `time` [s] on the simulated one; its parts are
        `part` [ns] and `step` [s] long. A command acts from the first part that begins after its arrival.
        """
        parts = len(held)
        held[:] = self.voltage
        end = begin + parts * part
        while self._arrived and self._arrived[0][0] <= end:
            arrival, voltage = self._arrived.popleft()
            index = min(max(math.ceil((arrival - begin) / part), 0), parts)
            held[index:] = voltage
            self.voltage, self._since = voltage, time + index * step
        if self.timeout > 0.0 and self.voltage != self.closed:
            self._expire(held, time, step)

    def _expire(self, held: NDArray[np.float64], time: float, step: float) -> None:
        index = max(math.ceil((self._since + self.timeout - time) / step - 1e-6), 0)
        if index < len(held):
            held[index:] = self.closed
            self.voltage = self.closed
            self.expired += 1
