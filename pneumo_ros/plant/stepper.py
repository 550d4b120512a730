"""Stepping a plant that runs on: for nodes and closed loops, where parameters and effects may change under way."""

import math

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant.model import STEP, Model, substeps


class Stepper:
    """A model, its current state and time; `advance` costs little more than the kernel."""

    def __init__(
        self, model: Model, state: NDArray[np.float64], *, sample_time: float = 1e-3, step: float = STEP
    ) -> None:
        """Start at `state` (states,), time 0; `sample_time` [s] per `advance`, in steps no longer than `step` [s].

        The kernel is compiled or loaded here, so that no later call waits for it. Raises UsageError for a state that
        does not fit the model.
        """
        self._stride, self._h = substeps(sample_time, step)
        self.sample_time = sample_time
        self._voltage, self.time = np.zeros(1), 0.0
        self._adopt(model, model._state_vector(state))

    def _adopt(self, model: Model, state: NDArray[np.float64]) -> None:
        out = np.empty((1, len(state)))
        model.kernel.run(state.copy(), model.values, np.zeros(0), 0.0, self._h, self._stride, 1, out[:0])
        self.model, self.state, self._values, self._out, self._run = model, state, model.values, out, model.kernel.run

    def advance(self, voltage: float) -> NDArray[np.float64]:
        """Hold `voltage` [V] for one sample; returns the state (states,), a view that the next call overwrites.

        Raises NumericalError when the state leaves the finite numbers; the stepper then still holds the last good one.
        UsageError for a voltage that is no finite number.
        """
        if not math.isfinite(voltage):
            raise UsageError(f"voltage is {voltage}; it takes a finite number")
        self._voltage[0] = voltage
        before = self.state.copy()
        self._run(self.state, self._values, self._voltage, self.time, self._h, self._stride, 1, self._out)
        if not np.isfinite(self.state).all():
            self.state = before
            raise NumericalError(f"the state left the finite numbers at t = {self.time:.3f} s")
        self.time += self.sample_time
        return self.state

    def replace(self, model: Model) -> None:
        """Go on with another model: states of the same name keep their values, new ones start at rest."""
        self._adopt(model, model.continued(self.model, self.state))

    def reset(self, state: NDArray[np.float64]) -> None:
        """Back to time 0 at `state` (states,); UsageError when it does not fit."""
        self.state, self.time = self.model._state_vector(state), 0.0
