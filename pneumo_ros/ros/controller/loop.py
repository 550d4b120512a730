"""Measurement in, voltage out: the control law with its reference, and what it refuses. No ROS in here."""

import math

from pneumo_ros.control import Law, Measurement, Reference, Setpoint

JUMP = 1.0  # s; a stamp this much before the last one means that the clock was set, not that messages overtook


class Loop:
    """One control loop. Times are header stamps [ns]; what happens after a pause starts the law anew."""

    def __init__(self, law: Law, reference: Reference | None, timeout: float) -> None:
        """`reference` None: it is `wanted`, set from outside. `timeout` [s] between measurements counts as a pause."""
        self.law, self.reference, self.timeout = law, reference, timeout
        self.wanted: Setpoint | None = None
        self.position: float | None = None
        self.voltage = 0.0
        self.measured = self.refused = self.saturated = self.restarts = 0
        self.pressures: dict[str, float | None] = {"a": None, "b": None}
        self._begin: int | None = None
        self._last = 0

    def want(self, position: float) -> bool:
        """Take a reference [m]; False, counted, if it is not finite."""
        if not math.isfinite(position):
            self.refused += 1
            return False
        self.wanted = Setpoint(position)
        return True

    def measure(self, stamp: int, position: float, velocity: float | None) -> float | None:
        """Voltage [V] for a measurement at `stamp` [ns]: m, m/s; None if it is refused, 0 V without a reference."""
        if not math.isfinite(position):
            self.refused += 1
            return None
        if not self._in_order(stamp):
            return None
        self.measured += 1
        self.position = position
        time = (stamp - (self._begin or 0)) * 1e-9
        if self.reference is not None:
            self.wanted = self.reference(time)
        self.voltage = 0.0 if self.wanted is None else self._step(time, position, velocity)
        return self.voltage

    def _step(self, time: float, position: float, velocity: float | None) -> float:
        assert self.wanted is not None
        seen = velocity if velocity is not None and math.isfinite(velocity) else None
        voltage = self.law.step(
            self.wanted, Measurement(time, position, seen, self.pressures["a"], self.pressures["b"])
        )
        self.saturated += abs(voltage) >= self.law.valve.max_voltage
        return voltage

    def _in_order(self, stamp: int) -> bool:
        """Whether a measurement is to be answered; begins anew after a pause or when the clock was set back."""
        if self._begin is None or stamp < self._last - JUMP * 1e9:
            self._begin = stamp
            self.restart()
        elif stamp < self._last:
            return False  # overtaken by a later one
        elif stamp - self._last > self.timeout * 1e9:
            self.restart()
        self._last = stamp
        return True

    def restart(self) -> None:
        """Forget what the law knows of the past."""
        self.law.reset()
        self.restarts += 1
