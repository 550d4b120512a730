"""How surely a candidate's sizes differ from none."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.coordinates import Coordinate
from pneumo_ros.discover.hypothesis import BaseFit, cluster_robust, wald

Array = NDArray[np.float64]

DEGENERATE = 1e6  # no recording is that sure: what moves no residual has no scatter either, and the priors say how sure


def significance(base: BaseFit, own: Sequence[Coordinate], u: Array, A: Array, e: Array, ridge: Array) -> float:
    """t of the sizes at u (own,), shapes as they were found: without the effect there is no shape to be uncertain of.

    Free beside a small size, a shape that trades with it (a share of flow with its conductance) would hide the largest
    gain. A (residuals, base + own): weighted slopes; e: weighted residual; ridge: information of the priors.
    """
    p = len(base.names)
    sizes = [j for j, c in enumerate(own) if c.is_size]
    kept = [*range(p), *(p + j for j in sizes)]
    K = A[:, kept]
    bread = np.linalg.inv(K.T @ K + np.diag(ridge[kept]))
    away = np.array([distance(own[j], float(u[j])) for j in sizes])
    t = wald(away, cluster_robust(K, e, base.evidence.block, bread, ridge[kept])[p:, p:])
    return t if t < DEGENERATE else min(t, wald(away, bread[p:, p:]))


def distance(c: Coordinate, u: float) -> float:
    """How far from neutral, in u: of a fading one relative to its value, in what residuals are linear in."""
    if c.logarithmic:
        assert c.neutral is not None
        left = c.value(u) / c.neutral
        return 1.0 / left - 1.0 if c.share else 1.0 - left
    return u
