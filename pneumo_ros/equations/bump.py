"""The test function of weak forms: a smooth bump that vanishes, with its derivatives, at the ends of its window."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant.jit import summed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bump:
    """phi(t) = (1 - tau^2)^6 on a window of `width` samples; sums of a signal with these weights are weighted means.

    phi, first, second (width,): weights of phi and of its first [1/s] and second [1/s2] derivative in time. The
    derivatives are those of sums by parts, differences of neighbours: sum phi x' = -sum first x and sum phi x'' =
    sum second x hold for samples x, and not only for their integrals, with x' over the two intervals around a sample.
    """

    width: int
    phi: Array
    first: Array
    second: Array

    @classmethod
    def of(cls, duration: float, sample_time: float) -> "Bump":
        """A bump over `duration` [s], at least nine samples."""
        half = max(round(0.5 * duration / sample_time), 4)
        tau = np.arange(-half, half + 1) / half
        c, step = 1.0 - tau**2, sample_time
        phi = c**6 / np.sum(c**6)
        around = np.pad(phi, 1)  # phi is 0 at the ends of its window, and beyond
        first = (around[2:] - around[:-2]) / (2.0 * step)
        second = (around[2:] - 2.0 * phi + around[:-2]) / step**2
        return cls(2 * half + 1, phi, first, second)

    def coarseness(self, factor: float) -> float:
        """Error of sums in place of integrals and of simulated friction, as a share of the integrand."""
        return factor / (self.width - 1) ** 2 + 1e-5

    @property
    def step(self) -> int:
        """Samples from one window to the next: a quarter of the width."""
        return max(self.width // 4, 1)

    def apply(self, weights: Array, signal: Array) -> Array:
        """Weighted sums (windows,) of a signal (n,) over windows a quarter of their width apart; none if n < width."""
        if len(signal) < self.width:
            return np.empty(0)
        count, parts = (len(signal) - self.width) // self.step + 1, -(-self.width // self.step)
        # Windows share quarters: each quarter is multiplied once, by all weights that apply to it.
        quarters, columns = np.zeros((count + parts - 1, self.step)), np.zeros((parts, self.step))
        own = min(len(signal), quarters.size)
        quarters.ravel()[:own], columns.ravel()[: self.width] = signal[:own], weights
        shares = quarters @ columns.T
        return np.asarray(sum(shares[k : k + count, k] for k in range(parts)))

    def means(self, rates: Array, factor: Array | None = None) -> Array:
        """Weighted sums (windows,) of rates (n,), means over the interval before each sample, times a factor (n,).

        At each sample stands the mean of the intervals on both sides: a sum over samples is then the integral, with
        input steps included. As `apply` of phi to those means, in a third of the time and beside other threads.
        """
        found = np.empty(max((len(rates) - self.width) // self.step + 1, 0))
        factor = np.ones(len(rates)) if factor is None else factor
        _weigh(0.5 * (self.phi[1:] + self.phi[:-1]), self.step, rates, factor, found)  # phi is 0 at both ends
        return found

    def centres(self, samples: int) -> NDArray[np.int64]:
        """Sample at the middle of each window of a signal of that many samples."""
        first = np.arange(max(samples - self.width + 1, 0), step=self.step)
        return np.asarray(first + self.width // 2, dtype=np.int64)

    def _windows(self, signal: Array) -> Array:
        if len(signal) < self.width:
            return np.empty((0, self.width))
        every = np.lib.stride_tricks.sliding_window_view(signal, self.width)
        return np.asarray(every[:: self.step])

    def noise(self, terms: list[tuple[Array, Array]]) -> Array:
        """Standard deviation (windows,) of a residual to which unit white noise contributes by the sum over `terms`.

        Each term is weights (width,) and a signal (n,) that multiplies the noise of each sample.
        """
        gain = sum(weights * self._windows(signal) for weights, signal in terms)
        return np.asarray(np.sqrt(np.sum(np.square(gain), axis=1)))


@summed  # numba finds the types by the call
def _weigh(weights, step, rates, factor, found):  # type: ignore[no-untyped-def]
    """found (windows,): sums of rates (n,) times factor (n,) by weights (some,), from the second sample of a window."""
    own = np.empty(len(rates))
    for i in range(len(rates)):
        own[i] = rates[i] * factor[i]
    for k in range(len(found)):
        window = own[k * step + 1 : k * step + 1 + len(weights)]
        total = 0.0
        for j in range(len(weights)):
            total += weights[j] * window[j]
        found[k] = total
