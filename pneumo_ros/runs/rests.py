"""Where the piston of a recording rests."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.smooth import HALF_WIDTH, noise_gain

Array = NDArray[np.float64]

REST = 0.15  # s without motion after which a piston counts as resting
_NEAR = 4.0  # deviations of the smoothed position: a piston that keeps within so many of them rests


def resting(smoothed: Array, noise: float, sample_time: float) -> NDArray[np.bool_]:
    """Samples (n,) within stretches of 0.15 s or more in which a smoothed position (n,) stays within its own noise.

    noise: deviation of single samples. What is less is motion still: a play, or a load on a spring, takes all of its
    way.
    """
    width = max(round(REST / sample_time), 2)
    near = _NEAR * noise * noise_gain(sample_time, HALF_WIDTH, 3)
    still = np.zeros(len(smoothed), dtype=bool)
    if len(smoothed) < width:
        return still
    every = np.lib.stride_tricks.sliding_window_view(smoothed, width)
    quiet = np.flatnonzero(every.max(axis=1) - every.min(axis=1) < 2.0 * near)
    marks = np.zeros(len(smoothed) + 1)
    np.add.at(marks, quiet, 1.0)
    np.add.at(marks, quiet + width, -1.0)
    return np.asarray(np.cumsum(marks)[:-1] > 0.0)
