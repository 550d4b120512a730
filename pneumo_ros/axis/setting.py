"""A node's parameter as data: default, unit, range and meaning."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

Value = bool | int | float | str | Sequence[str] | Sequence[float]
_SPAN = 1000.0  # an open end of a range lies this many times the default away


@dataclass(frozen=True)
class Setting:
    """One parameter. The type of `default` is its type; `low` and `high` are closed limits of a number in `unit`.

    A parameter that is not `live` is fixed at the start. `choices` lists the values a text may take.
    """

    name: str
    default: Value
    meaning: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    live: bool = True
    choices: tuple[str, ...] = ()

    def coerce(self, value: Any) -> Any:
        """`value` as this parameter's type: whole numbers become real ones where needed, in lists too.

        Raises UsageError, naming what is allowed, for another type, a number out of range or not finite, or a text
        that is no choice.
        """
        kind: type = type(self.default)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if kind is str and self.unit and isinstance(value, int | float) and not isinstance(value, bool):
            value = f"{value:g}"  # a quantity as text takes a plain number, too
        if isinstance(self.default, list | tuple):
            return self._coerce_list(value)
        if not _has_type(value, kind):
            raise UsageError(f"{self.name} is {value!r}; it takes {_KINDS[kind]}{self._allowed()}")
        if kind in (int, float) and not self.low <= value <= self.high:  # false for NaN, too
            raise UsageError(f"{self.name} is {value!r}{self._unit()}; allowed is {self._range()}")
        if self.choices and value not in self.choices:
            raise UsageError(unknown_name(self.name, value, self.choices))
        return value

    def _coerce_list(self, value: Any) -> list[Any]:
        if isinstance(value, bytes | str) or not hasattr(value, "__iter__"):
            raise UsageError(f"{self.name} is {value!r}; it takes a list, for example {self.default!r}")
        usual = list(self.default) if isinstance(self.default, list | tuple) else []
        item = usual[0] if usual else ""
        one = Setting(self.name, item, self.meaning, self.unit, self.low, self.high)
        return [one.coerce(entry) for entry in value]

    def finite_range(self, value: float) -> tuple[float, float]:
        """The range with its open ends at 1000 times the larger of default and `value`."""
        assert isinstance(self.default, float)
        span = _SPAN * (max(abs(self.default), abs(value)) or 1000.0)
        low = self.low if math.isfinite(self.low) else -span
        high = self.high if math.isfinite(self.high) else span
        return low, high

    @property
    def described(self) -> str:
        """Meaning and unit."""
        return self.meaning + self._unit()

    def _unit(self) -> str:
        return f" [{self.unit}]" if self.unit else ""

    def _range(self) -> str:
        if math.isinf(self.low) and math.isinf(self.high):
            return "any finite number"
        if math.isinf(self.high):
            return f"{self.low:g} or more"
        return f"{self.low:g} to {self.high:g}" if math.isfinite(self.low) else f"{self.high:g} or less"

    def _allowed(self) -> str:
        return f", {self._range()}" if type(self.default) in (int, float) else ""


_KINDS = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}


def _has_type(value: Any, kind: type) -> bool:
    """Whether it is of exactly this type: a bool is no whole number here."""
    return type(value) is kind
