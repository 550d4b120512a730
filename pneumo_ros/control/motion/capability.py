"""Limits that the supply pressure sets: the largest force at a speed, and the largest speed."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.control.machine import Machine
from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.valve import ValveInverse

Array = NDArray[np.float64]
BISECTIONS = 40
TINY = 1e-9  # m/s; also the least divisor, at a speed at which a chamber cannot empty


@dataclass(frozen=True)
class Capability:
    """Largest forces of a machine with a fully open valve, quasi-steady: pressures as at a constant speed.

    At a steady speed v the filling chamber takes A v p = c (p_s - p), the other gives A v p = d (p - p_atm), with the
    flows c = beta_fill R T atan(k_u u) and d likewise [m3/s] (plant: `arctan_flow` and `chambers` with p' = 0). The
    share of choked flow is counted as linear flow; an arm counts where it is heaviest; a machine without flow
    coefficients is limited by its pressures alone.
    """

    machine: Machine
    valve: ValveInverse
    supply_pressure: float | None = None  # [Pa abs] as measured; None: that of the machine file

    @property
    def supply(self) -> float:
        """Supply pressure [Pa abs], at least the atmosphere's."""
        known = self.machine.supply_pressure if self.supply_pressure is None else self.supply_pressure
        return max(known, self.machine.atmospheric_pressure)

    def force(self, speed: ArrayLike, side: float) -> Array:
        """Largest force of the pressures [N] along `side`, +1 extends, at `speed` [m/s] >= 0 to that side."""
        m, v = self.machine, np.asarray(speed, dtype=float)
        filled, emptied = (m.area_a, m.area_b) if side > 0.0 else (m.area_b, m.area_a)
        c, d = self._flows(side)
        high = self.supply / (1.0 + filled * v / c)
        low = m.atmospheric_pressure / np.maximum(1.0 - emptied * v / d, TINY)
        return np.asarray(filled * high - emptied * low - side * m.atmosphere)

    def resistance(self, speed: ArrayLike, side: float) -> Array:
        """Friction and load [N] against motion to `side` at `speed` [m/s] >= 0."""
        m, v = self.machine, np.asarray(speed, dtype=float)
        return np.asarray(m.coulomb_friction + (m.viscous_friction + m.drag * v) * v + m.opposing(side))

    def breakaway(self, side: float) -> float:
        """Force [N] that starts a motion to `side`: static friction, and the load."""
        return max(self.machine.static_friction, self.machine.coulomb_friction) + self.machine.opposing(side)

    def top_speed(self, side: float) -> float:
        """Largest steady speed [m/s] to `side`; 0 if the piston cannot move."""
        slow, fast = 0.0, 100.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (slow + fast)
            if self.force(middle, side) >= self.resistance(middle, side):
                slow = middle
            else:
                fast = middle
        return slow

    def shortfall(self, velocity: ArrayLike, acceleration: ArrayLike) -> Array:
        """Force [N] that motions [m/s, m/s2] need beyond the available force; negative where force is left.

        While braking hard, the pressures push against the motion: the force at rest is then available. At rest a start
        to one side cannot be distinguished from the end of a motion to the other: the easier one counts.
        """
        v, a = np.broadcast_arrays(np.asarray(velocity, dtype=float), np.asarray(acceleration, dtype=float))
        extending = self._lacking(np.maximum(v, 0.0), a, 1.0)
        retracting = self._lacking(np.maximum(-v, 0.0), -a, -1.0)
        return np.select([v >= TINY, v <= -TINY], [extending, retracting], np.minimum(extending, retracting))

    def _lacking(self, speed: Array, gain: Array, side: float) -> Array:
        needed = self.machine.moving_mass * gain + self.resistance(speed, side)
        return np.where(needed < 0.0, -needed - self.force(0.0, -side), needed - self.force(speed, side))

    def _flows(self, side: float) -> tuple[float, float]:
        """c and d of the fully open valve [m3/s]."""
        m, v = self.machine, self.valve
        opening = v.right_slope * (v.max_voltage - v.right_limit)
        if side < 0.0:
            opening = v.left_slope * (v.max_voltage - v.left_limit)
        share = math.atan(m.voltage_gain * opening) * m.gas_constant * m.temperature
        return share * m.filling_coefficient or math.inf, share * m.exhaust_coefficient or math.inf

    def fit(self, limits: Limits, share: float = 0.95) -> Limits:
        """`limits`, with speed and acceleration no larger than `share` of what the machine reaches both ways.

        Unchanged for a machine that cannot move: there is nothing to fit them to.
        """
        speed = min(limits.speed, share * self.top_speed(1.0), share * self.top_speed(-1.0))
        left = min(float(self.force(speed, side) - self.resistance(speed, side)) for side in (1.0, -1.0))
        acceleration = min(limits.acceleration, share * left / self.machine.moving_mass)
        if speed <= 0.0 or acceleration <= 0.0:
            return limits
        return replace(limits, speed=speed, acceleration=acceleration)
