"""One line of a map: the columns of a signal, and what turns them into SI units."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name

KEYS = ("column", "columns", "gains", "times", "unit", "sign", "scale", "offset", "gauge", "bits")
EXAMPLE = "{column: p1, unit: bar, gauge: true}"
_BITS = (8, 12, 16, 24, 32)


@dataclass(frozen=True)
class Entry:
    """value = sign * (scale * sum(gains * columns) * times + offset), in `unit`.

    A gain may be the name of a constant of the table or of the map. `unit` None is that in the column's heading.
    `gauge` adds the atmosphere's pressure. `bits`: integers of so many bits, whose negative values are written as
    positive ones.
    """

    columns: tuple[str, ...]
    gains: tuple[float | str, ...]
    unit: str | None = None
    times: str | None = None
    sign: float = 1.0
    scale: float = 1.0
    offset: float = 0.0
    gauge: bool | None = None
    bits: int | None = None


def parse_entry(where: str, given: Any) -> Entry:
    """The entry `given` in a map at `where`. Raises UsageError, with what is allowed."""
    content = {"column": given} if isinstance(given, str) else given
    if not isinstance(content, Mapping):
        raise UsageError(f"{where} is {brief(given)}; it takes a column and its unit, such as {EXAMPLE}")
    if wrong := [key for key in content if key not in KEYS]:
        raise UsageError(f"{where}: {unknown_name('key', str(wrong[0]), KEYS)}")
    columns, gains = _columns(where, content)
    sign = number(f"{where}.sign", content.get("sign", 1.0))
    if sign not in (1.0, -1.0):
        raise UsageError(f"{where}.sign is {sign:g}; it takes 1 or -1; for a factor type scale: {sign:g}")
    gauge, bits = content.get("gauge"), content.get("bits")
    if gauge is not None and not isinstance(gauge, bool):
        raise UsageError(f"{where}.gauge is {brief(gauge)}; it takes true or false")
    if bits is not None and (isinstance(bits, bool) or bits not in _BITS):
        raise UsageError(f"{where}.bits is {brief(bits)}; it takes {', '.join(map(str, _BITS))}")
    scale, offset = (
        number(f"{where}.{key}", content.get(key, usual)) for key, usual in (("scale", 1.0), ("offset", 0.0))
    )
    if scale == 0.0:
        raise UsageError(f"{where}.scale is 0; it takes a factor other than 0")
    unit, times = (_text(f"{where}.{key}", content.get(key)) for key in ("unit", "times"))
    return Entry(columns, gains, unit, times, sign, scale, offset, gauge, bits)


def number(where: str, value: Any) -> float:
    """A finite number; texts such as 1e-3, which YAML does not take for numbers, are read. Raises UsageError."""
    try:
        found = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise UsageError(f"{where} is {brief(value)}; it takes a finite number")
    return found


def _text(where: str, value: Any) -> str | None:
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, int) and not isinstance(value, bool):  # unit: 1
        return str(value)
    raise UsageError(f"{where} is {brief(value)}; it takes a name")


def _columns(where: str, content: Mapping[str, Any]) -> tuple[tuple[str, ...], tuple[float | str, ...]]:
    """The columns, and a gain for each."""
    if ("column" in content) == ("columns" in content):
        raise UsageError(f"{where} takes either column, or columns with gains, such as {EXAMPLE}")
    names: Any
    gains: Any
    if "column" in content:
        if "gains" in content:
            raise UsageError(f"{where}: gains belong to columns; for one column type scale")
        names, gains = [content["column"]], [1.0]
    else:
        names, gains = content["columns"], content.get("gains")
        if not isinstance(names, list) or not names or not isinstance(gains, list) or len(names) != len(gains):
            raise UsageError(
                f"{where} takes as many gains as columns, such as {{columns: [current, bias], gains: [0.15, -1.0], "
                "unit: N}}"
            )
    if not all(isinstance(name, str) for name in names):
        wrong = next(name for name in names if not isinstance(name, str))
        raise UsageError(f"{where}: column {brief(wrong)} is no text; put the name of a column in quotes")
    return tuple(names), tuple(_gain(f"{where}.gains", gain) for gain in gains)


def _gain(where: str, value: Any) -> float | str:
    """A number, or the name of a constant."""
    try:
        return number(where, value)
    except UsageError:
        if isinstance(value, str):
            return value
        raise
