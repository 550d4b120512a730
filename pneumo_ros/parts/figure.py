"""A figure: value, the interval it really lies in, and where it comes from."""

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Figure:
    """A value in an SI unit; low and high: where the true value lies; source: in words; rule: its name, where a rule
    stands in for what nobody publishes.
    """

    value: float
    unit: str
    low: float
    high: float
    source: str
    rule: str = ""
    note: str = ""

    @property
    def deviation(self) -> float:
        """Root mean square distance from `value` of a number drawn evenly from the interval; 0 where it is exact."""
        up, down = self.high - self.value, self.value - self.low
        return math.sqrt((up**3 + down**3) / (3.0 * (up + down))) if up + down > 0.0 else 0.0

    @property
    def exact(self) -> bool:
        """Whether no interval is given."""
        return self.low == self.high

    def within(self, share: "Figure") -> "Figure":
        """This figure with the relative interval of `share`, a rule, where none is given."""
        if not self.exact:
            return self
        ends = sorted((self.value * share.low, self.value * share.high))
        return replace(self, low=ends[0], high=ends[1])


GIVEN = "given"


def given(value: float, unit: str) -> Figure:
    """A figure that the user gives."""
    return Figure(value, unit, value, value, GIVEN)
