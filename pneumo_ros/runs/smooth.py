"""Velocity and acceleration from sampled positions, with a known noise gain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.runs.local_polynomial import along, weights

Array = NDArray[np.float64]

HALF_WIDTH = 0.012  # s, of the local polynomials


@dataclass(frozen=True)
class Smoothed:
    """A recording smoothed: motion (n, 2), which is y and v, acceleration (n,), and further signals (n,) by name."""

    motion: Array
    acceleration: Array
    further: Mapping[str, Array]

    def states(self, chambers: Sequence[Chamber]) -> Array:
        """The measured states (n, 2 + chambers) of a machine with these chambers: y, v and their pressures."""
        return np.column_stack([self.motion, *(self.further[chamber.signal] for chamber in chambers)])

    @property
    def frame(self) -> Array:
        """(n, 2 + further) y, v and every further signal."""
        return np.column_stack([self.motion, *self.further.values()])


def smoothed(sample_time: float, position: Array, further: Mapping[str, Array]) -> Smoothed:
    """Position, velocity, acceleration and further signals (pressures) by local polynomials over +-12 ms."""
    motion = [smooth(position, sample_time, HALF_WIDTH, 3), smooth(position, sample_time, HALF_WIDTH, 3, 1)]
    acceleration = smooth(position, sample_time, 1.5 * HALF_WIDTH, 3, 2)
    others = {name: smooth(signal, sample_time, HALF_WIDTH, 2) for name, signal in further.items()}
    return Smoothed(np.stack(motion, axis=1), acceleration, others)


def smooth(signal: Array, sample_time: float, half_width: float, order: int, derivative: int = 0) -> Array:
    """Local polynomial of `order` over +-`half_width` [s] (Savitzky and Golay 1964): its `derivative` at every sample.

    signal (n,), returns (n,), in units of the signal per s**derivative. Near the ends the last full window is used.
    """
    width = _window(len(signal), sample_time, half_width, order)
    return along(signal, width, min(order, width - 1), derivative, sample_time)


def noise_gain(sample_time: float, half_width: float, order: int, derivative: int = 0) -> float:
    """Standard deviation of the result of `smooth` over that of white noise in the signal, in 1/s**derivative."""
    return _gain(_window(10**9, sample_time, half_width, order), sample_time, order, derivative)


def _window(samples: int, sample_time: float, half_width: float, order: int) -> int:
    width = 2 * max(round(half_width / sample_time), order // 2 + 1) + 1
    return min(width, samples - 1 + samples % 2)


@lru_cache(maxsize=64)
def _gain(width: int, sample_time: float, order: int, derivative: int) -> float:
    return float(np.linalg.norm(weights(width, order, derivative, sample_time)))
