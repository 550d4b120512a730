"""Common part of the laws that derive a wanted velocity from setpoint and error."""

from pneumo_ros.control.approach import Approach, Wanted
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.model_law import AxisState, ModelLaw
from pneumo_ros.control.setpoint import Setpoint


class ApproachingLaw(ModelLaw):
    """A law whose wanted velocity comes from `Approach`; subclasses turn it into an opening."""

    position_rate = Gain(30.0, "1/s", "lambda, wanted velocity per position error", 0.1, 500.0)
    braking = Gain(0.15, "m/s2", "b, deceleration with which larger errors are approached", 1e-3, 100.0)
    slowest = Gain(0.02, "m/s", "lowest speed at which the end of a motion is approached", 0.0, 1.0)
    stop = Gain(2.5e-4, "m", "stopping distance from that speed", 0.0, 0.1)
    detour = Gain(0.01, "m", "distance to move past a target missed by less, then back; 0: none", 0.0, 1.0)

    def forget(self) -> None:
        """Forget estimates and approach."""
        super().forget()
        self._approach = Approach()

    def pause(self, state: AxisState) -> None:
        """Arrived: end the detour."""
        self._approach.reset()

    def wanted(self, setpoint: Setpoint, state: AxisState) -> Wanted:
        """Wanted velocity and acceleration; call once per measurement."""
        error = setpoint.position - state.position
        self._approach.watch(setpoint, error, self.stops.stuck, self.patience, self.detour)
        return self.wanted_at(setpoint, state)

    def wanted_at(self, setpoint: Setpoint, state: AxisState) -> Wanted:
        """Wanted velocity and acceleration if `setpoint` held now; may be called repeatedly."""
        error = setpoint.position - state.position
        shape = self.position_rate, self.braking, self.slowest, self.stop
        return self._approach.wanted(setpoint, error, state.velocity, *shape)
