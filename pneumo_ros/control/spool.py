"""Lead for a slow spool: the voltage that brings it to its wanted position faster."""

import math

from pneumo_ros.control.machine import Machine

FASTEST = 500.0  # rad/s, above which the plant's effect fades out
FASTER = 2.0  # times the spool's own frequency; noise grows with the square of it


class SpoolLead:
    """The spool x follows the voltage U as x'' = omega^2 (U - x) - 2 zeta omega x'; this model gives x. With

        U = x + (omega_c^2 (x_d - x) - 2 (omega_c - zeta omega) x') / omega^2,    omega_c = 2 omega

    within the limits of the voltage, it reaches the wanted x_d critically damped at omega_c. Source: pole placement,
    Astrom and Wittenmark, Computer-Controlled Systems, 1997, sec. 4.3. Without spool dynamics U is x_d itself.
    """

    def __init__(self) -> None:
        """Start with the spool in the middle."""
        self.x = self.w = 0.0

    def voltage(self, machine: Machine, wanted: float, limit: float, dt: float) -> float:
        """U [V], within +-`limit` [V], for the spool to be at `wanted` [V]; held for about `dt` [s]."""
        omega, zeta = machine.spool_frequency, machine.spool_damping
        if omega >= FASTEST:
            return wanted
        fast = FASTER * omega
        asked = self.x + (fast * fast * (wanted - self.x) - 2.0 * (fast - zeta * omega) * self.w) / (omega * omega)
        given = min(max(asked, -limit), limit)
        self._follow(given, omega, zeta, dt)
        return given

    def _follow(self, voltage: float, omega: float, zeta: float, dt: float) -> None:
        """Backward Euler: stable whatever the frequency and the sample time."""
        step = omega * dt
        self.w = (self.w + step * omega * (voltage - self.x)) / (1.0 + 2.0 * zeta * step + step * step)
        self.x += self.w * dt
        if not math.isfinite(self.x):
            self.x = self.w = 0.0
