"""Measurement in, voltage out: the control law, its guide, and refused inputs. No ROS in here."""

import math

from pneumo_ros.axis.controller.guide import Guide, Mode
from pneumo_ros.axis.controller.trust import Stall, leapt, outside
from pneumo_ros.control import Law, Measurement, Setpoint

JUMP = 1.0  # s; a stamp this much before the last one: the clock was set; less: messages came out of order


class Loop:
    """One control loop. Stamps [ns] are those of headers; `time` [s] begins at 0 and rises even if the clock is set.

    After a pause, and when the clock was set, the law restarts, and the motion restarts where the piston is.
    """

    def __init__(self, law: Law, timeout: float) -> None:
        """`timeout` [s] between measurements counts as a pause."""
        self.law, self.guide, self.timeout = law, Guide(law), timeout
        self.wanted: Setpoint | None = None
        self.time = self.voltage = 0.0
        self.measured = self.refused = self.saturated = self.restarts = 0
        self.stall = Stall()
        self.fault = ""  # why the position is not believed
        self._believed: tuple[float, float] | None = None  # time, position
        self._pressures: dict[str, tuple[float, float]] = {}  # chamber -> time, pressure
        self._origin = 0
        self._last: int | None = None

    def press(self, chamber: str, pressure: float) -> None:
        """Take the pressure [Pa abs] in chamber "a" or "b"; refused and counted if it is not finite."""
        if math.isfinite(pressure):
            self._pressures[chamber] = (self.time, pressure)
        else:
            self.refused += 1

    @property
    def pressures(self) -> dict[str, float | None]:
        """Pressures [Pa abs] by chamber, None without a recent one."""
        known: dict[str, float | None] = {"a": None, "b": None}
        for chamber, (time, pressure) in self._pressures.items():
            if self.time - time <= self.timeout:
                known[chamber] = pressure
        return known

    def measure(self, stamp: int, position: float, velocity: float | None) -> float | None:
        """Voltage [V] for a measurement at `stamp` [ns]: m, m/s; None if it is refused, 0 V without a reference.

        0 V for a position that no piston can have; after a leap of the position the valve stays closed until resume.
        """
        if not math.isfinite(position):
            self.refused += 1
            return None
        if not self._in_order(stamp, position):
            return None
        if not self._believable(position):
            self.voltage = 0.0
            return 0.0
        self.measured += 1
        self.guide.supply.age(self.time)
        self.wanted = self.guide.wanted(self.time, position)
        pressures = self.pressures
        forced = self.guide.forced(self.time, pressures)
        if forced is not None or self.wanted is None:
            self.voltage = forced or 0.0
        else:
            seen = velocity if velocity is not None and math.isfinite(velocity) else None
            measurement = Measurement(self.time, position, seen, pressures["a"], pressures["b"])
            self.voltage = self._step(self.wanted, measurement)
        pushed = 0.0 if self.wanted is None else self.voltage / self.law.valve.max_voltage
        self.stall.look(self.time, position, 0.0 if self.wanted is None else self.wanted.position, pushed)
        return self.voltage

    def _believable(self, position: float) -> bool:
        """Whether a piston can be there; `fault` says why not."""
        if sentence := outside(position, self.law.machine.stroke):
            self.refused += 1
            self.fault, self._believed = sentence, None
            self.law.reset()
            return False
        before, self._believed = self._believed, (self.time, position)
        if before is None and self.fault:  # it is inside again
            self.guide.restart(self.time, position)
        if before is not None and (sentence := leapt(before[1], position, self.time - before[0])):
            self.fault = sentence
            self.guide.position = position
            self.guide.close(sentence)
        elif self.guide.mode is not Mode.STOPPED or before is None:
            self.fault = ""
        return True

    def _step(self, wanted: Setpoint, measurement: Measurement) -> float:
        voltage, most = self.law.step(wanted, measurement), self.law.valve.max_voltage
        if not math.isfinite(voltage):
            self.refused += 1
            self.law.reset()
            return 0.0
        self.saturated += abs(voltage) >= most
        return min(max(voltage, -most), most)

    def _in_order(self, stamp: int, position: float) -> bool:
        """Whether a measurement needs a command; sets the time, and restarts the law after a pause."""
        if self._last is None or stamp < self._last - JUMP * 1e9:
            self._origin = stamp - round(self.time * 1e9)
        elif stamp < self._last:
            return False  # a later one came first
        anew = self._last is None or not 0 <= stamp - self._last <= self.timeout * 1e9
        self._last, self.time = stamp, (stamp - self._origin) * 1e-9
        if anew:
            self.restart(position)
        return True

    def restart(self, position: float) -> None:
        """Reset the law, and continue from `position` [m]."""
        self._believed = None
        self.law.reset()
        self.guide.restart(self.time, position)
        self.restarts += 1
