"""Valve voltages of one trial as functions of the time since its valve opened."""

import math
from dataclasses import dataclass
from typing import Any

from pneumo_ros.errors import UsageError, brief


@dataclass(frozen=True)
class Constant:
    """`volts` [V], held as long as the trial lasts."""

    volts: float

    def at(self, time: float) -> float:
        """Voltage [V]; the same at every time."""
        return self.volts

    @property
    def largest(self) -> float:
        """Largest magnitude [V]."""
        return abs(self.volts)

    @property
    def text(self) -> str:
        """What it is, for a person."""
        return f"{self.volts:+.3f} V"


@dataclass(frozen=True)
class Steps:
    """One level after the other: pairs of duration [s] and voltage [V]."""

    levels: tuple[tuple[float, float], ...]

    def at(self, time: float) -> float:
        """Voltage [V] at `time` [s] since the start; the last level remains."""
        for seconds, volts in self.levels:
            time -= seconds
            if time < 0.0:
                return volts
        return self.levels[-1][1]

    @property
    def largest(self) -> float:
        """Largest magnitude [V]."""
        return max(abs(volts) for _, volts in self.levels)

    @property
    def text(self) -> str:
        """What it is, for a person."""
        return f"{len(self.levels)} levels within {self.largest:.2f} V"


@dataclass(frozen=True)
class Sweep:
    """A cosine of `amplitude` [V] whose frequency goes linearly from `first` to `last` [Hz] in `seconds`.

    A cosine, so that the piston oscillates about its start.
    """

    amplitude: float
    first: float
    last: float
    seconds: float

    def at(self, time: float) -> float:
        """Voltage [V] at `time` [s] since the start."""
        cycles = self.first * time + 0.5 * (self.last - self.first) / self.seconds * time * time
        return self.amplitude * math.cos(2.0 * math.pi * cycles)

    @property
    def largest(self) -> float:
        """Largest magnitude [V]."""
        return abs(self.amplitude)

    @property
    def text(self) -> str:
        """What it is, for a person."""
        return f"cosine of {self.amplitude:.2f} V, {self.first:.2g} to {self.last:.2g} Hz"


@dataclass(frozen=True)
class Ramps:
    """Rises in `seconds` from 0 to `volts` [V] until the piston has moved by `way` [m], then the other way, in turn.

    After the first two, the way is twice as long. The conductor turns it round; here, nothing has moved.
    """

    volts: float
    way: float
    seconds: float

    def at(self, time: float) -> float:
        """Magnitude [V] at `time` [s] since this ramp began."""
        return self.volts * min(max(time, 0.0) / self.seconds, 1.0)

    @property
    def largest(self) -> float:
        """Largest magnitude [V]."""
        return abs(self.volts)

    @property
    def text(self) -> str:
        """What it is, for a person."""
        return f"ramps up to {self.volts:.2f} V until {1e3 * self.way:.0f} mm, to and fro"


Voltage = Constant | Steps | Sweep | Ramps
FORMS = (
    "constant: V, steps: [[seconds, V], ...], sweep: {amplitude: V, first: Hz, last: Hz, seconds: s} or "
    "ramps: {volts: V, way: m, seconds: s}"
)


def as_dict(voltage: Voltage) -> dict[str, Any]:
    """One entry, kind -> numbers, as in programme files."""
    if isinstance(voltage, Constant):
        return {"constant": voltage.volts}
    if isinstance(voltage, Steps):
        return {"steps": [list(level) for level in voltage.levels]}
    if isinstance(voltage, Ramps):
        return {"ramps": {k: getattr(voltage, k) for k in ("volts", "way", "seconds")}}
    return {"sweep": {k: getattr(voltage, k) for k in ("amplitude", "first", "last", "seconds")}}


def from_dict(given: dict[str, Any]) -> Voltage:
    """The voltage that the entries `constant`, `steps`, `sweep` or `ramps` describe.

    Raises UsageError unless it is exactly one of them, with finite numbers.
    """
    kinds = [kind for kind in ("constant", "steps", "sweep", "ramps") if kind in given]
    try:
        if kinds == ["constant"]:
            return _checked(Constant(float(given["constant"])))
        if kinds == ["steps"]:
            return _checked(Steps(tuple((float(seconds), float(volts)) for seconds, volts in given["steps"])))
        if kinds == ["sweep"]:
            return _checked(Sweep(**{key: float(value) for key, value in given["sweep"].items()}))
        if kinds == ["ramps"]:
            return _checked(Ramps(**{key: float(value) for key, value in given["ramps"].items()}))
    except (TypeError, ValueError, AttributeError, OverflowError) as error:
        raise UsageError(f"{kinds[0]} is {brief(given[kinds[0]])}; a trial takes {FORMS}") from error
    raise UsageError(f"a trial takes one of {FORMS}; given: {', '.join(kinds) or 'none of them'}")


def _checked(voltage: Voltage) -> Voltage:
    """ValueError unless all numbers are finite and all durations positive."""
    numbers, lengths = [voltage.largest] if not isinstance(voltage, Steps) else [], [1.0]
    if isinstance(voltage, Steps):  # their maximum could hide a NaN
        numbers = [volts for _, volts in voltage.levels]
        lengths = [seconds for seconds, _ in voltage.levels]
    elif isinstance(voltage, Sweep):
        lengths = [voltage.seconds]
        numbers += [voltage.first, voltage.last]
    elif isinstance(voltage, Ramps):
        lengths = [voltage.seconds, voltage.way]
    if not all(map(math.isfinite, (*numbers, *lengths))) or min(lengths, default=0.0) <= 0.0:
        raise ValueError
    return voltage
