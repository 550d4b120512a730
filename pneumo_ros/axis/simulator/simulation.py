"""The plant that runs on: valve input, kernel and sensors, advanced sample by sample. No ROS in here."""

import math

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.axis.simulator.sensors import Reading, Sensors
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Model
from pneumo_ros.plant.model import substeps


class Simulation:
    """State of a machine between samples; model and parameters may be swapped there without a jump of the state."""

    def __init__(self, model: Model, valve: ValveInput, sensors: Sensors, *, rate: float, step: float) -> None:
        """Sample at `rate` [Hz], integrate in steps no longer than `step` [s]. The kernel is compiled here."""
        self.parts, self.step = substeps(1.0 / rate, step)
        self.rate, self.valve, self.sensors = rate, valve, sensors
        self.samples = 0  # since the start or the last reset
        self.total = 0  # since the start
        self.initial: dict[str, float] = {}
        self._held = np.zeros(self.parts)
        self._adopt(model, model.state())
        self.reset()

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset."""
        return self.samples / self.rate

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self._adopt(model, model.continued(self.model, self.state))

    def _adopt(self, model: Model, state: NDArray[np.float64]) -> None:
        self.model, self.state = model, state
        self._values, self._run, self._observe = model.values, model.kernel.run, model.kernel.observe
        self._row, self._out, self._now = state[np.newaxis], np.empty((1, len(state))), np.zeros(1)  # views, scratch
        self._run(state.copy(), self._values, self._held, 0.0, self.step, 1, self.parts, self._out[:0])  # compiles
        self._seen = np.empty((1, len(model.composition.observed)))
        self._places = [model.composition.observed.index(s) for s in ("y_measured", "p_a_measured", "p_b_measured")]
        areas = model["piston.area_a"], model["piston.area_b"]
        self._areas = (*areas, model["air.atmospheric_pressure"] * (areas[0] - areas[1]))

    def reset(self) -> None:
        """Back to time 0, the state `initial` and the first number of the noise, valve closed."""
        self.state[:] = self.model.state(**self.initial)
        self.samples = 0
        self.valve.reset()
        self.sensors.reset()
        self._read()

    def advance(self, begin: int, part: float) -> None:
        """One sample; it began at `begin` [ns] on the clock of arrivals, where its parts took `part` [ns] each.

        Raises NumericalError when the state leaves the finite numbers; it then is the last good one.
        """
        time = self.time
        self.valve.hold(self._held, begin, part, time, self.step)
        before = self.state.copy()
        self._run(self.state, self._values, self._held, time, self.step, 1, self.parts, self._out)
        if not math.isfinite(self.state.sum()):  # of finite numbers of this size a sum is finite
            self.state[:] = before
            raise NumericalError(f"the state left the finite numbers at t = {time:.3f} s; reset, or mend a parameter")
        self.samples += 1
        self.total += 1
        self._read()

    def _read(self) -> None:
        """What the sensors see of the state, kept in `reading`."""
        self._now[0] = self.time
        self._observe(self._row, self._values, self._held[-1:], self._now, self._seen)
        seen = self._seen[0].tolist()
        y, p_a, p_b = self._places
        self.reading = self.sensors.read(Reading(seen[y], float(self.state[1]), seen[p_a], seen[p_b]))

    @property
    def clock(self) -> int:
        """Simulated time [ns] for stamps: resets do not turn it back, and it begins one sample after 0, which in ROS
        means that there is no time.
        """
        return round((self.total + 1) * 1e9 / self.rate)

    @property
    def effort(self) -> float:
        """A_a p_a - A_b p_b - p_atm (A_a - A_b) [N] of the present reading."""
        area_a, area_b, atmosphere = self._areas
        return area_a * self.reading.pressure_a - area_b * self.reading.pressure_b - atmosphere
