"""Derivatives of the residuals of segments by their starts."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.shooting.segments import Segments

Array = NDArray[np.float64]
Index = NDArray[np.int64]
# some segments, their rows, and states (copies * rows, states) -> residuals (copies, rows, residuals)
Residuals = Callable[[Segments, Index, Array], Array]

PROBE = 1e-2  # scales: step of finite differences
LANES = 1024  # lanes at once: more need memory and save no time


def start_slopes(model: Model, segments: Segments, states: Array, residuals: Residuals) -> tuple[Array, Array]:
    """Residuals (segments, residuals), and their slopes (segments, states, residuals) by the starts in scales.

    The last residuals are the distances of the states from their guesses. A state that is not estimated changes that
    distance alone, so that equations with it can be solved.
    """
    n, estimated = states.shape[1], segments.estimated(model)
    everywhere = estimated.all(axis=0)
    somewhere = estimated.any(axis=0) & ~everywhere  # at the beginnings of runs, which are few
    rows = np.flatnonzero(estimated[:, somewhere].any(axis=1))
    # the starts as they are run in one batch with the moved ones: a small batch takes as long as a full block of lanes
    all_over, here_and_there = np.flatnonzero(everywhere).tolist(), np.flatnonzero(somewhere).tolist()
    base, *found = _seen(segments, np.arange(len(states)), states, [None, *all_over], residuals)
    slopes = np.zeros((len(states), n, base.shape[1]))
    for j, one in zip(all_over, found, strict=True):
        slopes[:, j] = (one - base) / PROBE
    found = _seen(segments.pick(rows), rows, states[rows], here_and_there, residuals)
    for j, one in zip(here_and_there, found, strict=True):
        slopes[rows, j] = (one - base[rows]) / PROBE
    for column in range(n):
        slopes[~estimated[:, column], column, base.shape[1] - n + column] = 1.0
    return base, slopes


def _seen(
    segments: Segments, rows: Index, states: Array, columns: Sequence[int | None], residuals: Residuals
) -> list[Array]:
    """Residuals (segments, residuals) with each of the columns in turn moved by `PROBE` of its scale, or none moved."""
    each = max(LANES // max(len(segments), 1), 1)
    found = list[Array]()
    for first in range(0, len(columns), each):
        some = columns[first : first + each]
        moved = np.tile(states, (len(some), 1, 1))
        for k, j in enumerate(some):
            if j is not None:
                moved[k, :, j] += PROBE * segments.scale[:, j]
        found += list(residuals(segments, rows, moved.reshape(-1, states.shape[1])))
    return found
