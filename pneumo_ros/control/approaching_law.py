"""What the laws share that want a velocity from setpoint and error, and make it."""

from pneumo_ros.control.approach import Approach, Wanted
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.model_law import AxisState, ModelLaw
from pneumo_ros.control.setpoint import Setpoint


class ApproachingLaw(ModelLaw):
    """A law whose wanted velocity comes from `Approach`; subclasses turn it into an opening."""

    position_rate = Gain(30.0, "1/s", "lambda, wanted velocity per position error", 0.1, 500.0)
    braking = Gain(0.15, "m/s2", "b, deceleration with which larger errors are approached", 1e-3, 100.0)
    slowest = Gain(0.02, "m/s", "least speed at which the end of a motion is approached", 0.0, 1.0)
    stop = Gain(2.5e-4, "m", "way in which the piston stops from there", 0.0, 0.1)
    detour = Gain(0.01, "m", "way past a place missed by less, before coming back to it; 0: none", 0.0, 1.0)

    def forget(self) -> None:
        """Forget estimates and approach."""
        super().forget()
        self._approach = Approach()

    def pause(self, state: AxisState) -> None:
        """Arrived: no detour any more."""
        self._approach.reset()

    def wanted(self, setpoint: Setpoint, state: AxisState) -> Wanted:
        """Wanted velocity and acceleration; call once per measurement."""
        error = setpoint.position - state.position
        self._approach.watch(setpoint, error, self.stops.stuck, self.patience, self.detour)
        return self.wanted_at(setpoint, state)

    def wanted_at(self, setpoint: Setpoint, state: AxisState) -> Wanted:
        """Wanted velocity and acceleration, were `setpoint` that of now; call as often as you like."""
        error = setpoint.position - state.position
        shape = self.position_rate, self.braking, self.slowest, self.stop
        return self._approach.wanted(setpoint, error, state.velocity, *shape)
