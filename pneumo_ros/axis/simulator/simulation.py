"""The plant of a simulator: valve and force inputs, stepper and sensors, advanced sample by sample."""

import math

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.axis.simulator.force_input import GAIN, LOAD, ForceInput, pushed
from pneumo_ros.axis.simulator.sensors import Reading, Sensors
from pneumo_ros.axis.simulator.shared_plant import AxisPlant
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.plant import Model, Stepper
from pneumo_ros.plant.actuator import SIDES
from pneumo_ros.plant.closed import SECOND, second_closed
from pneumo_ros.plant.signals import DRIVE

Array = NDArray[np.float64]

ATMOSPHERE = "air.atmospheric_pressure"


class Simulation:
    """A stepper between valve commands and sensor readings; model and parameters may change between two samples."""

    def __init__(
        self, model: Model, valve: ValveInput, sensors: Sensors, *, rate: float, step: float,
        plant: AxisPlant | None = None,
    ) -> None:  # fmt: skip
        """Sample at `rate` [Hz], integrate in steps no longer than `step` [s]. The kernel is compiled here.

        `plant`: that of `pushed(model)` among several axes; None for a plant of its own.
        """
        self.rate, self.valve, self.sensors = rate, valve, sensors
        self.valve_b = ValveInput(valve.max_voltage, valve.timeout, second_closed(model) or 0.0)
        self.force, self._model = ForceInput(), model
        self.plant = plant or Stepper(pushed(model), model.state(), sample_time=1.0 / rate, step=step)
        self.total = 0  # samples since the start
        self.initial: dict[str, float] = {}
        self._inputs: dict[str, Array] = {}  # (parts,) each, the columns of _held by name
        self._now = np.zeros(1)
        self._observe_model()
        self.reset()

    @property
    def model(self) -> Model:
        """The model as it is now."""
        return self._model

    @property
    def described(self) -> Model:
        """The model that explains a recording: with the external force as a measured load, once there was one."""
        return self.plant.model if self.force.accepted else self._model

    @property
    def load_cell(self) -> float | None:
        """What a load cell at the rod reads [N], positive where the force extends; None before the first force."""
        return float(self._inputs[LOAD][-1]) if self.force.accepted else None

    @property
    def valves(self) -> list[ValveInput]:
        """The inputs of the machine's valves: that of chamber b where it has a command of its own."""
        return [valve for _, valve in self._commanded()]

    def _commanded(self) -> list[tuple[str, ValveInput]]:
        return [(name, valve) for name, valve in ((DRIVE, self.valve), (SECOND, self.valve_b)) if name in self._inputs]

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset."""
        return self.plant.time

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self._model = model
        self.plant.replace(pushed(model))
        self._observe_model()

    def _observe_model(self) -> None:
        """Prepare the reading of the sensors for the present model."""
        model, observed = self.plant.model, self.plant.model.composition.observed
        self._values, self._observe, self._row = model.values, model.kernel.observe, self.plant.state[np.newaxis]
        self._seen = np.empty((1, len(observed)))
        read = ("y_measured", *(f"{chamber.state}_measured" for chamber in model.chambers))
        self._places, self._sides = [observed.index(s) for s in read], [chamber.side for chamber in model.chambers]
        if [*self._inputs] != [*model.inputs]:
            self._held = np.zeros((self.plant.parts, len(model.inputs)))
            self._inputs = dict(zip(model.inputs, self._held.T, strict=True))
        self._areas, self._atmosphere = (model["piston.area_a"], model["piston.area_b"]), model[ATMOSPHERE]

    def reset(self) -> None:
        """Back to time 0, the state `initial` and the first number of the noise, valve closed."""
        self.plant.reset(self.plant.model.state(**self.initial))
        for valve in (self.valve, self.valve_b):
            valve.reset()
        self.force.reset()
        self._held[:] = 0.0
        self.sensors.reset()
        self._read()

    def advance(self, begin: int, part: float) -> None:
        """One sample, which began at `begin` [ns] on the clock of arrivals; each of its parts took `part` [ns].

        Raises NumericalError when the state is no longer finite; the state then is the last finite one.
        """
        self.plant.advance_in_parts(self.hold(begin, part))
        self.sense()

    def hold(self, begin: int, part: float) -> Array:
        """Inputs (parts, inputs) of the sample that `advance` makes; the next one overwrites them."""
        plant = self.plant
        for name, valve in self._commanded():
            valve.hold(self._inputs[name], begin, part, plant.time, plant.step)
        gain = plant.model[GAIN]
        self._inputs[LOAD][:] = self.force.at(plant.time) / gain if gain else 0.0
        return self._held

    def sense(self) -> None:
        """Read the sensors at the end of a sample."""
        self.total += 1
        self._read()

    def _read(self) -> None:
        """Read the sensors into `reading`."""
        self._now[0] = self.time
        self._observe(self._row, self._values, self._held[-1:], self._now, self._seen)
        seen = self._seen[0].tolist()
        position, *pressures = (seen[place] for place in self._places)
        by_side = dict(zip(self._sides, pressures, strict=True))
        p_a, p_b = (by_side.get(side, math.nan) for side in SIDES)
        self.reading = self.sensors.read(Reading(position, float(self.plant.state[1]), p_a, p_b))

    @property
    def clock(self) -> int:
        """Simulated time [ns] for stamps: it continues over a reset, and begins one sample after 0, because 0 in ROS
        means no time.
        """
        return round((self.total + 1) * 1e9 / self.rate)

    @property
    def effort(self) -> float:
        """A_a p_a - A_b p_b - p_atm (A_a - A_b) [N] of the present reading."""
        (area_a, area_b), reading, atmosphere = self._areas, self.reading, self._atmosphere
        p_a, p_b = (atmosphere if math.isnan(p) else p for p in (reading.pressure_a, reading.pressure_b))
        return area_a * p_a - area_b * p_b - atmosphere * (area_a - area_b)
