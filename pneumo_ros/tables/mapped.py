"""A map applied to a table: time, and each signal in SI units, with the faults that are left."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.entry import Entry
from pneumo_ros.tables.heading import heading
from pneumo_ros.tables.map_file import Map
from pneumo_ros.tables.signals import SIGNALS
from pneumo_ros.tables.table import Table
from pneumo_ros.tables.units import SI, Unit, unit_of


@dataclass(frozen=True)
class Mapped:
    """Signals (n,) in SI units over `time` (n,) [s], NaN where nothing was measured; `units` are those of `signals`.

    `origins` names the columns of each signal. Time is not checked yet.
    """

    time: Array
    signals: Mapping[str, Array]
    units: Mapping[str, str]
    origins: Mapping[str, str]


@np.errstate(all="ignore")  # what leaves the doubles is no finite number, and said below
def mapped(table: Table, plan: Map) -> Mapped:
    """The signals that `plan` finds in `table`.

    Raises UsageError for columns and constants that do not exist and for missing units, DataError for a signal without
    a number.
    """
    signals, units, origins = dict[str, Array](), dict[str, str](), dict[str, str]()
    for name, entry in {**plan.signals, **plan.others}.items():
        columns = [table.column(given) for given in entry.columns]
        unit = _unit(table, name, entry, columns[0])
        values = _combined(table, plan, name, entry, columns)
        values = entry.sign * (entry.scale * values + entry.offset) * unit.factor + unit.shift
        if unit.gauge if entry.gauge is None else entry.gauge:
            values = values + plan.atmosphere
        if not np.isfinite(values).any():
            raise DataError(
                f"{table.path}: {name} (column {', '.join(columns)}) holds no finite number; leave it out of the "
                "map, or "
                f"name another column; {table.listed()}"
            )
        signals[name], units[name] = np.where(np.isfinite(values), values, np.nan), SI[unit.dimension]
        origins[name] = " + ".join(columns) + (f" x {table.column(entry.times)}" if entry.times else "")
    return Mapped(_time(table, plan), signals, units, origins)


def _time(table: Table, plan: Map) -> Array:
    """Time [s] of the rows."""
    timing = plan.timing
    if timing.rate is not None:
        return np.asarray(np.arange(len(table)) / timing.rate, dtype=np.float64)
    column = table.column(timing.column or "")
    unit = timing.unit or heading(column)[1]
    if unit is None or unit_of(unit).dimension != "time":
        raise UsageError(
            f"{table.path.name}: column '{column}' has no unit of time; type time: {{column: '{column}', unit: s}}"
        )
    return np.asarray(table.columns[column] * unit_of(unit).factor)


def _unit(table: Table, name: str, entry: Entry, column: str) -> Unit:
    """Unit of an entry: its own, else that in the heading of its column."""
    known = SIGNALS[name].dimensions if name in SIGNALS else tuple(SI)
    text = entry.unit or (heading(column)[1] if len(entry.columns) == 1 else None)
    if text is None and name not in SIGNALS:
        return unit_of("1")
    if text is None or unit_of(text).dimension not in known:
        said = (
            f"the unit {text} of its heading is none of {' or '.join(known)}"
            if text
            else "neither map nor heading has a unit"
        )
        raise UsageError(
            f"{table.path.name}: signals.{name}: {said}; type unit: {SI[known[0]]}, or another of {' or '.join(known)}"
        )
    unit = unit_of(text)
    if entry.unit is None and entry.gauge is not None and unit.gauge is not None and unit.gauge != entry.gauge:
        raise UsageError(
            f"{table.path.name}: signals.{name}: gauge: {str(entry.gauge).lower()} contradicts the heading "
            f"'{column}'; to "
            f"overrule the heading give the unit too, such as unit: {'psi' if 'psi' in text else 'bar'}"
        )
    return unit


def _combined(table: Table, plan: Map, name: str, entry: Entry, columns: list[str]) -> Array:
    """Sum of the columns, each times its gain, and times the column `times`."""
    total: Array = np.zeros(len(table))
    for column, gain in zip(columns, entry.gains, strict=True):
        values = table.columns[column]
        if entry.bits is not None:
            values = np.where(values >= 2.0 ** (entry.bits - 1), values - 2.0**entry.bits, values)
        total = total + _gain(table, plan, name, gain) * values
    return total if entry.times is None else total * table.columns[table.column(entry.times)]


def _gain(table: Table, plan: Map, name: str, gain: float | str) -> float:
    """A gain, looked up by its name in the map, then in the table."""
    if not isinstance(gain, str):
        return gain
    known = {**table.constants, **plan.constants}
    if gain not in known:
        raise UsageError(f"{table.path.name}: signals.{name}.gains: {unknown_name('constant', gain, known)}")
    return known[gain]
