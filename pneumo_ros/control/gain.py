"""A number of a control law that may be tuned: default, unit, meaning and range."""

from dataclasses import dataclass
from typing import overload

from pneumo_ros.errors import UsageError, brief


@dataclass(frozen=True)
class Gain:
    """Default value in `unit`, meaning, and the closed range of allowed values.

    Read from a class it is the Gain itself; read from an instance it is that instance's value, a float.
    """

    default: float
    unit: str
    meaning: str
    low: float
    high: float

    @overload
    def __get__(self, instance: None, owner: type) -> "Gain": ...
    @overload
    def __get__(self, instance: object, owner: type) -> float: ...
    def __get__(self, instance: object | None, owner: type) -> "Gain | float":
        # there is no __set__: a value stored in the instance hides this, which runs only before that
        return self if instance is None else self.default

    def check(self, name: str, value: object) -> float:
        """Return value as float; UsageError when it is no number, not finite, or out of range."""
        # compared before it is converted: an integer may be larger than any double
        if isinstance(value, int | float) and not isinstance(value, bool) and self.low <= value <= self.high:
            return float(value)
        raise UsageError(f"gain {name} is {brief(value)}; allowed is {self.low:g} to {self.high:g} {self.unit}")
