"""What a machine file states of how uncertain its values are: standard deviations, by parameter.

    uncertainty:
      lugre_friction:
        coulomb_friction: 12.0   # in the parameter's unit
        static_friction: 40 %    # of its value
        bristle_stiffness: 0     # known exactly

A fit takes them as the widths of its priors, and what is uncertain as free. No fit moves what is known exactly.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.plant.compose import Composition

SECTION = "uncertainty"


def flat(given: object) -> dict[str, object]:
    """Section `uncertainty` by dotted names: parameters below their sections, or dotted names, as ROS gives them.

    UsageError where it holds no names.
    """
    if not isinstance(given, dict):
        raise UsageError(f"section {SECTION} is {brief(given)}; it takes parameters, section.name: deviation")
    return dict(_flat(given))


def _flat(given: Mapping[Any, Any]) -> Iterator[tuple[str, object]]:
    for name, value in given.items():
        if isinstance(value, dict):
            yield from ((f"{name}.{key}", inner) for key, inner in value.items())
        else:
            yield str(name), value


def deviations(composition: Composition, values: Mapping[str, float], given: Mapping[str, object]) -> dict[str, float]:
    """Standard deviations in the parameters' units, from numbers, or from texts such as "20 %" of the value.

    Raises UsageError, with the nearest names, for unknown parameters, and for a negative or infinite deviation.
    """
    return {name: _deviation(composition, values, name, value) for name, value in given.items()}


def _deviation(composition: Composition, values: Mapping[str, float], name: str, given: object) -> float:
    unit = composition.parameter(name).unit
    text, share = (given.rstrip(" %"), given.rstrip().endswith("%")) if isinstance(given, str) else (given, False)
    try:
        if isinstance(text, bool) or not isinstance(text, str | int | float):
            raise ValueError
        number = float(text) * (abs(values[name]) / 100.0 if share else 1.0)
    except (ValueError, OverflowError):
        number = math.nan
    of_zero = share and values[name] == 0.0
    if of_zero or not (math.isfinite(number) and number >= 0.0):
        why = f"; a share of {name} = 0 says nothing" if of_zero else ""
        raise UsageError(
            f"the uncertainty of {name} is {brief(given)}; it takes a standard deviation, as a number "
            f"in {unit} or as a share such as 20 %, or 0 for a value that is known exactly{why}"
        )
    return number


def nested(found: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Deviations by section and parameter, as machine files hold them."""
    result: dict[str, dict[str, float]] = {}
    for dotted, value in found.items():
        section, _, key = dotted.partition(".")
        result.setdefault(section, {})[key] = value
    return result
