"""A plant stepped sample by sample, for nodes and closed loops: parameters and effects may change while it runs."""

import math

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant.model import STEP, Model, substeps

Array = NDArray[np.float64]


class Stepper:
    """A model, its present state and time. A step takes little longer than its kernel.

    A sample has `parts` integration steps of `step` [s]; the inputs may change from step to step.
    """

    def __init__(self, model: Model, state: Array, *, sample_time: float = 1e-3, step: float = STEP) -> None:
        """Start at `state` (states,), time 0; `sample_time` [s] per sample, in steps no longer than `step` [s].

        The kernel is compiled or loaded here, so that no later call waits for it. Raises UsageError for a state that
        does not fit the model.
        """
        self.parts, self.step = substeps(sample_time, step)
        self.sample_time = sample_time
        self.samples = 0  # since the start or the last reset
        self._adopt(model, model._state_vector(state))

    def _adopt(self, model: Model, state: Array) -> None:
        out = np.empty((1, len(state)))
        width = len(model.inputs)
        model.kernel.run(state.copy(), model.values, np.zeros((0, width)), 0.0, self.step, self.parts, 1, out[:0])
        self._inputs = np.zeros((1, width))
        self.model, self.state, self._values, self._out, self._run = model, state, model.values, out, model.kernel.run

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset."""
        return self.samples * self.sample_time

    def advance(self, voltage: float, *measured: float) -> Array:
        """Hold `voltage` [V] for one sample; returns the state (states,), a view that the next call overwrites.

        `measured`: the further inputs of the model, in the order of `Model.inputs`. Raises NumericalError when the
        state leaves the finite numbers; the stepper then keeps the last finite state. UsageError for an input that is
        no finite number, and for too many or too few.
        """
        if not math.isfinite(voltage):
            raise UsageError(f"voltage is {voltage}; it takes a finite number")
        if len(measured) != self._inputs.shape[1] - 1 or not all(map(math.isfinite, measured)):
            raise UsageError(f"inputs are {(voltage, *measured)}; finite numbers are needed: {self.model.inputs}")
        self._inputs[0, 0], self._inputs[0, 1:] = voltage, measured
        return self._sample(self._inputs, self.parts, 1)

    def advance_in_parts(self, inputs: Array) -> Array:
        """One sample with finite inputs for each of its steps, (parts,) or (parts, inputs); otherwise as `advance`."""
        width = self._inputs.shape[1]
        if inputs.size != self.parts * width:  # the kernel would read beyond their end
            raise UsageError(f"inputs of shape {inputs.shape} do not fit {self.parts} steps of {self.model.inputs}")
        return self._sample(inputs.reshape(self.parts, width), 1, self.parts)

    def _sample(self, inputs: Array, stride: int, every: int) -> Array:
        """Hold each row of inputs for `stride` steps; `every` rows make the sample."""
        before = self.state.copy()
        self._run(self.state, self._values, inputs, self.time, self.step, stride, every, self._out)
        if not math.isfinite(self.state.sum()):  # finite states of a machine have a finite sum
            self.state[:] = before
            raise NumericalError(f"the state left the finite numbers at t = {self.time:.3f} s")
        self.samples += 1
        return self.state

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self._adopt(model, model.continued(self.model, self.state))

    def reset(self, state: Array) -> None:
        """Back to time 0 at `state` (states,); UsageError when it does not fit."""
        self.state[:] = self.model._state_vector(state)
        self.samples = 0
