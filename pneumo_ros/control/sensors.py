"""Sensors between a simulated plant and its control law."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.control.measurement import Measurement

BLOCK = 4096  # samples of noise that are drawn at once


class NoisySensors:
    """Position and pressures with white noise, and no velocity: what a rig measures. The same seed repeats it."""

    def __init__(self, position: float = 1e-5, pressure: float = 300.0, seed: int = 0) -> None:
        """Standard deviations of `position` [m] and `pressure` [Pa]."""
        self._deviations = np.array([position, pressure, pressure])
        self._random, self._noise = np.random.default_rng(seed), iter([[0.0] * 3][:0])

    def __call__(self, time: float, state: NDArray[np.float64]) -> Measurement:
        """What is measured at `state` (states,), which begins with y, v, p_a, p_b."""
        y, a, b = self._next()
        return Measurement(time, float(state[0]) + y, None, float(state[2]) + a, float(state[3]) + b)

    def _next(self) -> list[float]:
        drawn: list[float] | None = next(self._noise, None)
        if drawn is None:
            self._noise = iter((self._deviations * self._random.standard_normal((BLOCK, 3))).tolist())
            drawn = next(self._noise)
        return drawn
