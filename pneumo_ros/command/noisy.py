"""White noise of sensors on simulated signals, as `pneumo simulate --noise` and `pn.simulate` add it."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    from numpy.random import Generator

MEASURED = {"position": "m", "pressure_a": "Pa", "pressure_b": "Pa"}  # signals that take noise, and its units
EXAMPLE = "position=5e-6,pressure_a=200,pressure_b=200"


def parse_noise(given: Sequence[str]) -> dict[str, float]:
    """Standard deviations by signal from texts such as `EXAMPLE`; UsageError for what is none."""
    found: dict[str, float] = {}
    for text in ",".join(given).split(",") if given else ():
        name, equals, size = text.strip().partition("=")
        if not equals:
            raise UsageError(f"--noise {text} names no signal; type --noise {EXAMPLE}, in m and Pa")
        if name in found:
            raise UsageError(f"--noise is given twice for {name}")
        if name not in MEASURED:
            raise UsageError(f"--noise {text}: {unknown_name('measured signal', name, MEASURED)}")
        found[name] = _size(name, size)
    return found


def _size(name: str, text: str) -> float:
    try:
        size = float(text)
    except ValueError:
        size = math.nan
    if not (math.isfinite(size) and size >= 0.0):
        raise UsageError(
            f"--noise {name}={text}: it takes a standard deviation in {MEASURED[name]}, a number of at least 0"
        )
    return size


def with_noise(
    signals: Mapping[str, Any], noise: Mapping[str, float], random: "Generator", *, force_driven: bool = False
) -> dict[str, Any]:
    """The signals, some with white noise of standard deviation `noise` [m, Pa]; all as they are where there is none.

    Velocity and effort, which a rig seldom measures, are left out of a noisy recording, but for an effort that drives.
    UsageError for a signal that is not measured or not there.
    """
    if not noise:
        return dict(signals)
    there = [name for name in MEASURED if name in signals]
    if unknown := [name for name in noise if name not in there]:
        raise UsageError(unknown_name("measured signal", unknown[0], there))
    unmeasured = {"velocity"} if force_driven else {"velocity", "effort"}
    drawn = {name: signals[name] + random.normal(0.0, size, len(signals[name])) for name, size in noise.items()}
    return {name: one for name, one in signals.items() if name not in unmeasured} | drawn
