"""Derivatives of the residuals of segments by their starts."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.shooting.segments import Segments

Array = NDArray[np.float64]
# segments and states (copies * segments, states) -> residuals (copies, segments, residuals)
Residuals = Callable[[Segments, Array], Array]

PROBE = 1e-2  # scales: step of finite differences
LANES = 1024  # lanes at once: more need memory and save no time


def start_slopes(model: Model, segments: Segments, states: Array, residuals: Residuals) -> tuple[Array, Array]:
    """Residuals (segments, residuals), and their slopes (segments, states, residuals) by the starts in scales.

    The last residuals are the distances of the states from their guesses. A state that is not estimated changes that
    distance alone, so that equations with it can be solved.
    """
    n, estimated = states.shape[1], segments.estimated(model)
    base = residuals(segments, states)[0]
    slopes = np.zeros((len(states), n, base.shape[1]))
    everywhere = estimated.all(axis=0)
    somewhere = estimated.any(axis=0) & ~everywhere  # at the beginnings of runs, which are few
    for rows, probed in (
        (np.arange(len(states)), np.flatnonzero(everywhere)),
        (np.flatnonzero(estimated[:, somewhere].any(axis=1)), np.flatnonzero(somewhere)),
    ):
        part, each = segments.pick(rows), max(LANES // max(len(rows), 1), 1)
        for first in range(0, len(probed), each):
            some = probed[first : first + each]
            found = residuals(part, _probes(part, states[rows], some))
            for j, one in zip(some, found, strict=True):
                slopes[rows, j] = (one - base[rows]) / PROBE
    for j in range(n):
        slopes[~estimated[:, j], j, base.shape[1] - n + j] = 1.0
    return base, slopes


def _probes(segments: Segments, states: Array, columns: NDArray[np.int64]) -> Array:
    """States (columns * segments, states), each of the columns in turn moved by `PROBE` of its scale."""
    moved = np.tile(states, (len(columns), 1, 1))
    for k, j in enumerate(columns):
        moved[k, :, j] += PROBE * segments.scale[:, j]
    return moved.reshape(-1, states.shape[1])
