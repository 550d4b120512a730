"""Effects that the recordings could not have shown: nothing can be said about them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.hypothesis import Form, Hypothesis
from pneumo_ros.diagnose.score import MARGIN

Array = NDArray[np.float64]

LEAST = 1e-12  # of a variance, in usual sizes squared


def unseen(screened: Sequence[Hypothesis]) -> dict[str, float]:
    """By name, the nats that an effect of usual size would gain, for effects where these are fewer than asked.

    `screened`: every candidate fitted linearly in several shapes, each size to its usual one. Of an effect of several
    forms the machine may have the one that shows least, as a play before the sensor where the piston never turns.
    """
    best, least = dict[Form, float](), dict[str, float]()
    for h in screened:
        best[h.form] = max(best.get(h.form, -np.inf), _nats(h))
    for (name, _), nats in best.items():
        least[name] = min(least.get(name, np.inf), nats)
    return {name: nats for name, nats in least.items() if nats < MARGIN}


def _nats(h: Hypothesis) -> float:
    """Nats that the effect would gain if each of its sizes were a usual one, with whatever sign.

    With the information H about the sizes it gains tr(H) / 2 on average and costs ln det(1 + H) / 2: see `score`. What
    is uncertain of one point of a profile beside the others does not count. A line of the machine file that stands in
    for the effect is wrong, whatever its prior, at the price of one effect.
    """
    if not len(h.covariance):
        return 0.0
    known, shown = _information(h.covariance), _information(h.beside_lines)
    gained = 0.5 * min(float(np.trace(known)), float(np.trace(shown)) + 2.0 * h.wrong_lines)
    return gained - 0.5 * float(np.linalg.slogdet(np.eye(len(known)) + known)[1])


def _information(covariance: Array) -> Array:
    return np.asarray(np.linalg.inv(covariance + LEAST * np.eye(len(covariance))))
