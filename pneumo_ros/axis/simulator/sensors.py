"""The sensors: noise of a given seed, and quantisation."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

_BLOCK = 4096  # draws at a time: one draw per sample would cost more than the kernel


class Reading(NamedTuple):
    """One sample of all sensors: m, m/s (None: not measured), Pa abs (NaN: of a side that is no chamber)."""

    position: float
    velocity: float | None
    pressure_a: float
    pressure_b: float


@dataclass
class Sensors:
    """Gaussian noise (standard deviations [m], [Pa]) and quantisation (steps [m], [Pa], 0: none).

    Every reading uses the same number of draws: a change of one level leaves the noise of the others as it is.
    """

    noise_position: float = 0.0
    noise_pressure: float = 0.0
    quantisation_position: float = 0.0
    quantisation_pressure: float = 0.0
    publish_velocity: bool = True
    seed: int = 0

    def __post_init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Restart the noise sequence of the seed."""
        self._random = np.random.Generator(np.random.PCG64(self.seed))
        self._draws: list[list[float]] = []

    def read(self, true: Reading) -> Reading:
        """The reading of a true state; the velocity, if published, has no error."""
        if not self._draws:
            self._draws = self._random.standard_normal((_BLOCK, 3)).tolist()
        e_y, e_a, e_b = self._draws.pop()
        return Reading(
            _rounded(true.position + self.noise_position * e_y, self.quantisation_position),
            true.velocity if self.publish_velocity else None,
            _rounded(true.pressure_a + self.noise_pressure * e_a, self.quantisation_pressure),
            _rounded(true.pressure_b + self.noise_pressure * e_b, self.quantisation_pressure),
        )

    @property
    def pressure_variance(self) -> float:
        """Variance of a pressure [Pa2]: noise, and the uniform error of rounding."""
        return self.noise_pressure**2 + self.quantisation_pressure**2 / 12.0


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step if step > 0.0 and not math.isnan(value) else value
