"""How surely a candidate's sizes differ from none."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate
from pneumo_ros.diagnose.hypothesis import BaseFit, cluster_robust, wald

Array = NDArray[np.float64]

DEGENERATE = 1e6  # no recording is that sure: what moves no residual has no scatter either, and the priors say how sure


def covariances(base: BaseFit, A: Array, e: Array, ridge: Array) -> tuple[Array, Array]:
    """Of the candidate's columns of A, which come after the base parameters': cluster-robust, and by the noise alone.

    A (residuals, base + own): weighted slopes; e: weighted residual; ridge: information of the priors.
    """
    p = len(base.names)
    bread = np.linalg.inv(A.T @ A + np.diag(ridge))
    return cluster_robust(A, e, base.evidence.block, bread, ridge)[p:, p:], bread[p:, p:]


def significance(own: Sequence[Coordinate], u: Array, robust: Array, plain: Array) -> float:
    """t of sizes at u (own,) by their covariances (own, own)."""
    away = np.array([distance(c, float(x)) for c, x in zip(own, u, strict=True)])
    t = wald(away, robust)
    return t if t < DEGENERATE else min(t, wald(away, plain))


def distance(c: Coordinate, u: float) -> float:
    """How far from neutral, in u: of a fading one relative to its value, in what residuals are linear in."""
    if c.logarithmic:
        assert c.neutral is not None
        left = c.value(u) / c.neutral
        return 1.0 / left - 1.0 if c.share else 1.0 - left
    return u
