"""An effect of the rig: a name, a range of sizes, and the fields of `Machine` that a size changes."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .machine import Machine

Rng = np.random.Generator
Fields = dict[str, Any]


def proportional(size: float, scale: float) -> float:
    """The size grows with the effect."""
    return size * scale


def inverse(size: float, scale: float) -> float:
    """The size falls as the effect grows: a natural frequency, a time to the wall."""
    return size / scale


def towards(absent: float) -> Callable[[float, float], float]:
    """The size approaches a value at which the effect is absent."""
    return lambda size, scale: absent - (absent - size) * scale


class Effect(NamedTuple):
    """One row of the table.

    `fields(machine, size, rng)` gives the changed fields; other choices (place, chamber) come from
    rng. `low` to `high` are sizes of full strength. `same_shape` is False where the equation is another than a
    catalogue's, and only the name can be compared. `equations` are those whose residual shows it.
    """

    unit: str
    low: float
    high: float
    equations: tuple[str, ...]
    fields: Callable[[Machine, float, Rng], Fields]
    same_shape: bool = True
    weaken: Callable[[float, float], float] = proportional
    signed: bool = False

    def apply(self, machine: Machine, size: float, rng: Rng | None = None) -> Machine:
        """The machine with the effect of that size in it."""
        return machine._replace(**self.fields(machine, size, rng or np.random.default_rng(0)))

    def draw(self, rng: Rng, scale: float = 1.0) -> float:
        """A size between low and high, of either sign if it has one, weakened to `scale` of that strength."""
        size = float(np.exp(rng.uniform(np.log(self.low), np.log(self.high))))
        sign = float(rng.choice([-1.0, 1.0])) if self.signed else 1.0
        return sign * self.weaken(size, scale)


def field(*names: str) -> Callable[[Machine, float, Rng], Fields]:
    """Fields that take the size itself."""
    return lambda machine, size, rng: dict.fromkeys(names, size)


def fixed(name: str, **others: float) -> Callable[[Machine, float, Rng], Fields]:
    """One field that takes the size, and others that come with it."""
    return lambda machine, size, rng: {name: size, **others}


def either(*names: str) -> Callable[[Machine, float, Rng], Fields]:
    """One of several fields takes the size."""
    return lambda machine, size, rng: {str(rng.choice(names)): size}
