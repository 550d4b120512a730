"""Position control by PID with the inverse of the valve's dead zone."""

from pneumo_ros.control.gain import Gain
from pneumo_ros.control.law import Law
from pneumo_ros.control.measurement import Measurement
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.control.stops import Stops
from pneumo_ros.control.velocity import VelocityEstimator

SPAN = 1e-4  # m, motion that is ignored


class Pid(Law):
    """opening = K_p e + integral of K_i e + K_d e', through the inverse of the dead zone, within the voltage limits.

    e' is the velocity of the setpoint minus that of the piston, the latter estimated unless it is measured. Anti-windup
    is conditional integration: the integral is held while the opening is saturated and the error would raise it further
    (Astrom and Hagglund, PID Controllers, 1995, sec. 3.5). Near the reference and nearly at rest the valve is closed
    until the error exceeds twice the tolerance: with stick-slip friction an integral would hunt for ever. After some
    stops at wrong places the tolerance widens, as with every law here.
    """

    tuned = ("proportional", "derivative", "integral", "tolerance")
    proportional = Gain(100.0, "V/m", "K_p, opening per position error", 0.0, 10000.0)
    integral = Gain(0.6, "V/(m s)", "K_i, opening per integrated position error", 0.0, 10000.0)
    derivative = Gain(50.0, "V s/m", "K_d, opening per velocity error", 0.0, 1000.0)
    integral_limit = Gain(0.3, "V", "largest share of the integral in the opening", 0.0, 10.0)
    tolerance = Gain(1e-3, "m", "error that is accepted at rest", 0.0, 0.1)
    rest_speed = Gain(0.01, "m/s", "speed below which the piston counts as resting", 0.0, 1.0)
    bandwidth = Gain(200.0, "rad/s", "of the velocity estimate", 1.0, 5000.0)

    def forget(self) -> None:
        """Forget the integral and the velocity estimate."""
        self._piston = VelocityEstimator(self.bandwidth)
        self._integral, self._resting, self._stops = 0.0, False, Stops()

    def respond(self, setpoint: Setpoint, measurement: Measurement, dt: float) -> float:
        """Voltage [V]; see `Law.respond`."""
        velocity, wanted = self._velocity(measurement), setpoint.velocity
        error = setpoint.position - measurement.position
        self._stops.watch(setpoint.position, measurement.position, SPAN, self._resting, dt)
        self._resting = self._may_rest(error, velocity, wanted)
        return 0.0 if self._resting else self._act(error, wanted - velocity, dt)

    def _velocity(self, measurement: Measurement) -> float:
        self._piston.bandwidth = self.bandwidth
        estimate = self._piston.update(measurement.time, measurement.position)
        return estimate if measurement.velocity is None else measurement.velocity

    def _may_rest(self, error: float, velocity: float, wanted: float) -> bool:
        tolerance = self.tolerance * self._stops.patience
        if self._resting:
            return abs(error) <= 2.0 * tolerance
        return abs(error) <= tolerance and max(abs(velocity), abs(wanted)) <= self.rest_speed

    def _act(self, error: float, rate: float, dt: float) -> float:
        limit = self.integral_limit
        wanted = self.proportional * error + self._integral + self.derivative * rate
        opening = self.valve.clip(wanted)
        if opening == wanted or (wanted - opening) * error < 0.0:
            self._integral = min(max(self._integral + self.integral * error * dt, -limit), limit)
        return self.valve.voltage(opening)
