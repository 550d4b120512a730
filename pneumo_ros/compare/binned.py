"""Means over bins of a variable, with intervals that allow for the correlation of neighbouring values."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

Array = NDArray[np.float64]
Index = NDArray[np.int64]

CLUSTER = 0.5  # s: values within this time count as one in the interval of a mean
_CLUSTERS = 4  # fewest clusters whose scatter gives an interval


@dataclass(frozen=True)
class Bins:
    """Bins that hold enough values, in the order of the variable; every array is (bins,)."""

    low: Array
    high: Array
    centre: Array  # mean of the variable
    mean: Array
    below: Array  # 95 % interval of the mean; NaN where the bin holds fewer than four clusters
    above: Array
    count: Array
    members: list[Index]  # which values each bin holds


def clusters(time: Array, run: Index, duration: float = CLUSTER) -> Index:
    """A cluster number for each value: the same for values of one run within the same `duration` [s]."""
    whole = np.floor(time / duration + 1e-9)  # 1.2 s must be three times 0.4 s despite rounding
    pairs = np.stack([run, whole.astype(np.int64)], axis=1)
    return np.asarray(np.unique(pairs, axis=0, return_inverse=True)[1], dtype=np.int64).reshape(-1)


def edges(variable: Array, count: int) -> Array:
    """Bin edges (at most count + 1,): half by equal width, half by equal numbers, so that no end lacks values."""
    order = np.sort(variable)
    span = float(order[-1] - order[0])
    if not span > 0.0:
        return np.array([order[0] - 0.5, order[0] + 0.5])
    rank = np.linspace(0.0, 1.0, len(order))
    mixed = 0.5 * (order - order[0]) / span + 0.5 * rank
    found = np.interp(np.linspace(0.0, 1.0, count + 1), mixed, order)
    found[-1] = np.nextafter(order[-1], np.inf)
    return np.unique(found)


def bin_means(variable: Array, value: Array, cluster: Index, at: Array, fewest: int) -> Bins:
    """Means of `value` (n,) in bins of `variable` (n,) with edges `at`; bins of fewer than `fewest` are left out.

    The interval is cluster-robust (Liang and Zeger 1986): deviations are summed within clusters first, and Student's
    factor is that of the number of clusters.
    """
    place = np.digitize(variable, at) - 1
    rows = []
    for k in range(len(at) - 1):
        inside = np.flatnonzero(place == k)
        if len(inside) < fewest:
            continue
        mean, half = _mean(value[inside], cluster[inside])
        rows.append((at[k], at[k + 1], variable[inside].mean(), mean, mean - half, mean + half, len(inside), inside))
    table = np.array([row[:7] for row in rows], dtype=float).reshape(-1, 7).T
    low, high, centre, means, below, above, count = table
    return Bins(low, high, centre, means, below, above, count, [row[7] for row in rows])


def _mean(value: Array, cluster: Index) -> tuple[float, float]:
    """Mean and the half width of its 95 % interval."""
    mean = float(value.mean())
    sums = np.bincount(np.unique(cluster, return_inverse=True)[1].reshape(-1), value - mean)
    if len(sums) < _CLUSTERS:
        return mean, np.nan
    correction = len(sums) / (len(sums) - 1.0)
    deviation = float(np.sqrt(correction * np.sum(sums**2)) / len(value))
    return mean, float(stdtrit(len(sums) - 1, 0.975)) * deviation


def explained(variable: Array, value: Array, cluster: Index, at: Array) -> tuple[float, float]:
    """Shares of the squares of `value` that a constant explains, and that bins of `variable` explain beyond it.

    Each half of the clusters is predicted by the means of the other half, so that noise explains nothing.
    """
    total = float(np.sum(value**2))
    odd = cluster % 2 == 1
    if not total > 0.0 or odd.all() or not odd.any():
        return 0.0, 0.0
    place = np.clip(np.digitize(variable, at) - 1, 0, len(at) - 2)
    constant = binned = 0.0
    for fit, test in ((odd, ~odd), (~odd, odd)):
        mean = float(value[fit].mean())
        size = np.bincount(place[fit], minlength=len(at) - 1)
        sums = np.bincount(place[fit], value[fit], minlength=len(at) - 1)
        level = np.where(size > 0, sums / np.maximum(size, 1), mean)
        constant += float(np.sum((value[test] - mean) ** 2))
        binned += float(np.sum((value[test] - level[place[test]]) ** 2))
    return max(1.0 - constant / total, 0.0), max((constant - binned) / total, 0.0)
