"""Effects that the recordings could not have shown: nothing can be said about them."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.score import MARGIN

LEAST = 1e-12  # of a variance, in usual sizes squared


def unseen(screened: Sequence[Hypothesis]) -> dict[str, float]:
    """By name, the nats that an effect of usual size would gain, for effects where these are fewer than asked.

    `screened`: every candidate fitted linearly in several shapes, each size to its usual one.
    """
    best: dict[str, float] = {}
    for h in screened:
        best[h.name] = max(best.get(h.name, -np.inf), _nats(h))
    return {name: nats for name, nats in best.items() if nats < MARGIN}


def _nats(h: Hypothesis) -> float:
    """Nats that the effect would gain if each of its sizes were a usual one, with whatever sign.

    With the information H about the sizes it gains tr(H) / 2 on average and costs ln det(1 + H) / 2: see `score`. What
    is uncertain of one point of a profile beside the others does not count.
    """
    if not len(h.covariance):
        return 0.0
    information = np.linalg.inv(h.covariance + LEAST * np.eye(len(h.covariance)))
    return 0.5 * float(np.trace(information) - np.linalg.slogdet(np.eye(len(information)) + information)[1])
