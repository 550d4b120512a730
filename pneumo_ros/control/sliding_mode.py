"""Sliding mode control with a boundary layer."""

from pneumo_ros.control.approaching_law import ApproachingLaw
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.model_law import AxisState
from pneumo_ros.control.pneumatics import opening
from pneumo_ros.control.setpoint import Setpoint


class SlidingMode(ApproachingLaw):
    """Sliding mode control of the third-order axis, M v' = F - F_friction(v) - F_load with F' from the valve:

        S  = (a_r - a) + omega (v_r - v)                  v_r: wanted velocity, of setpoint and error (see `Approach`)
        F' = M (j_d + (lambda + omega) (a_r - a)) + dF_friction/dv a + dF_load/dy v + M eta sat(S / Phi)

    The first terms keep S constant if the model is exact (equivalent control). The last term drives S to zero if the
    model's error is below the jerk eta; within |S| < Phi it is linear and does not chatter. Presliding is not modelled.
    Sources: Slotine and Li, Applied Nonlinear Control, 1991, secs. 7.1-7.2; G. M. Bone and S. Ning, Experimental
    Comparison of Position Tracking Control Algorithms for Pneumatic Cylinder Actuators, IEEE/ASME Trans. Mechatronics
    12 (2007), which also has S of second order in the position error.
    """

    tuned = ("reach", "layer", "speed_rate", "position_rate", "braking", "bandwidth")
    speed_rate = Gain(40.0, "1/s", "omega, wanted acceleration per velocity error", 0.0, 1000.0)
    reach = Gain(80.0, "m/s3", "eta, jerk that drives S to zero", 0.0, 1e5)
    layer = Gain(2.0, "m/s2", "Phi, boundary layer of S", 1e-4, 1000.0)

    def opening(self, setpoint: Setpoint, state: AxisState, dt: float) -> float:
        """Opening [V] of the valve."""
        wanted = self.wanted(setpoint, state)
        lag = wanted.acceleration - state.acceleration
        surface = lag + self.speed_rate * (wanted.velocity - state.velocity)
        share = min(max(surface / self.layer, -1.0), 1.0)
        jerk = setpoint.jerk + (self.position_rate + self.speed_rate) * lag + self.reach * share
        rate = state.moved.mass * jerk + self.friction.running_slope(state.velocity) * state.acceleration
        rate += state.moved.slope * state.velocity
        return opening(self.machine, state.air, state.velocity, rate)
