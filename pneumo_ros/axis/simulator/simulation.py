"""The plant of a simulator: valve input, stepper and sensors, advanced sample by sample."""

import numpy as np

from pneumo_ros.axis.simulator.sensors import Reading, Sensors
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.plant import Model, Stepper


class Simulation:
    """A stepper between valve commands and sensor readings; model and parameters may change between two samples."""

    def __init__(self, model: Model, valve: ValveInput, sensors: Sensors, *, rate: float, step: float) -> None:
        """Sample at `rate` [Hz], integrate in steps no longer than `step` [s]. The kernel is compiled here."""
        self.rate, self.valve, self.sensors = rate, valve, sensors
        self.plant = Stepper(model, model.state(), sample_time=1.0 / rate, step=step)
        self.total = 0  # samples since the start
        self.initial: dict[str, float] = {}
        self._held, self._now = np.zeros(self.plant.parts), np.zeros(1)
        self._observe_model()
        self.reset()

    @property
    def model(self) -> Model:
        """The model as it is now."""
        return self.plant.model

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset."""
        return self.plant.time

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self.plant.replace(model)
        self._observe_model()

    def _observe_model(self) -> None:
        """Prepare the reading of the sensors for the present model."""
        model, observed = self.plant.model, self.plant.model.composition.observed
        self._values, self._observe, self._row = model.values, model.kernel.observe, self.plant.state[np.newaxis]
        self._seen = np.empty((1, len(observed)))
        self._places = [observed.index(s) for s in ("y_measured", "p_a_measured", "p_b_measured")]
        areas = model["piston.area_a"], model["piston.area_b"]
        self._areas = (*areas, model["air.atmospheric_pressure"] * (areas[0] - areas[1]))

    def reset(self) -> None:
        """Back to time 0, the state `initial` and the first number of the noise, valve closed."""
        self.plant.reset(self.plant.model.state(**self.initial))
        self.valve.reset()
        self.sensors.reset()
        self._read()

    def advance(self, begin: int, part: float) -> None:
        """One sample, which began at `begin` [ns] on the clock of arrivals; each of its parts took `part` [ns].

        Raises NumericalError when the state is no longer finite; the state then is the last finite one.
        """
        plant = self.plant
        self.valve.hold(self._held, begin, part, plant.time, plant.step)
        plant.advance_in_parts(self._held)
        self.total += 1
        self._read()

    def _read(self) -> None:
        """Read the sensors into `reading`."""
        self._now[0] = self.plant.time
        self._observe(self._row, self._values, self._held[-1:].reshape(1, 1), self._now, self._seen)
        seen = self._seen[0].tolist()
        y, p_a, p_b = self._places
        self.reading = self.sensors.read(Reading(seen[y], float(self.plant.state[1]), seen[p_a], seen[p_b]))

    @property
    def clock(self) -> int:
        """Simulated time [ns] for stamps: it continues over a reset, and begins one sample after 0, because 0 in ROS
        means no time.
        """
        return round((self.total + 1) * 1e9 / self.rate)

    @property
    def effort(self) -> float:
        """A_a p_a - A_b p_b - p_atm (A_a - A_b) [N] of the present reading."""
        area_a, area_b, atmosphere = self._areas
        return area_a * self.reading.pressure_a - area_b * self.reading.pressure_b - atmosphere
