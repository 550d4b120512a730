"""An axis of a drawing: values to places, and round numbers along it."""

import math
from dataclasses import dataclass

_MOST = 6  # numbers along an axis
_STEPS = (1.0, 2.0, 5.0)
_DECADES = 2.8  # of a logarithmic axis: over more, numbers at the decades alone


@dataclass(frozen=True)
class Scale:
    """Values from `low` to `high` at places from `start` to `end`, linear or logarithmic; values beyond end there."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def __call__(self, value: float) -> float:
        """The place of a value."""
        if self.log:
            share = math.log(max(value, 1e-300) / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.start + min(max(share, 0.0), 1.0) * (self.end - self.start)


def ticks(low: float, high: float, log: bool = False) -> list[float]:
    """At most about six round numbers from `low` to `high`; on a logarithmic axis 1, 2 and 5 of the decades."""
    if log:
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        steps = _STEPS if math.log10(high / low) <= _DECADES else _STEPS[:1]
        return [step * 10.0**k for k in decades for step in steps if low <= step * 10.0**k <= high]
    rough = (high - low) / _MOST
    power = 10.0 ** math.floor(math.log10(rough))
    step = next((s * power for s in (*_STEPS, 10.0) if s * power >= rough), 10.0 * power)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [k * step for k in range(first, last + 1)]
