"""Confidence of least-squares estimates when errors within one run are correlated."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # Student's t, without the slow import of scipy.stats

Array = NDArray[np.float64]

_FEW_GROUPS = 6
_BLIND = 1e-10  # share of the largest eigenvalue: a direction with less counts as undetermined


def central_jacobian(function: Callable[[Array], Array], x: Array) -> Array:
    """Central differences (residuals, len(x)) with relative steps of 1e-5."""
    steps = 1e-5 * np.maximum(np.abs(x), 1e-3)
    return np.stack([(function(x + d) - function(x - d)) / (2.0 * d.sum()) for d in np.diag(steps)], axis=1)


def half_widths(residual: Array, jacobian: Array, weight: Array, groups: Sequence[str]) -> tuple[Array, Array]:
    """Half widths (p,) of 95 % intervals and the correlation (p, p) of a weighted least-squares estimate.

    residual (n,) is whitened, jacobian (n, p), weight (n,) the robust weights, groups (n,) the run of each residual,
    empty for a prior.
    Parameters that the residuals do not distinguish have infinite half widths and NaN correlations.
    The wider of two intervals: by independent errors of the residuals' own size (at least 1), and, from six runs on, by
    errors correlated within a run (jackknife over runs, Bell and McCaffrey 2002, with Student's t over the runs).
    """
    freedom = max(len(residual) - jacobian.shape[1], 1)
    variance = max(float(np.sum(weight * residual**2) / freedom), 1.0)
    normal = jacobian.T @ (weight[:, None] * jacobian)
    bread, seen = _inverse(normal, normal)
    half = stdtrit(freedom, 0.975) * np.sqrt(variance * np.diag(bread))
    robust, runs = _jackknife(jacobian, weight, residual, np.array(groups))
    if runs >= max(_FEW_GROUPS, jacobian.shape[1] + 2):
        half = np.maximum(half, stdtrit(runs - 1, 0.975) * robust)
    sigma = np.where(seen, np.sqrt(np.diag(bread)), np.nan)
    return np.where(seen, half, np.inf), bread / np.outer(sigma, sigma)


def _jackknife(jacobian: Array, weight: Array, residual: Array, labels: NDArray[np.str_]) -> tuple[Array, int]:
    """Deviations (p,) by leaving out one group after the other in the linearised problem, and the number of groups."""
    names = sorted(set(labels.tolist()) - {""})
    normal, shifts = jacobian.T @ (weight[:, None] * jacobian), []
    for name in names:
        own = labels == name
        part, gradient = weight[own, None] * jacobian[own], jacobian[own].T @ (weight * residual)[own]
        inverse, _ = _inverse(normal - jacobian[own].T @ part, normal)
        shifts.append(inverse @ gradient)
    count = len(names)
    return np.sqrt((count - 1.0) / max(count, 1) * np.sum(np.square(shifts), axis=0)), count


def _inverse(normal: Array, whole: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Inverse (p, p) in determined directions, and whether each parameter (p,) is determined by itself.

    `whole` is the normal matrix of all data, which gives the scale.
    """
    size = np.sqrt(np.diag(whole))
    size = np.where(size > 0.0, size, 1.0)
    value, vector = np.linalg.eigh(normal / np.outer(size, size))
    known = value > _BLIND * value[-1]
    seen = (np.abs(vector[:, ~known]) < 1e-3).all(axis=1)
    return (vector[:, known] / value[known]) @ vector[:, known].T / np.outer(size, size), seen
