"""The evidence for and against a candidate: what must hold before an effect is added."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.score import MARGIN, Score

Array = NDArray[np.float64]

MATERIAL = 0.05  # of the usual size: a smaller effect does not matter
SHARE_LEAST = (0.25, 0.5)  # of an equation's misfit beyond noise, which the first and later effects must remove


RESOLVED = 1.0  # samples: a shorter delay, or half a period, is not seen at the rate of the recording


@dataclass(frozen=True)
class Candidate:
    """One candidate: its fit, and its measures on held-out runs."""

    hypothesis: Hypothesis
    held: Array = field(repr=False)  # residual on held-out runs
    gain: dict[str, float]  # by equation: share of the mean square residual on held-out runs that it removes
    size: float  # in usual sizes
    share: float  # of the misfit beyond noise that it removes: where it acts, in its best equation, on held-out runs;
    # or of the improbability of the model's own parameters
    first: bool  # whether nothing was added before
    score: Score  # nats that it gains over the model without it
    known: float = 0.0  # nats of them by which it agrees better with what was known of the model's parameters
    pays: float = 0.0  # the same of predictions of held-out runs, where that was asked
    contained: bool = False  # whether an effect that contains it removes enough, and is hardly better
    lag: float = np.inf  # samples, of an effect that delays
    swing: float = np.inf  # samples in half a period, of an effect that oscillates
    refused: str = ""  # why it may not be added whatever its score
    std: dict[str, float] = field(default_factory=dict)  # of its parameters, where the equations do not determine them

    @property
    def name(self) -> str:
        """Catalogue name."""
        return self.hypothesis.name

    @property
    def least(self) -> float:
        """Share of the misfit beyond noise, or of predictions' mean square error beyond it, that it must remove."""
        return SHARE_LEAST[0 if self.first else 1]

    @property
    def partial(self) -> bool:
        """Whether it removes too little of what is left to be more than something that resembles it."""
        return max(self.share, self.pays) < self.least and not self.contained

    @property
    def undecided(self) -> bool:
        """Whether the recordings speak for it, but not enough, or it removes too little, and nothing else is objected.

        What is left may be something else, which neither shows nor excludes it. Held-out recordings are against it if
        they lose more than all recordings together gain.
        """
        some = max(0.0, -self.score.held) < self.score.nats and bool(self.objections)
        return some and not replace(self, score=Score(MARGIN, MARGIN), share=1.0).objections

    @property
    def objections(self) -> tuple[str, ...]:
        """Why it may not be added; empty when it may."""
        found = list[str]()
        if self.score.nats < MARGIN:
            gained = min(round(self.score.nats), int(MARGIN) - 1)  # 7.9 is not 8
            found.append(f"all recordings together gain {gained} nats with it, and {MARGIN:g} are asked")
        elif self.score.held <= (0.0 if self.known < MARGIN else -MARGIN):
            found.append(f"held-out recordings lose {-self.score.held:.1f} nats with it")
        if self.size < MATERIAL and self.pays < self.least:
            found.append(f"its size is only {self.size:.2g} times the usual one")
        if self.partial:
            asked = f", and {removes(self.pays)} of the error of predictions" if self.pays else ""
            found.append(f"{removes(self.share)} of the misfit beyond noise{asked}")
        if self.lag < RESOLVED:
            found.append("its delay is shorter than a sample, which may be the timing of the recording")
        if self.swing < RESOLVED:
            found.append("it oscillates within two samples, which no recording at this rate shows")
        if self.refused:
            found.append(self.refused)
        return tuple(found)


def removes(share: float) -> str:
    """What is objected to an effect that removes this share of a misfit; where it rises, nothing is removed."""
    percent = round(100.0 * share)
    return f"removes only {percent} %" if percent > 0 else "removes nothing"
