"""Cascade control: a mechanical loop computes the wanted force, a pneumatic loop produces it."""

import math

from pneumo_ros.control.approach import Wanted, remaining
from pneumo_ros.control.approaching_law import ApproachingLaw
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.model_law import AxisState
from pneumo_ros.control.pneumatics import opening
from pneumo_ros.control.setpoint import Setpoint

SHARE = 0.75  # of a slow spool's frequency: the pneumatic loop rings when it is faster


class Cascade(ApproachingLaw):
    """Cascade of Guenther, Perondi, De Pieri and Valdiero, Cascade Controlled Pneumatic Positioning System with LuGre
    Model Based Friction Compensation, J. of the Braz. Soc. of Mech. Sci. and Eng. 28 (2006), for areas that differ:

        s   = v_r - v                                     v_r: wanted velocity, of setpoint and error (see `Approach`)
        F_d = M a_r + K_D s + F_friction + F_load         mechanical loop; F = A_a p_a - A_b p_b - F_atm
        F'  = F_d' + K_P (F_d - F)                        pneumatic loop, solved for the opening (see `pneumatics`)

    kappa s also bends the bristles of the friction observer: at rest, where the velocity is 0, it raises the force to
    breakaway. Departures from the paper: While the piston sticks under a moving setpoint, the bristles do not move
    against s: the piston springs back after a slip, and pressures that followed would be missing at the next breakaway.
    If the setpoint is coming back to a piston ahead of it, so that s changes sign within `lead`, the piston waits,
    loaded in the later direction. Scale of friction and load are learnt while the piston slides. F_d' has only smooth
    terms: M j_d, K_D s, the friction that grows with speed and the load that changes along the stroke. An arm has its
    M(y) and its load M'(y) v^2 / 2 + E'(y) (see `arm_load`). The paper's term in s within F', needed to prove
    stability, is below 1 N/s here and is left out.
    """

    tuned = ("damping", "force_rate", "position_rate", "correction", "braking", "bandwidth")
    damping = Gain(300.0, "N s/m", "K_D, force per velocity error", 0.0, 1e5)
    force_rate = Gain(60.0, "1/s", "K_P, rate at which an error of the force is removed", 0.0, 2000.0)
    correction = Gain(0.1, "1", "kappa, velocity error that bends the bristles of the friction observer", 0.0, 100.0)
    lead = Gain(
        0.3, "s", "time ahead at which the setpoint decides whether a piston that sticks waits; 0: never", 0.0, 5.0
    )
    learning = Gain(10.0, "1/s", "rate at which scale of friction and load are learnt while sliding", 0.0, 1000.0)

    def opening(self, setpoint: Setpoint, state: AxisState, dt: float) -> float:
        """Opening [V] of the valve."""
        wanted = self.wanted(setpoint, state)
        force, rate = self._force(setpoint, state, wanted, dt)
        follow = min(self.force_rate, SHARE * self.machine.spool_frequency)
        return opening(self.machine, state.air, state.velocity, rate + follow * (force - state.air.force))

    def _force(self, setpoint: Setpoint, state: AxisState, wanted: Wanted, dt: float) -> tuple[float, float]:
        """F_d [N] and the smooth part of its rate [N/s]."""
        (mass, load, slope), v = state.moved, state.velocity
        s, acceleration = wanted.velocity - v, wanted.acceleration
        moving = setpoint.velocity != 0.0
        asked = moving and self.lead > 0.0 and not self.friction.sliding
        later = self._later(setpoint, state) if asked else s
        if s * later < 0.0:
            friction, s, acceleration = self.friction.wait(v, dt, self.correction * later), 0.0, 0.0
        else:
            friction = self.friction.step(v, dt, self.correction * s, held=moving)
        measured = state.air.force - mass * state.acceleration - load
        self.friction.learn(measured, v, 1.0 - math.exp(-self.learning * dt))
        force = mass * acceleration + self.damping * s + friction + load
        rate = mass * setpoint.jerk + self.friction.running_slope(v) * acceleration + slope * v
        return force, rate + self.damping * (acceleration - state.acceleration)

    def _later(self, setpoint: Setpoint, state: AxisState) -> float:
        """s [m/s] after `lead`, if the piston does not move."""
        left = remaining(setpoint)
        ahead = setpoint.ahead(self.lead) if left is None else Setpoint(setpoint.position + left)
        return self.wanted_at(ahead, state).velocity - state.velocity
