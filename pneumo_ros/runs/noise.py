"""Sensor noise, estimated from the recording itself."""

from math import comb

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ORDER = 4  # of the differences: they remove motion that is cubic over five samples
_BLOCK = 100  # samples


def noise_level(signal: Array) -> float:
    """Standard deviation of the white noise in a sampled smooth signal (n,), quantisation included.

    Fourth-order differences remove the motion. Their variance in short blocks is that of the noise, except in blocks
    with an event (breakaway, impact): the middle half of the blocks, sorted by variance, is averaged. Lower limits:
    q / sqrt(12), the uniform error of a quantisation step q, and a millionth of the signal's span.
    """
    differences = np.diff(signal, _ORDER) if len(signal) > _ORDER else np.zeros(1)
    gain = sum(comb(_ORDER, k) ** 2 for k in range(_ORDER + 1))
    blocks = differences[: len(differences) // _BLOCK * _BLOCK].reshape(-1, _BLOCK)
    variances = np.sort(np.mean(blocks**2, axis=1) if len(blocks) else [np.mean(differences**2)])
    quarter = len(variances) // 4
    middle = variances[quarter : len(variances) - quarter]
    floor = max(resolution(signal) / np.sqrt(12.0), 1e-6 * float(np.ptp(signal)), 1e-12)
    return float(max(np.sqrt(np.mean(middle) / gain), floor))


def resolution(signal: Array) -> float:
    """Quantisation step of a signal: the smallest difference between its values, 0 when it looks continuous."""
    levels = np.unique(signal)
    if len(levels) < 2 or len(levels) > len(signal) // 4:
        return 0.0
    return float(np.min(np.diff(levels)))
