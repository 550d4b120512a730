"""The rounds and the outcome of a search."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.plant import Model


@dataclass(frozen=True)
class Step:
    """One round: the model it started with, its candidates, best first, and the added one.

    `added` is None in the last round, and where the effect was removed later.
    """

    model: Model
    candidates: tuple[Candidate, ...]
    added: Candidate | None
    rivals: tuple[Candidate, ...]
    before: dict[str, float]  # scale over noise by family on held-out runs
    after: dict[str, float]
    unseen: dict[str, float] = field(default_factory=dict)  # effects these recordings cannot show: nats at usual size
    joint: bool = False  # whether predictions are judged with the effect of the next round, too

    @property
    def undecided(self) -> dict[str, Candidate]:
        """Effects that these recordings speak for, but not enough, by name."""
        return {c.name: c for c in reversed(self.candidates) if c.undecided}


def without(step: Step, gone: Sequence[str], why: str) -> Step:
    """The round with the candidates `gone` refused afterwards, for the reason `why`."""
    candidates = tuple(replace(t, refused=why) if t.name in gone else t for t in step.candidates)
    return replace(step, candidates=candidates, added=None if step.added and step.added.name in gone else step.added)


@dataclass(frozen=True)
class Found:
    """The outcome: refitted base, final model, the rounds that led there."""

    base: Model
    model: Model
    steps: tuple[Step, ...]
    interrupted: bool = False
    deadline: bool = False  # whether the search ended because its time was over
