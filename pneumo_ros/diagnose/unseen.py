"""Effects that the recordings could not have shown: nothing can be said about them."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.diagnose.candidate import MARGIN
from pneumo_ros.diagnose.hypothesis import Hypothesis


def unseen(screened: Sequence[Hypothesis]) -> dict[str, float]:
    """By name, the nats that an effect of usual size would gain, for effects where these are fewer than asked.

    `screened`: every candidate fitted linearly in several shapes, each size to its usual one. A size known with a
    deviation of s usual sizes gains 1 / (2 s^2) nats and costs ln(1 + 1 / s^2) / 2: see `score`.
    """
    best: dict[str, float] = {}
    for h in screened:
        variance = np.diag(h.covariance) if len(h.covariance) else np.full(1, np.inf)
        information = float(np.max(1.0 / np.maximum(variance, 1e-12), initial=0.0))
        best[h.name] = max(best.get(h.name, -np.inf), 0.5 * (information - np.log1p(information)))
    return {name: nats for name, nats in best.items() if nats < MARGIN}
