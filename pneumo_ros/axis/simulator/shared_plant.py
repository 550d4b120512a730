"""The plant of several axes, stepped sample by sample by one kernel; to a simulation each is what a `Stepper` is."""

from collections.abc import Mapping
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError
from pneumo_ros.multiaxis import Machine
from pneumo_ros.multiaxis.drawing import MEASURED
from pneumo_ros.plant import Model
from pneumo_ros.plant.model import substeps

Array = NDArray[np.float64]


class AxisPlant:
    """One axis of a `SharedPlant`, which advances it: its model, its state (states,) and its time."""

    def __init__(self, whole: "SharedPlant", name: str, model: Model) -> None:
        self._whole, self._name, self.begun = whole, name, 0
        self.model, self.state = model, model.state()

    @property
    def parts(self) -> int:
        """Integration steps in a sample."""
        return self._whole.parts

    @property
    def step(self) -> float:
        """Length of an integration step [s]."""
        return self._whole.step

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset of this axis."""
        return (self._whole.samples - self.begun) * self._whole.sample_time

    def advance_in_parts(self, inputs: Array) -> Array:
        """Never: no axis moves without the others."""
        raise NotImplementedError(f"{self._name} is advanced with its machine")

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self.state = model.continued(self.model, self.state)
        self.model = model
        self._whole.adopt({self._name: model})

    def reset(self, state: Array) -> None:
        """Back to time 0 at `state` (states,) while the other axes go on."""
        self.state[:], self.begun = state, self._whole.samples


class SharedPlant:
    """All axes of a machine and the supply's drop [Pa]; models of its axes may change between two samples."""

    def __init__(self, machine: Machine, *, sample_time: float, step: float) -> None:
        """`sample_time` [s] per sample, in steps no longer than `step` [s]; the kernel is compiled or loaded here."""
        self.parts, self.step = substeps(sample_time, step)
        self.sample_time, self.samples, self.drop, self.machine = sample_time, 0, 0.0, machine
        self.axes = {name: AxisPlant(self, name, model) for name, model in machine.axes.items()}
        self.adopt({})

    def adopt(self, models: Mapping[str, Model]) -> None:
        """Take other models of some axes, whose states fit them already."""
        machine = self.machine.with_axes(models)
        columns = [
            [self.axes[name].model.inputs.index(one) for one in drawing.inputs if one != MEASURED]
            for name, drawing in machine.drawing.items()
        ]
        machine.simulate(np.zeros((self.parts, len(machine.inputs))), machine.state(), sample_time=self.sample_time,
                         step=self.step, parts=self.parts)  # fmt: skip
        self.machine, self._columns, self._values = machine, columns, machine.values

    @property
    def supply_pressure(self) -> float:
        """Pressure [Pa] at the valves of the axes."""
        supplied = next(one for one in self.machine.axes.values() if "air.supply_pressure" in one.parameters)
        return supplied["air.supply_pressure"] - self.drop

    def reset(self) -> None:
        """Time 0 and a full supply; the axes are reset by their simulations, after this."""
        self.samples, self.drop = 0, 0.0

    def advance(self, held: Mapping[str, Array]) -> None:
        """One sample with the inputs (parts, inputs) of each axis, in the order of its model.

        Raises NumericalError, naming the axes, when a state leaves the finite numbers; the last finite ones are kept.
        """
        inputs = np.column_stack([held[n][:, c] for n, c in zip(self.axes, self._columns, strict=True)])
        rows = [part for one in self.axes.values() for part in (one.state, [0.0])]  # nothing drawn in this sample yet
        x = np.concatenate([*rows, [self.drop]])
        self._values[-len(self.axes) :] = [one.begun * self.sample_time for one in self.axes.values()]
        out = np.empty((1, len(x)))
        self.machine.kernel.run(x, self._values, inputs, self.samples * self.sample_time, self.step, 1, self.parts, out)
        if not np.isfinite(x).all():
            self._fail(held)
        for name, state in self.machine.split(x).items():
            self.axes[name].state[:] = state
        self.drop = float(x[-1])
        self.samples += 1

    def _fail(self, held: Mapping[str, Array]) -> NoReturn:
        """Name the axes that fail by themselves in a sample with these inputs: through the supply, all of them do."""
        time, bad = self.samples * self.sample_time, []
        how = {"sample_time": self.sample_time, "step": self.step}
        for name, one in self.axes.items():
            try:
                one.model.simulate(held[name], one.state, parts=self.parts, **how)
            except NumericalError:
                bad.append(name)
        names = " and ".join(bad or self.axes)
        raise NumericalError(f"the state of {names} left the finite numbers at t = {time:.3f} s")
