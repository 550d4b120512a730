"""Least-squares polynomials along evenly sampled signals (A. Savitzky and M. J. E. Golay, Anal. Chem. 36, 1964).

As `savgol_coeffs` and `savgol_filter` of scipy.signal, to the last digits: importing that takes half a second of every
start.
"""

from math import factorial

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq
from scipy.ndimage import convolve1d

Array = NDArray[np.float64]


def weights(width: int, order: int, derivative: int = 0, step: float = 1.0) -> Array:
    """Weights (width,) of a convolution: the `derivative` of the polynomial of `order` at the middle of the window.

    width: samples, odd; step: between samples, in any unit; the result is in units of the signal per step**derivative.
    """
    half = width // 2
    powers = np.arange(-half, half + 1, dtype=float)[::-1] ** np.arange(order + 1).reshape(-1, 1)
    wanted = np.zeros(order + 1)
    wanted[derivative] = factorial(derivative) / step**derivative
    return np.asarray(lstsq(powers, wanted)[0])


def along(signal: Array, width: int, order: int, derivative: int = 0, step: float = 1.0) -> Array:
    """The `derivative` of the local polynomial at every sample of the signal (n,); at the ends, of the last window."""
    found = np.asarray(convolve1d(signal, weights(width, order, derivative, step), mode="constant"))
    half = width // 2
    found[:half] = _of_window(signal[:width], np.arange(half), order, derivative, step)
    found[-half:] = _of_window(signal[-width:], np.arange(width - half, width), order, derivative, step)
    return found


def _of_window(signal: Array, at: NDArray[np.int64], order: int, derivative: int, step: float) -> Array:
    """One polynomial through a window, at its samples `at`."""
    polynomial = np.polyfit(np.arange(len(signal)), signal, order)
    return np.asarray(np.polyval(np.polyder(polynomial, derivative), at) / step**derivative)
