"""Effects that recordings do not distinguish, and the simpler one of two that explain the same."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.candidate import MATERIAL, Candidate
from pneumo_ros.diagnose.hypothesis import BaseFit
from pneumo_ros.diagnose.score import MARGIN

Array = NDArray[np.float64]

SAME = 0.5  # least cosine between the changes that two rivals make; below, they are different effects


def rivals(base: BaseFit, held: BaseFit, best: Candidate, others: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that all runs together do not distinguish from the best one: their scores are within the margin."""
    found = []
    for other in others:
        if other.name == best.name or other.size < MATERIAL or best.name in _contained(base, other):
            continue
        same = _likeness(held.residual - best.held, held.residual - other.held) >= SAME
        if same and other.score.nats >= MARGIN and _tied(best, other):
            found.append(other)
    return found


def twins(held: BaseFit, candidates: Sequence[Candidate]) -> list[Candidate]:
    """The best candidate to which nothing is objected, and others of that kind that change the same."""
    fair = [one for one in candidates if not one.objections]
    return [one for one in fair if one is fair[0] or _between(held, fair[0], one) < MATERIAL]


def _tied(best: Candidate, other: Candidate) -> bool:
    return best.score.nats - other.score.nats < MARGIN


def _likeness(one: Array, other: Array) -> float:
    """Cosine of the angle between the changes of two effects."""
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(one @ other) / size if size else 0.0


def simplest(base: BaseFit, held: BaseFit, candidates: Sequence[Candidate]) -> Candidate | None:
    """The first candidate without objections, or a simpler effect that it contains if the runs do not need more.

    None if there is none. The runs need more when they distinguish the two effects, and the difference is significant.
    That the simpler one removes too little for itself is then no objection: the other one hardly removes more.
    """
    best = next((one for one in candidates if not one.objections), None)
    if best is None:
        return None
    simpler = [one for one in candidates if one.name in _contained(base, best)]
    for other in (replace(one, contained=True) if one.partial else one for one in simpler):
        if not other.objections and (_tied(best, other) or _between(held, best, other) < MATERIAL):
            return other
    return best


def _between(held: BaseFit, best: Candidate, other: Candidate) -> float:
    """Norm of the difference between the changes of two effects, over that of the best one's change."""
    whole = float(np.linalg.norm(held.residual - best.held))
    return float(np.linalg.norm(other.held - best.held)) / whole if whole else 0.0


def _contained(base: BaseFit, candidate: Candidate) -> tuple[str, ...]:
    return base.model.library.find(candidate.name).contains
