"""The evidence for and against a candidate: every condition that must hold before an effect is added."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate, is_profile
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.measures import equation_helped

Array = NDArray[np.float64]

T_LEAST = 5.0
GAIN_LEAST = 0.05  # of the mean square of an equation's residual on held-out runs
Z_LEAST = 2.0  # of that gain over its scatter between blocks of time
SHARE_LEAST = (0.25, 0.5)  # of an equation's misfit beyond noise, which the first and later effects must remove
SPOILED = 0.5  # of its best gain: limit on the loss of another equation, whose parameters may still be biased
REST_LEAST = 0.025  # of the original misfit: a smaller rest comes from an added effect's inexact law
NEARLY = 0.95  # of the misfit beyond noise: an effect that only corrects another's law does not explain so much
RELIEF, T_PRIOR = 4.5, 3.0  # log likelihood, and deviations, by which priors alone support an effect
MATERIAL = 0.05  # of the usual size: a fifth of it, in a shape that shows a quarter of that, still counts
MOST_REMOVED = 0.6  # of an equation's mean square, noise included, on held-out runs
PLAIN = 0.8  # of the misfit beyond noise: an effect that removes so much on held-out runs counts whatever its t
SLOWEST_USUAL = 10.0  # usual time constants
MECHANICS = ("momentum", "breakaway")  # equations that show a texture of friction


@dataclass(frozen=True)
class Candidate:
    """One candidate: its fit, and its measures on held-out runs."""

    hypothesis: Hypothesis
    held: Array = field(repr=False)  # residual on held-out runs
    gain: dict[str, float]  # by equation: share of the mean square residual on held-out runs that it removes
    z: float  # of the loss it removes there, over its scatter between blocks
    size: float  # in usual sizes
    stable: bool
    share: float  # of the misfit beyond noise that it removes where it acts, in its best equation, on held-out runs
    first: bool  # whether nothing was added before
    decoy: float  # the largest t of copies of its trace shifted in time
    score: float  # log likelihood over the base, training and held-out runs together
    usual: dict[str, float] = field(default_factory=dict)  # as `gain`, without outliers
    local: float = -np.inf  # the largest gain of an equation where the effect acts in it
    force: float = np.inf  # root mean square of its change of the momentum equation, over TEXTURE of the drive force
    rest: float = 1.0  # misfit beyond noise in the equation it helps most, over that of the refitted base
    lag: float = np.inf  # samples, of an effect that delays
    quiet: bool = True  # whether no significant force is unexplained, which would strain base parameters, too
    refused: str = ""  # why it was removed after it had been added
    std: dict[str, float] = field(default_factory=dict)  # of its parameters, where the equations do not determine them
    elsewhere: frozenset[str] = frozenset()  # equations that it does not enter

    @property
    def name(self) -> str:
        """Catalogue name."""
        return self.hypothesis.name

    @property
    def clear(self) -> bool:
        """Whether it explains most of an equation's misfit beyond noise, or removes most of its mean square."""
        return self.share >= PLAIN or max(self.gain.values(), default=0.0) >= MOST_REMOVED

    @property
    def slowness(self) -> float:
        """Its largest time constant in usual ones: unlike forces, times do not grow with a machine."""
        h = self.hypothesis
        times = [c for c in h.coordinates if c.is_size and c.name.endswith("time_constant")]
        return max((h.values[c.name] / c.typical for c in times), default=0.0)

    @property
    def absorbed(self) -> bool:
        """Whether base parameters replace it: the data do not decide, but the priors of those parameters do."""
        h = self.hypothesis
        indifferent = all(gain > -GAIN_LEAST for gain in self.gain.values())
        return self.quiet and indifferent and h.relief > RELIEF and h.t > T_PRIOR and self.score > RELIEF

    def _data_objections(self) -> list[str]:
        """Objections from the recordings."""
        h, found, most = self.hypothesis, list[str](), max(self.local, *self.gain.values())
        if h.t < T_LEAST:
            found.append(f"its t is {h.t:.1f}, below {T_LEAST:g}")
        elif h.t < 1.5 * self.decoy and self.share < PLAIN:
            found.append(f"its t is {h.t:.1f}, and copies of it shifted in time reach {self.decoy:.1f}")
        if most < GAIN_LEAST:
            found.append(f"removes only {100.0 * most:.1f} % of the misfit of held-out runs")
        elif self.z < Z_LEAST:
            found.append("its improvement on held-out runs is within their scatter")
        # an effect that explains an equation does no harm in others: base parameters biased by its absence do
        spared = self.elsewhere if self.share >= PLAIN else frozenset()
        change = {n: max(gain, self.usual.get(n, gain)) for n, gain in self.gain.items() if n not in spared}
        loss, worst = min(((change[n], n) for n in change), default=(0.0, ""))
        if loss < -SPOILED * max(most, GAIN_LEAST):
            found.append(f"makes the misfit of {worst} {-100.0 * loss:.0f} % larger on held-out runs")
        alone = self.first and (self.force > 1.0 or equation_helped(self.gain) not in MECHANICS)
        # a profile of many sizes can follow any small repeatable force
        texture = self.force <= 1.0 and is_profile(h.coordinates)
        if self.share < (PLAIN if texture else SHARE_LEAST[0 if alone else 1]):
            found.append(f"removes only {100.0 * self.share:.0f} % of the misfit beyond noise")
        return found

    def _shape_objections(self) -> list[str]:
        """The objection that it only corrects the law of an added effect, where the data decide about it."""
        says = not self.absorbed or max(self.gain.values(), default=0.0) >= GAIN_LEAST
        if says and self.rest < REST_LEAST and self.share < NEARLY:
            left = f"only {100.0 * self.rest:.1f} % of the original misfit is left here"
            return [f"{left}; more likely an inexact law of an added effect than a new one"]
        return []

    @property
    def objections(self) -> tuple[str, ...]:
        """Why it may not be added; empty when it may."""
        h, found = self.hypothesis, self._shape_objections() + ([] if self.absorbed else self._data_objections())
        if self.size < MATERIAL:
            found.append(f"its size is only {self.size:.2g} times the usual one")
        if self.slowness > SLOWEST_USUAL:
            found.append(f"its time constant is {self.slowness:.0f} times the usual one")
        ends = [c.name for c, u in zip(h.coordinates, h.u, strict=True) if _at_end(c, float(u))]
        if ends:
            found.append(f"{ends[0]} is at the end of its allowed range")
        if self.lag < 1.0:
            found.append("its delay is shorter than a sample, which may be the timing of the recording")
        if self.refused:
            found.append(self.refused)
        if not self.stable:
            found.append("its size changes too much when one run is left out")
        return tuple(found)


def _at_end(c: Coordinate, u: float) -> bool:
    """Whether a parameter is at a bound that is neither neutral nor usual: it may replace another effect."""
    value, margin = c.value(u), 1e-3 * abs(c.typical)
    near = [end for end in (c.low, c.high) if abs(value - end) <= margin]
    return bool(near) and near[0] not in (c.neutral, c.typical)
