"""The plant of a simulator whose rod another simulator moves: it sends the rod's state and gets the force back."""

import numpy as np

from pneumo_ros.axis.simulator.sensors import Sensors
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.couple.cylinder import Cylinder
from pneumo_ros.couple.remote import Remote
from pneumo_ros.plant import Model
from pneumo_ros.plant.signals import DRIVE


class Coupled(Simulation):
    """Valve, gas and friction; position, velocity and time are those of the other side."""

    def __init__(self, model: Model, valve: ValveInput, sensors: Sensors, *, rate: float, step: float) -> None:
        """The other side has `piston.mass` until told otherwise; first steps of 1/`rate` [Hz]; else as Simulation."""
        self._time, self._longest_step = 0.0, step
        self.remote = Remote(Cylinder(model, step=step), model["piston.mass"], 1.0 / rate)
        super().__init__(model, valve, sensors, rate=rate, step=step)

    @property
    def time(self) -> float:
        """Time [s] of the other side."""
        return self._time

    @property
    def clock(self) -> int:
        """The same [ns], for stamps."""
        return round(self._time * 1e9)

    def reset(self) -> None:
        """The gas back to its initial pressures, valve closed; the rod is where it is."""
        super().reset()
        self.remote.cylinder.state[:] = self.plant.state
        self.remote.restart()

    def replace(self, model: Model) -> None:
        """Go on with another model; the gas keeps its pressures."""
        state = model.continued(self._model, self.remote.cylinder.state)
        super().replace(model)
        self.remote.cylinder = Cylinder(model, position=float(state[0]), step=self._longest_step)
        self.remote.cylinder.state[:] = state

    def follow(self, time: float, position: float, velocity: float) -> float:
        """Read the sensors at `time` [s], where the rod is at `position` [m] with `velocity` [m/s]; then the mean force
        [N] on the rod over the step that follows. Raises as `Remote.answer`.
        """
        self._time = time
        volts = self._inputs[DRIVE]
        self.valve.hold(volts, 0, 1.0, time, self.plant.step)
        self.plant.state[:] = self.remote.cylinder.state
        self.plant.state[:2] = position, velocity
        self._read()
        self.total += 1
        return self.remote.answer(time, position, velocity, float(np.mean(volts)))
