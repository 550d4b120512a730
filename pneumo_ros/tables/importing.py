"""A table as a recording: mapped, checked, laid on an even clock, and written with its map."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import pneumo_ros
from pneumo_ros.errors import DataError
from pneumo_ros.measured import PLAIN
from pneumo_ros.records import contract, write_recording
from pneumo_ros.records.rates import laid
from pneumo_ros.records.recording import Array
from pneumo_ros.tables.clock import Clock, clock_of, ordered
from pneumo_ros.tables.even import covered, grid_of
from pneumo_ros.tables.fit import check_signals, check_values
from pneumo_ros.tables.map_file import OTHERS, Map
from pneumo_ros.tables.mapped import mapped
from pneumo_ros.tables.table import Table

FEWEST = 2  # samples of a recording
_HELD = "command"  # the one signal that is held between its values


@dataclass(frozen=True)
class Imported:
    """What becomes a recording: signals (n,) in SI units over `time` (n,) [s], and the commands at their own times."""

    table: Table
    plan: Map
    time: Array
    signals: Mapping[str, Array]
    command: tuple[Array, Array] | None  # times (m,) [s] and values (m,)
    units: Mapping[str, str]
    origins: Mapping[str, str]
    clock: Clock  # of the table
    notes: tuple[str, ...]

    @property
    def rate(self) -> float:
        """Samples in a second [Hz]."""
        return 1.0 / float(np.median(np.diff(self.time)))


def imported(table: Table, plan: Map, rate: float | None = None) -> Imported:
    """The recording that `plan` makes of `table`, at `rate` [Hz] (None: that of the rows).

    Raises UsageError where the map does not fit the table, DataError for data that no verb could use.
    """
    notes = list(table.notes)
    found = mapped(table, plan)
    check_signals(table, plan, found)
    rows = ordered(table.path, found.time, notes.append)
    signals = {name: values[rows] for name, values in found.signals.items()}
    time = found.time[rows]
    clock = clock_of(table.path, time)
    check_values(table.path, signals, found, notes.append)
    used = {name: values for name, values in signals.items() if name != _HELD}
    grid = grid_of(time, clock, rate)
    inside = covered(grid, time, used)
    if len(inside) < FEWEST:
        raise DataError(f"{table.path}: its signals do not overlap in time; {_spans(time, used)}")
    notes += _dropped(signals) + _lost(grid, inside)
    if rate is not None and rate > 1.01 * clock.rate:
        notes.append(
            f"{rate:g} Hz is more than the {clock.rate:.4g} Hz of the rows: the samples between them are interpolated."
        )
    even = {name: _at(grid, inside, laid(grid, time, values, rate is not None)) for name, values in used.items()}
    begin = float(inside[0]) if found.time[rows[0]] < 0.0 else 0.0
    if begin:
        notes.append(f"the time begins at {begin:g} s; the recording begins at 0.")
    command = _changes(time, signals[_HELD], inside) if _HELD in signals else None
    shifted = None if command is None else (command[0] - begin, command[1])
    return Imported(table, plan, inside - begin, even, shifted, found.units, found.origins, clock, tuple(notes))


def write_bag(found: Imported, path: str | Path) -> None:
    """Write the recording as a new rosbag2 folder. Raises DataError or UsageError when `path` exists."""
    fields = {"position", "velocity", "load_cell", "pressure_a", "pressure_b", "supply_pressure"}
    given: dict[str, Any] = {name: values for name, values in found.signals.items() if name in fields}
    if found.command is not None:
        given["command_time"], given["command"] = found.command
    given["further"] = {name: values for name, values in found.signals.items() if name in PLAIN}
    others = {f"{OTHERS}/{name}": found.signals[name] for name in found.plan.others}
    write_recording(
        path, time=found.time, start_ns=0, effort=found.signals.get("force"), others=others,
        description=description(found), **given,
    )  # fmt: skip


def description(found: Imported) -> dict[str, Any]:
    """What the recording says of itself: the map, the table with its hash, units, and what was done."""
    return {
        "schema_version": 1,
        "pneumo_ros": pneumo_ros.__version__,
        "map": json.loads(json.dumps(found.plan.content, default=str)),
        "table": {
            "file": found.table.path.name,
            "sha256": hashlib.sha256(found.table.path.read_bytes()).hexdigest(),
            "constants": dict(found.table.constants),
            "clock": found.clock.words(),
        },
        "units": dict(found.units),
        "topics": {name: f"{OTHERS}/{name}" for name in found.plan.others},
        "joint": contract.JOINT,
        "notes": list(found.notes),
    }


def _at(grid: Array, inside: Array, values: Array) -> Array:
    """The values at those points of the grid that are inside."""
    return values if len(grid) == len(inside) else values[np.searchsorted(grid, inside)]


def _changes(time: Array, values: Array, inside: Array) -> tuple[Array, Array]:
    """Times and values of the commands that change, from the one in force at the start on."""
    good = np.isfinite(values) & (time <= inside[-1])
    time, values = time[good], values[good]
    first = max(int(np.searchsorted(time, inside[0], side="right")) - 1, 0)
    time, values = time[first:], values[first:]
    changed = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    return np.maximum(time[changed], inside[0]), values[changed]


def _dropped(signals: Mapping[str, Array]) -> list[str]:
    """Sentences on samples without a number."""
    counts = {name: int(np.count_nonzero(~np.isfinite(values))) for name, values in signals.items()}
    return [
        f"{count} of {len(signals[name])} samples of {name} are no finite numbers; they are left out, and short gaps "
        "bridged."
        for name, count in counts.items()
        if count
    ]


def _lost(grid: Array, inside: Array) -> list[str]:
    """A sentence on the times at which a signal is missing."""
    lost = len(grid) - len(inside)
    step = float(np.median(np.diff(grid)))
    return [f"{lost * step:.4g} s are left out, in gaps or where a signal is missing."] if lost else []


def _spans(time: Array, signals: Mapping[str, Array]) -> str:
    """The time span of each signal, in words."""
    spans = {name: time[np.isfinite(values)] for name, values in signals.items()}
    return ", ".join(f"{name} {span[0]:.3f} to {span[-1]:.3f} s" for name, span in spans.items())
