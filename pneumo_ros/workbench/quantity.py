"""A number typed by a person, with or without a unit: '0.25', '250 mm', '6 bar'."""

import math
import re

from pneumo_ros.errors import UsageError
from pneumo_ros.tables.units import find_unit

_NUMBER = re.compile(r"\s*(?P<value>[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)\s*(?P<unit>.*?)\s*")


def typed(text: str, name: str, unit: str, atmosphere: float) -> float:
    """The value in `unit` of what was typed for `name`; gauge pressures are above `atmosphere` [Pa].

    Raises UsageError for a text that is no number, and for a unit of something else.
    """
    match = _NUMBER.fullmatch(text)
    if match is None or not math.isfinite(float(match["value"])):
        raise UsageError(f"{name}: '{text[:40]}' is no number; type one in {unit}, or with its unit, such as 6 bar")
    value, given = float(match["value"]), match["unit"]
    if not given or given == unit:
        return value
    found, wanted = find_unit(given), find_unit(unit)
    if found is None or wanted is None or found.dimension != wanted.dimension:
        raise UsageError(f"{name} is measured in {unit}; '{given[:20]}' is no unit of that")
    rise = atmosphere if found.gauge else 0.0
    return (found.factor * value + found.shift + rise - wanted.shift) / wanted.factor
