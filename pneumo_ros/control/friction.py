"""Friction of the seals as a control law estimates it: elasto-plastic LuGre friction, stepped exactly."""

import math

from pneumo_ros.control.machine import Machine

SMALLEST = 1e-3  # N, least friction level that is divided by
HEADROOM = 1.5  # times the deflection at F_s, limit of a correction: the known F_s may be too low
INFORMATIVE = 0.02  # m/s, sliding at this speed shows the level; below, the Stribeck curve is too steep
LEAST, MOST = 0.3, 3.0  # range of the learnt scale
LOADED = 0.5  # largest bias, as a share of the force of the supply
READY = 0.9  # of Coulomb friction: largest force of a piston that waits to break away
FORGETTING = 0.5  # 1/s, while the piston sticks: a bias learnt at an end stop must not hold it there


class FrictionObserver:
    """Bristle deflection z and friction force along an estimated velocity:

        z' = v - alpha sigma_0 |v| z / g(v) + correction,    F = sigma_0 z + sigma_2 v + C_d v |v|
        g(v) = F_c + (F_s - F_c) exp(-(v / v_s)^2)
        alpha = 0 if v z < 0 or |z| <= z_ba(v), else 1,    z_ba = breakaway_ratio g(v) / sigma_0

    Sources: Canudas de Wit et al. 1995, Eqs. 1-5; Dupont et al. 2000, Eqs. 4-8 (alpha; its ramp from 0 to 1 between
    z_ba and z_max, over some micrometres, is a step here; a breakaway_ratio of 0 gives LuGre); Guenther, Perondi, De
    Pieri and Valdiero 2006 (the correction, made of the tracking error; it acts while the piston sticks).

    For v held over a sample the equation is piecewise linear in z, and the step is its exact solution: stable at any
    speed and sample time, while an explicit step at 1 kHz is unstable above 0.1 m/s. sigma_1 is left out of F: it damps
    the bristles' 84 Hz, which no valve follows. `learn` fits a scale of sigma_0 z and a bias to the force measured
    while sliding: friction changes its sign with the motion, a load does not.
    """

    def __init__(self, machine: Machine) -> None:
        """Take the parameters of `machine`, which may be replaced between steps; start with slack bristles."""
        self.machine = machine
        self.reset()

    def reset(self) -> None:
        """Slack bristles, nothing learnt."""
        self.z, self.sliding, self.scale, self.bias = 0.0, False, 1.0, 0.0

    def level(self, velocity: float) -> float:
        """g(v) [N], the friction force of steady sliding without the terms that grow with speed."""
        m = self.machine
        ratio = min(abs(velocity) / m.stribeck_velocity, 30.0)
        return max(m.coulomb_friction + (m.static_friction - m.coulomb_friction) * math.exp(-ratio * ratio), SMALLEST)

    def running(self, velocity: float) -> float:
        """Friction that grows with speed [N]: sigma_2 v + C_d v |v|."""
        return (self.machine.viscous_friction + self.machine.drag * abs(velocity)) * velocity

    def running_slope(self, velocity: float) -> float:
        """Derivative of `running` [N s/m]."""
        return self.machine.viscous_friction + 2.0 * self.machine.drag * abs(velocity)

    def step(self, velocity: float, dt: float, correction: float = 0.0, *, held: bool = False) -> float:
        """Advance by `dt` [s] at `velocity` [m/s]; `correction` [m/s] also bends sticking bristles. Returns F [N].

        `held` bristles bend only in the direction of the correction, whatever the velocity.
        """
        left = dt - self._bend(velocity, dt, correction, held)
        self.sliding = left > 0.0
        if self.sliding:
            steady = math.copysign(self.level(velocity) / self.machine.bristle_stiffness, velocity)
            self.z = steady + (self.z - steady) * math.exp(-velocity / steady * left)
        else:
            self._forget(1.0 - math.exp(-FORGETTING * dt))
        return self.force(velocity)

    def wait(self, velocity: float, dt: float, correction: float) -> float:
        """Stick for another `dt` [s]: at any velocity, bend bristles by `correction` [m/s] up to the share READY of
        Coulomb friction in its direction. Returns F [N].
        """
        way = math.copysign(1.0, correction)
        room = READY * self.machine.coulomb_friction / self.machine.bristle_stiffness - way * self.z
        self.z += way * min(max(room, 0.0), abs(correction) * dt)
        self._forget(1.0 - math.exp(-FORGETTING * dt))
        return self.force(velocity)

    def force(self, velocity: float) -> float:
        """F [N] at the present deflection."""
        return self.scale * self.machine.bristle_stiffness * self.z + self.bias + self.running(velocity)

    def learn(self, measured: float, velocity: float, share: float) -> None:
        """Correct `share` of the error to the `measured` friction [N], only while fast sliding shows it.

        Half goes to the scale, half to the bias; motion in both directions distinguishes them (normalised least mean
        squares: B. Widrow and S. D. Stearns, Adaptive Signal Processing, 1985).
        """
        if self.sliding and abs(velocity) > INFORMATIVE:
            bristles, level = self.machine.bristle_stiffness * self.z, self.level(velocity)
            lacking = share * (measured - self.force(velocity)) / (bristles * bristles + level * level)
            self.scale = min(max(self.scale + lacking * bristles, LEAST), MOST)
            most = LOADED * self.machine.area_a * (self.machine.supply_pressure - self.machine.atmospheric_pressure)
            self.bias = min(max(self.bias + lacking * level * level, -most), most)

    def _forget(self, share: float) -> None:
        self.scale += share * (1.0 - self.scale)
        self.bias -= share * self.bias

    def _bend(self, velocity: float, dt: float, correction: float, held: bool) -> float:
        """Bend the bristles elastically; returns the time [s] of `dt` that this takes. In the rest they slip."""
        m = self.machine
        edge = m.breakaway_ratio * self.level(velocity) / m.bristle_stiffness
        if velocity * self.z > 0.0 and abs(self.z) > edge and self.sliding:
            return 0.0
        room = math.copysign(edge, velocity) - self.z
        elastic = min(max(room / velocity, 0.0), dt) if velocity != 0.0 else dt
        most = HEADROOM * max(m.static_friction, m.coulomb_friction) / m.bristle_stiffness
        bent = min(max(self.z + velocity * elastic + correction * dt, -most), most)
        if held and not self.sliding and (bent - self.z) * correction < 0.0:
            return dt
        self.z = bent
        return elastic
