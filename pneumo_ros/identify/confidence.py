"""Confidence of least-squares estimates when errors within one run belong together."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

Array = NDArray[np.float64]

_FEW_GROUPS = 6


def central_jacobian(function: Callable[[Array], Array], x: Array) -> Array:
    """Central differences (residuals, len(x)) with relative steps of 1e-5."""
    steps = 1e-5 * np.maximum(np.abs(x), 1e-3)
    return np.stack([(function(x + d) - function(x - d)) / (2.0 * d.sum()) for d in np.diag(steps)], axis=1)


def half_widths(residual: Array, jacobian: Array, weight: Array, groups: Sequence[str]) -> tuple[Array, Array]:
    """Half widths (p,) of 95 % intervals and the correlation (p, p) of a weighted least-squares estimate.

    residual (n,) is whitened, jacobian (n, p), weight (n,) the robust weights, groups (n,) the run of each residual.
    The wider of two: independent errors of the residuals' own size (at least 1), and errors that are alike within a
    run (cluster-robust sandwich, Liang and Zeger 1986, with Student's t over the runs), from six runs on.
    """
    freedom = max(len(residual) - jacobian.shape[1], 1)
    variance = max(float(np.sum(weight * residual**2) / freedom), 1.0)
    bread = np.linalg.pinv(jacobian.T @ (weight[:, None] * jacobian))
    half = student.ppf(0.975, freedom) * np.sqrt(variance * np.diag(bread))
    names = sorted(set(groups))
    if len(names) >= max(_FEW_GROUPS, jacobian.shape[1] + 2):
        labels = np.array(groups)
        scores = np.stack([jacobian[labels == g].T @ (weight * residual)[labels == g] for g in names])
        meat = scores.T @ scores * (len(names) / (len(names) - 1.0))
        robust = np.sqrt(np.diag(bread @ meat @ bread))
        half = np.maximum(half, student.ppf(0.975, len(names) - jacobian.shape[1]) * robust)
    sigma = np.sqrt(np.diag(bread))
    return half, bread / np.outer(sigma, sigma)
