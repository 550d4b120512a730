"""Checks of a mapped table: does it hold what some verb can use, and can its values be what the map says?"""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.measured import MEASURED
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.map_file import Map
from pneumo_ros.tables.mapped import Mapped
from pneumo_ros.tables.signals import SIGNALS
from pneumo_ros.tables.table import Table

_BEHAVIOUR = ("force", "load_cell", "pressure_a", "pressure_b", "command", "reference")  # one makes a law with position
_HELD = ("command", *(one.name for one in MEASURED if one.held))  # may be constant
_SEVERAL = 1e-3  # share of the samples below which impossible values are dropouts
_PRESSURES = ("pressure_a", "pressure_b", "supply_pressure")
_SIGN = "its sensor or driver counts the wrong way, it seems; type sign: -1 in its line of the map"


def check_signals(table: Table, plan: Map, found: Mapped) -> None:
    """Raises DataError for a table or map that lacks what every verb needs."""
    if len(table) < 2:
        raise DataError(f"{table.path} has {len(table)} row; a recording needs at least two")
    there = f"the map has {', '.join(plan.signals) or 'no signals'}; {table.listed()}"
    if "position" not in found.signals:
        raise DataError(
            f"{table.path}: no column is mapped to position, which every verb needs; type position: {{column: NAME, "
            "unit: "
            f"mm}} in the section signals; {there}"
        )
    if not any(name in found.signals for name in _BEHAVIOUR):
        raise DataError(
            f"{table.path}: there is a position, and nothing that moves it or results from it; map one of "
            f"{', '.join(_BEHAVIOUR)}; {there}"
        )


def check_values(path: Path, signals: Mapping[str, Array], found: Mapped, warn: Callable[[str], None]) -> None:
    """Raises DataError for signals (n,) [SI] that cannot be what the map says; `warn` gets a sentence on odd ones."""
    for name, values in signals.items():
        finite = values[np.isfinite(values)]
        if not len(finite):
            raise DataError(f"{path}: {name} has no finite number where the clock is usable; leave it out of the map")
        if name in _PRESSURES:
            _check_pressure(path, name, finite, found, warn)
        elif found.units[name] == "Pa" and _reversed(finite):
            warn(f"{_below(name, finite, found)}: {_SIGN}.")
        if len(finite) > 1 and finite.min() == finite.max() and name in SIGNALS and name not in _HELD:
            warn(f"{name} is {finite[0]:.4g} {found.units[name]} throughout: {_constant(name)}.")


def _check_pressure(path: Path, name: str, finite: Array, found: Mapped, warn: Callable[[str], None]) -> None:
    """Absolute pressures are above 0."""
    low, share = float(finite.min()), float(np.mean(finite <= 0.0))
    if low > 0.0:
        return
    said = _below(name, finite, found)
    if _reversed(finite):
        raise DataError(f"{path}: {said}: {_SIGN}")
    if share > _SEVERAL:
        raise DataError(
            f"{path}: {said}; no pressure does. If it is measured against the atmosphere, type gauge: true; else "
            "check its "
            "unit, scale and offset in the map"
        )
    warn(f"{said}: its sensor drops out.")


def _below(name: str, finite: Array, found: Mapped) -> str:
    """How far a pressure falls below 0, in words."""
    share = 100.0 * float(np.mean(finite <= 0.0))
    return (
        f"{name} (column {found.origins[name]}) falls to {float(finite.min()):.4g} Pa absolute, in {share:.2g} % of "
        "its samples"
    )


def _reversed(finite: Array) -> bool:
    """Whether a pressure is mostly below 0: a sensor that is right reads little less than the atmosphere's."""
    return float(np.sum(np.minimum(finite, 0.0) ** 2)) > float(np.sum(np.maximum(finite, 0.0) ** 2))


def _constant(name: str) -> str:
    return "nothing moves" if name in ("position", "velocity") else "is its sensor connected?"
