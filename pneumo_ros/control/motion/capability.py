"""What the supply pressure can do: the force left at a speed, the speed left without one."""

import math
from dataclasses import dataclass, replace

from pneumo_ros.control.machine import Machine
from pneumo_ros.control.motion.limits import Limits
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.control.valve import ValveInverse

BISECTIONS = 40


@dataclass(frozen=True)
class Capability:
    """Largest forces of a machine behind a fully open valve, quasi-steady: pressures as if the speed had lasted.

    At a steady speed v the filling chamber takes A v p = c (p_s - p), the other gives A v p = d (p - p_atm), with the
    flows c = beta_fill R T atan(k_u u) and d likewise [m3/s] (plant: `arctan_flow` and `chambers` with p' = 0). The
    share of choked flow is not told apart; a machine without flow coefficients is limited by its pressures alone.
    """

    machine: Machine
    valve: ValveInverse
    supply_pressure: float | None = None  # [Pa abs] as measured; None: what the machine file says

    @property
    def supply(self) -> float:
        """Supply pressure [Pa abs], at least the atmosphere's."""
        known = self.machine.supply_pressure if self.supply_pressure is None else self.supply_pressure
        return max(known, self.machine.atmospheric_pressure)

    def force(self, speed: float, side: float) -> float:
        """Largest force of the pressures [N] along `side`, +1 extends, at `speed` [m/s] >= 0 to that side."""
        m = self.machine
        filled, emptied = (m.area_a, m.area_b) if side > 0.0 else (m.area_b, m.area_a)
        c, d = self._flows(side)
        high = self.supply if math.isinf(c) else self.supply * c / (c + filled * speed)
        room = 1.0 if math.isinf(d) else 1.0 - emptied * speed / d
        low = m.atmospheric_pressure / room if room > 0.0 else math.inf
        return filled * high - emptied * low - side * m.atmosphere

    def resistance(self, speed: float, side: float) -> float:
        """Friction and load [N] against motion to `side` at `speed` [m/s] >= 0."""
        m = self.machine
        return m.coulomb_friction + (m.viscous_friction + m.drag * speed) * speed + side * m.load

    def top_speed(self, side: float) -> float:
        """Largest steady speed [m/s] to `side`; 0 where the piston does not move at all."""
        slow, fast = 0.0, 100.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (slow + fast)
            if self.force(middle, side) >= self.resistance(middle, side):
                slow = middle
            else:
                fast = middle
        return slow

    def shortfall(self, wanted: Setpoint) -> float:
        """Force [N] that `wanted` needs beyond what there is; negative where some is left.

        While braking hard, the pressures push against the motion: then the force at rest is what there is.
        """
        side = 1.0 if wanted.velocity > 0.0 or (wanted.velocity == 0.0 and wanted.acceleration >= 0.0) else -1.0
        speed = abs(wanted.velocity)
        needed = side * self.machine.moving_mass * wanted.acceleration + self.resistance(speed, side)
        if needed < 0.0:
            return -needed - self.force(0.0, -side)
        return needed - self.force(speed, side)

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

        As they are for a machine that does not move at all: there is nothing to fit them to.
        """
        speed = min(limits.speed, share * self.top_speed(1.0), share * self.top_speed(-1.0))
        left = min(self.force(speed, side) - self.resistance(speed, side) for side in (1.0, -1.0))
        acceleration = min(limits.acceleration, share * left / self.machine.moving_mass)
        if speed <= 0.0 or acceleration <= 0.0:
            return limits
        return replace(limits, speed=speed, acceleration=acceleration)
