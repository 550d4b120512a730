"""Significance of a candidate's sizes: t of their distance from neutral."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate
from pneumo_ros.diagnose.hypothesis import BaseFit, cluster_robust, wald

Array = NDArray[np.float64]

DEGENERATE = 1e6  # no recording gives so large a t: sizes that move no residual have no scatter, only their prior


def covariances(base: BaseFit, normal: Array, sums: Array, ridge: Array) -> tuple[Array, Array]:
    """Covariances of a candidate's coordinates beside the base parameters: cluster-robust, and by noise alone.

    normal (base + own, base + own): of weighted slopes; sums (blocks, base + own): `block_sums`; ridge: information of
    the priors.
    """
    p = len(base.names)
    bread = np.linalg.inv(normal + np.diag(ridge)).astype(np.float64)
    return cluster_robust(sums, bread, ridge)[p:, p:], bread[p:, p:]


def significance(own: Sequence[Coordinate], u: Array, robust: Array, plain: Array) -> float:
    """t of sizes at u (own,) by their covariances (own, own)."""
    away = np.array([distance(c, float(x)) for c, x in zip(own, u, strict=True)])
    t = wald(away, robust)
    return t if t < DEGENERATE else min(t, wald(away, plain))


def distance(c: Coordinate, u: float) -> float:
    """Distance from neutral in u; for a fading size relative to its value, in the variable residuals are linear in."""
    if c.logarithmic:
        assert c.neutral is not None
        left = c.value(u) / c.neutral
        return 1.0 / left - 1.0 if c.share else 1.0 - left
    return u
