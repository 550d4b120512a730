"""Numbers with a dimension, so that an effect's unchanged equations can be run and checked.

A value of exactly zero fits any dimension: `max(x, 0.0)` and `opening = 0.0` mean what they should.
"""

import math
import re
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, SimpleNamespace
from typing import Any

from pneumo_ros.plant import maths


class DimensionError(Exception):
    """Quantities of different dimensions were added, compared, or given to a function of pure numbers."""


class Quantity:
    """A value in SI units and the exponents of its base units."""

    def __init__(self, value: float, **base: float) -> None:
        self.value, self.base = value, {key: e for key, e in base.items() if abs(e) > 1e-9}

    def __repr__(self) -> str:
        return f"{self.value:g} [{' '.join(f'{key}^{e:g}' for key, e in sorted(self.base.items())) or '1'}]"

    def fits(self, other: "Quantity") -> bool:
        """Whether both have one dimension, or one is zero."""
        return self.base == other.base or 0.0 in (self.value, other.value)

    def _with(self, other: Any) -> "Quantity":
        other = quantity(other)
        if not self.fits(other):
            raise DimensionError(f"{self} does not go with {other}")
        return other

    def __add__(self, other: Any) -> "Quantity":
        other = self._with(other)
        return Quantity(self.value + other.value, **(self if self.value else other).base)

    def __mul__(self, other: Any) -> "Quantity":
        other = quantity(other)
        base = {key: self.base.get(key, 0) + other.base.get(key, 0) for key in {*self.base, *other.base}}
        return Quantity(self.value * other.value, **base)

    def __pow__(self, exponent: float) -> "Quantity":
        return Quantity(self.value**exponent, **{key: e * exponent for key, e in self.base.items()})

    def __neg__(self) -> "Quantity":
        return Quantity(-self.value, **self.base)

    def __abs__(self) -> "Quantity":
        return Quantity(abs(self.value), **self.base)

    def __sub__(self, other: Any) -> "Quantity":
        return self + -quantity(other)

    def __rsub__(self, other: Any) -> "Quantity":
        return quantity(other) - self

    def __truediv__(self, other: Any) -> "Quantity":
        return self * quantity(other) ** -1.0

    def __rtruediv__(self, other: Any) -> "Quantity":
        return quantity(other) / self

    __radd__, __rmul__ = __add__, __mul__

    def __lt__(self, other: Any) -> bool:
        return self.value < self._with(other).value

    def __le__(self, other: Any) -> bool:
        return self.value <= self._with(other).value

    def __gt__(self, other: Any) -> bool:
        return self.value > self._with(other).value

    def __ge__(self, other: Any) -> bool:
        return self.value >= self._with(other).value


def quantity(value: Any) -> Quantity:
    """A plain number as a pure number."""
    return value if isinstance(value, Quantity) else Quantity(float(value))


_UNITS = {
    "kg": Quantity(1.0, kg=1), "m": Quantity(1.0, m=1), "s": Quantity(1.0, s=1), "K": Quantity(1.0, K=1),
    "V": Quantity(1.0, V=1), "N": Quantity(1.0, kg=1, m=1, s=-2), "Pa": Quantity(1.0, kg=1, m=-1, s=-2),
    "J": Quantity(1.0, kg=1, m=2, s=-2), "W": Quantity(1.0, kg=1, m=2, s=-3), "Hz": Quantity(1.0, s=-1),
    "rad": Quantity(1.0), "sqrt": lambda q: q**0.5,
}  # fmt: skip


def unit(text: str) -> Quantity:
    """The unit of a text such as 'kg/(s*sqrt(Pa))' or 'N s2/m2'; ValueError when it is not a unit."""
    powers = re.sub(r"\b([A-Za-z]+)(\d+)\b", r"\1**\2", text)
    products = re.sub(r"(?<=[\w)])\s+(?=[\w(])", "*", powers)
    try:
        return quantity(eval(products, {"__builtins__": {}}, _UNITS))
    except Exception as error:
        raise ValueError(f"{text!r} is no unit") from error


def _pure(function: Callable[..., float]) -> Callable[..., Quantity]:
    def checked(*arguments: Any) -> Quantity:
        for argument in map(quantity, arguments):
            if argument.base and argument.value:
                raise DimensionError(f"{function.__name__} of {argument}")
        return Quantity(function(*(quantity(a).value for a in arguments)))

    return checked


_NUMBERS = ("exp", "log", "sin", "cos", "atan", "tanh", "power", "relaxation", "damped")
AWARE: dict[str, Any] = {name: _pure(getattr(maths, name)) for name in _NUMBERS}
AWARE |= {"sqrt": lambda q: quantity(q) ** 0.5, "sign": lambda q: maths.sign(quantity(q).value), "pi": math.pi}


def _constants(function: FunctionType) -> dict[str, Quantity]:
    """Constants of the function's module that carry a unit: a number, and a comment that begins with it."""
    found = {}
    for line in Path(function.__code__.co_filename).read_text(encoding="utf-8").splitlines():
        constant = re.match(r"([A-Z_]+) = [^#]+#\s*([^,:;]+)", line)
        if constant and isinstance(function.__globals__.get(constant[1]), float):
            words = constant[2].split()
            texts = (" ".join(words[:n]) for n in range(len(words), 0, -1))
            known = next((text for text in texts if _is_unit(text)), "1")
            found[constant[1]] = unit(known) * function.__globals__[constant[1]]
    return found


def _is_unit(text: str) -> bool:
    try:
        return bool(unit(text))
    except ValueError:
        return False


def with_units(function: FunctionType) -> FunctionType:
    """The same function, and all it calls in its own module or another effect's, computing with quantities."""
    scope: dict[str, Any] = {**function.__globals__, **_constants(function), **AWARE, "math": SimpleNamespace(**AWARE)}
    for name, value in function.__globals__.items():
        if not isinstance(value, FunctionType):
            continue
        if value.__module__ == function.__module__:
            scope[name] = FunctionType(value.__code__, scope, name, value.__defaults__)
        elif value.__module__.startswith("pneumo_ros.plant.effects."):
            scope[name] = with_units(value)
    return FunctionType(function.__code__, scope, function.__name__, function.__defaults__)
