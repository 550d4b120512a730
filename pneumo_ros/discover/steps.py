"""What a search did: its rounds and its outcome."""

from dataclasses import dataclass

from pneumo_ros.discover.trial import Trial
from pneumo_ros.plant import Model


@dataclass(frozen=True)
class Step:
    """One round: the model it began with, all trials best first, and what was added (None in the last round)."""

    model: Model
    trials: tuple[Trial, ...]
    added: Trial | None
    rivals: tuple[Trial, ...]
    before: dict[str, float]  # scale over noise by family on held-out runs
    after: dict[str, float]


@dataclass(frozen=True)
class Found:
    """The outcome: refitted base, final model, the rounds that led there."""

    base: Model
    model: Model
    steps: tuple[Step, ...]
    interrupted: bool = False
