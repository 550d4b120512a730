"""State feedback of position, velocity and acceleration, with force feedback."""

from pneumo_ros.control.friction import FrictionObserver
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.model_law import AxisState, ModelLaw
from pneumo_ros.control.pneumatics import opening
from pneumo_ros.control.setpoint import Setpoint


class Pva(ModelLaw):
    """opening = u_d + K_p e + K_v e' + K_a e'' + K_f (F_d - F) + K_i integral of e, e = y_d - y.

    u_d and F_d are the model's opening and force for the wanted motion: F_d = M a_d + F_friction(v_d) + F_load with
    the friction of bristles that follow v_d; u_d holds the chambers' force at v_d, or lets it follow the load of an
    arm. F = A_a p_a - A_b p_b - F_atm is fed back only while motion is wanted: at rest, friction can balance any force
    below its limit. The integral works only at rest, while the opening is not saturated, and is cleared when the piston
    has arrived.

    Sources: S. R. Pandian, F. Takemura, Y. Hayakawa and S. Kawamura, Pressure Observer-Controller Design for Pneumatic
    Cylinder Actuators, IEEE/ASME Trans. Mechatronics 7 (2002), and J. Wang, J. Pu and P. Moore, A Practical Control
    Strategy for Servo-Pneumatic Actuator Systems, Control Engineering Practice 7 (1999) (PVA); Canudas de Wit et al.
    1995 (friction of the wanted motion).
    """

    tuned = ("proportional", "derivative", "force", "acceleration", "integral", "bandwidth")
    proportional = Gain(60.0, "V/m", "K_p, opening per position error", 0.0, 10000.0)
    derivative = Gain(20.0, "V s/m", "K_v, opening per velocity error", 0.0, 1000.0)
    acceleration = Gain(0.1, "V s2/m", "K_a, opening per acceleration error", 0.0, 100.0)
    force = Gain(0.02, "V/N", "K_f, opening per force error", 0.0, 10.0)
    integral = Gain(50.0, "V/(m s)", "K_i, opening per integrated position error at rest", 0.0, 10000.0)
    integral_limit = Gain(2.0, "V", "largest share of the integral in the opening", 0.0, 10.0)

    def forget(self) -> None:
        """Forget estimates, friction of the wanted motion and integral."""
        super().forget()
        self._wanted_friction, self._integral = FrictionObserver(self.machine), 0.0

    def opening(self, setpoint: Setpoint, state: AxisState, dt: float) -> float:
        """Opening [V] of the valve."""
        m, e, moved = self.machine, setpoint.position - state.position, state.moved
        self._wanted_friction.machine = m
        friction = self._wanted_friction.step(setpoint.velocity, dt)
        force = moved.mass * setpoint.acceleration + friction + moved.load
        wanted = (
            opening(m, state.air, setpoint.velocity, moved.slope * setpoint.velocity)
            + self.proportional * e
            + self._integral
        )
        wanted += self.derivative * (setpoint.velocity - state.velocity)
        wanted += self.acceleration * (setpoint.acceleration - state.acceleration)
        if setpoint.velocity != 0.0:
            return wanted + self.force * (force - state.air.force)
        if self.valve.clip(wanted) == wanted:
            most = self.integral_limit
            self._integral = min(max(self._integral + self.integral * e * dt, -most), most)
        return wanted

    def pause(self, state: AxisState) -> None:
        """Arrived: clear the integral."""
        self._integral = 0.0
