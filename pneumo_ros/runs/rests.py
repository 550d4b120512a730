"""Where the piston of a recording rests."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.runs.run import Run
from pneumo_ros.runs.smooth import HALF_WIDTH, noise_gain

REST = 0.15  # s without motion after which a piston counts as resting
_NEAR = 4.0  # deviations of the smoothed position: a piston that keeps within so many of them rests


def resting(run: Run) -> NDArray[np.bool_]:
    """Samples (n,) within stretches of 0.15 s or more in which the smoothed position stays within its own noise.

    What is less than the noise of single samples is motion still: a play, or a load on a spring, takes all of its way.
    """
    width = max(round(REST / run.sample_time), 2)
    near = _NEAR * run.noise["position_m"] * noise_gain(run.sample_time, HALF_WIDTH, 3)
    still = np.zeros(len(run), dtype=bool)
    if len(run) < width:
        return still
    every = np.lib.stride_tricks.sliding_window_view(run.smoothed.motion[:, 0], width)
    quiet = np.flatnonzero(every.max(axis=1) - every.min(axis=1) < 2.0 * near)
    marks = np.zeros(len(run) + 1)
    np.add.at(marks, quiet, 1.0)
    np.add.at(marks, quiet + width, -1.0)
    return np.asarray(np.cumsum(marks)[:-1] > 0.0)
