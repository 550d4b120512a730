"""Effects that recordings do not distinguish, and the simpler one of two that explain the same."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import MATERIAL, T_LEAST, Candidate
from pneumo_ros.diagnose.hypothesis import BaseFit
from pneumo_ros.diagnose.measures import pooled_advantage

Array = NDArray[np.float64]

ALIKE = 0.9  # of the best score: a candidate with less explains less, and is no rival
TIED = 2.5  # deviations by which a rival must be worse to be distinguished
SAME = 0.5  # least cosine between the changes that two rivals make; below, they are different effects


def rivals(base: BaseFit, held: BaseFit, best: Candidate, others: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that all runs together do not distinguish from the best one."""
    found = []
    for other in others:
        if other.name == best.name or other.hypothesis.t < T_LEAST or other.size < MATERIAL:
            continue
        if other.score < ALIKE * best.score or best.name in _contained(base, other):
            continue
        if _likeness(held.residual - best.held, held.residual - other.held) < SAME:
            continue
        if _tied(base, held, best, other):
            found.append(other)
    return found


def _likeness(one: Array, other: Array) -> float:
    """Cosine of the angle between the changes of two effects."""
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(one @ other) / size if size else 0.0


def simplest(base: BaseFit, held: BaseFit, good: Sequence[Candidate]) -> Candidate | None:
    """The first of `good`, or a simpler effect that it contains if the runs do not need more; None if there is none.

    The runs need more when they distinguish the two effects, and the difference is significant.
    """
    for other in good[1:]:
        little = _between(held, good[0], other) < MATERIAL
        if other.name in _contained(base, good[0]) and (little or _tied(base, held, good[0], other)):
            return other
    return good[0] if good else None


def _between(held: BaseFit, best: Candidate, other: Candidate) -> float:
    """Norm of the difference between the changes of two effects, over that of the best one's change."""
    whole = float(np.linalg.norm(held.residual - best.held))
    return float(np.linalg.norm(other.held - best.held)) / whole if whole else 0.0


def _contained(base: BaseFit, candidate: Candidate) -> tuple[str, ...]:
    return base.model.library.find(candidate.name).contains


def _tied(base: BaseFit, held: BaseFit, best: Candidate, other: Candidate) -> bool:
    pairs = [
        (base.evidence, other.hypothesis.residual, best.hypothesis.residual),
        (held.evidence, other.held, best.held),
    ]
    return pooled_advantage(pairs) < TIED
