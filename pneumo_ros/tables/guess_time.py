"""Which column of a table is its time, and in what unit."""

from typing import NamedTuple

import numpy as np

from pneumo_ros.tables.clock import FASTEST, SLOWEST
from pneumo_ros.tables.heading import heading
from pneumo_ros.tables.hints import words_of
from pneumo_ros.tables.table import Table
from pneumo_ros.tables.units import UNITS, find_unit

_NAMES = ("t", "time", "timestamp", "zeit", "stamp", "clock", "secs", "seconds")
_RISING = 0.99  # share of the steps of a clock that rise


class TimeGuess(NamedTuple):
    """A column of time, its unit, and in words why."""

    column: str
    unit: str
    why: str


def guess_time(table: Table) -> TimeGuess | None:
    """The column that rises and is named like a time, or rises evenly; None where there is none."""
    found = []
    for name, values in table.columns.items():
        steps = np.diff(values[np.isfinite(values)])
        if not len(steps) or np.mean(steps > 0.0) < _RISING:
            continue
        named = any(word in _NAMES for word in words_of(heading(name)[0]).split())
        spread = float(np.percentile(np.abs(steps - np.median(steps)), 90.0) / np.median(steps))
        unit = _unit(name, float(np.median(steps)))
        if unit is not None and (named or spread < 0.5):
            found.append(
                (
                    named,
                    -spread,
                    TimeGuess(
                        name, unit[0], f"rises {'always' if (steps > 0.0).all() else 'nearly always'}, {unit[1]}"
                    ),
                )
            )
    return max(found, key=lambda one: one[:2])[2] if found else None


def _unit(name: str, step: float) -> tuple[str, str] | None:
    """The unit in the heading, or the first in which the rows are as far apart as those of a recording; and why."""
    given = heading(name)[1]
    known = find_unit(given) if given else None
    if given is not None and known is not None:
        return (given, "unit in its heading") if known.dimension == "time" else None
    for unit in ("s", "ms", "us", "ns"):
        rate = 1.0 / (UNITS[unit].factor * step)
        if 0.99 * SLOWEST <= rate <= 1.01 * FASTEST:
            return unit, f"{rate:.4g} Hz in {unit}"
    return None
