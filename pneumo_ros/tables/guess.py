"""The map of an unknown table, guessed from headings, units, ranges, and which column is the rate of which."""

import json
import re
from dataclasses import dataclass, field

import numpy as np

from pneumo_ros.records.recording import Array
from pneumo_ros.tables.guess_time import TimeGuess, guess_time
from pneumo_ros.tables.guess_units import gauge_by_range, unit_by_range, unsigned_bits, velocity_unit
from pneumo_ros.tables.heading import heading
from pneumo_ros.tables.hints import CURRENT, NEEDED, points, words_of
from pneumo_ros.tables.signals import SIGNALS
from pneumo_ros.tables.table import Table
from pneumo_ros.tables.units import UNITS, find_unit, unit_of

_ALIKE = 0.9  # share by which a velocity is the rate of its position
_NO_RATES = ("force", "load_cell", "pressure_a", "pressure_b", "supply_pressure", "reference")  # by their names
_LOOKED_AT = 5000  # rows for correlations
_PAIRED = 24  # columns that are paired
_BEHAVIOUR = ("force", "load_cell", "pressure_a", "pressure_b", "command")


@dataclass(frozen=True)
class Guess:
    """A column taken for a signal: unit, range of its values in it, and in words why."""

    column: str
    unit: str
    low: float
    high: float
    why: str
    gauge: bool | None = None
    bits: int | None = None
    others: tuple[str, ...] = ()  # columns that fit nearly as well


@dataclass(frozen=True)
class Guesses:
    """What a table was taken for; `open` are sentences on what could not be decided, with what to type."""

    time: TimeGuess | None
    signals: dict[str, Guess]
    imposed: bool
    unused: dict[str, str]  # columns left out, with their ranges
    open: tuple[str, ...]
    complete: bool = field(default=True)  # a recording can be made of it


@np.errstate(all="ignore")  # values near the largest double have no rates
def guess(table: Table) -> Guesses:
    """What the columns of `table` most probably are."""
    time = guess_time(table)
    rest = {name: values for name, values in table.columns.items() if time is None or name != time.column}
    usable = {name: values for name, values in rest.items() if _moves(values)}
    slopes = _slopes(table, usable, time)
    scores = {(signal, name): points(signal, name) for signal in SIGNALS for name in usable}
    switches = [name for name, values in rest.items() if name not in usable and _moves(values, 1)]
    scores |= {("command", name): points("command", name) for name in switches}
    _add_pairs(scores, slopes)
    chosen = _assigned(scores)
    signals, doubts = dict[str, Guess](), list[str]()
    for signal in (name for name in SIGNALS if name in chosen):
        signals[signal] = _described(signal, chosen, scores, table, signals, slopes, doubts)
    doubts += _compressed(table, signals)
    missing = _missing(time, signals, list(usable))
    taken = {one.column for one in signals.values()} | ({time.column} if time else set())
    unused = {name: _range(values) for name, values in table.columns.items() if name not in taken}
    imposed = "load_cell" in signals and "command" not in signals and "force" not in signals
    return Guesses(time, signals, imposed, unused, (*missing, *doubts), not missing)


def _moves(values: Array, most: int = 2) -> bool:
    """Whether a column has more than so many different values: a constant has one, a switch two."""
    return len(np.unique(values[np.isfinite(values)])) > most


def _slopes(table: Table, usable: dict[str, Array], time: TimeGuess | None) -> dict[tuple[str, str], float]:
    """For pairs of columns where the rate of the first is proportional to the second: the slope, with its sign."""
    if time is None:
        return {}
    seconds = table.columns[time.column] * unit_of(time.unit).factor
    seconds = seconds[:_LOOKED_AT]
    good = np.flatnonzero(np.isfinite(seconds))
    good = good[np.concatenate([[True], np.diff(seconds[good]) > 0.0])]
    if len(good) < 10:
        return {}
    columns = {name: values[good] for name, values in list(usable.items())[:_PAIRED] if np.isfinite(values[good]).all()}
    columns = {name: values for name, values in columns.items() if np.std(values) > 0.0}
    found = {}
    for first, values in columns.items():
        rate = np.gradient(values, seconds[good])
        for second, other in columns.items():
            if first != second and np.std(rate) > 0.0 and _is_rate(rate, other):
                found[first, second] = float(rate @ other / (other @ other))
    return found


def _is_rate(rate: Array, other: Array) -> bool:
    """Whether `other` is proportional to `rate`: it goes with it, and is 0 where nothing moves, as no pressure is."""
    together = float(rate @ other) / float(np.linalg.norm(rate) * np.linalg.norm(other))
    return min(together, float(np.corrcoef(rate, other)[0, 1])) > _ALIKE


def _add_pairs(scores: dict[tuple[str, str], int], slopes: dict[tuple[str, str], float]) -> None:
    """Points for columns without a telling name, of which one is the rate of the other."""
    rates = {second for _, second in slopes}
    for first, second in slopes:
        named = [scores[signal, first] >= NEEDED for signal in SIGNALS if signal not in ("position", "reference")]
        other = any(scores[signal, second] >= NEEDED for signal in _NO_RATES)
        if first not in rates and not any(named) and not other and scores["reference", first] < NEEDED:
            scores["position", first] += 3
            scores["velocity", second] += 3


def _assigned(scores: dict[tuple[str, str], int]) -> dict[str, str]:
    """A column for each signal, the surest first; each column once."""
    chosen = dict[str, str]()
    order = {name: k for k, name in enumerate(SIGNALS)}
    for (signal, name), score in sorted(scores.items(), key=lambda one: (-one[1], order[one[0][0]])):
        if score >= NEEDED and signal not in chosen and name not in chosen.values():
            chosen[signal] = name
    return chosen


def _described(
    signal: str, chosen: dict[str, str], scores: dict[tuple[str, str], int], table: Table, known: dict[str, Guess],
    slopes: dict[tuple[str, str], float], doubts: list[str],
) -> Guess:  # fmt: skip
    """A column as a signal, with its unit and what is doubtful."""
    column = chosen[signal]
    values = table.columns[column]
    bits = unsigned_bits(values)
    if bits is not None:
        values = np.where(values >= 2.0 ** (bits - 1), values - 2.0**bits, values)
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    unit, why, doubt = _unit(signal, column, low, high, known, slopes)
    gauge = None
    if "pressure" in signal:
        gauge, open_gauge = gauge_by_range(signal, unit_of(unit), low)
        doubts += [open_gauge] if open_gauge else []
        gauge = None if unit_of(unit).gauge is not None else gauge
    if bits is not None:
        why += f", negative values written in {bits} bits"
    doubts += [f"{doubt}: {column}, {low:.4g} to {high:.4g}; check its unit in the map"] if doubt else []
    rivals = tuple(
        name for (other, name), score in scores.items()
        if other == signal and name not in chosen.values() and score >= max(scores[signal, column] - 1, NEEDED)
    )  # fmt: skip
    if rivals:
        doubts.append(f"{signal} may also be {' or '.join(rivals)}; to take it, type its name in the map")
    return Guess(column, unit, low, high, why, gauge, bits, rivals)


def _unit(
    signal: str, column: str, low: float, high: float, known: dict[str, Guess], slopes: dict[tuple[str, str], float]
) -> tuple[str, str, str]:
    """Unit of a column, in words why it was taken, and what is doubtful."""
    given = heading(column)[1]
    found = find_unit(given) if given else None
    if given is not None and found is not None and found.dimension in SIGNALS[signal].dimensions:
        return next(name for name, unit in UNITS.items() if unit is found), "name and unit in its heading", ""
    position = known.get("position")
    if signal == "velocity" and position is not None:
        slope = slopes.get((position.column, column))
        if slope is not None and (fitting := velocity_unit(position.unit, slope)):
            return fitting[0], fitting[1], ""
    if signal == "reference" and position is not None:
        return position.unit, "name; unit of the position", ""
    unit, doubt = unit_by_range(signal, low, high, words_of(column))
    return unit, "name and range", doubt


def _compressed(table: Table, signals: dict[str, Guess]) -> list[str]:
    """A sentence where chamber a is compressed as the position rises: positive positions extend the rod."""
    if "command" in signals or not {"position", "pressure_a", "pressure_b"} <= set(signals):
        return []
    y, a, b = (table.columns[signals[name].column] for name in ("position", "pressure_a", "pressure_b"))
    good = np.isfinite(y) & np.isfinite(a) & np.isfinite(b)
    if np.corrcoef(y[good], a[good])[0, 1] < _ALIKE or np.corrcoef(y[good], b[good])[0, 1] > -_ALIKE:
        return []
    return [
        "pressure_a rises and pressure_b falls with the position, as in sealed chambers of which a shrinks; type "
        "sign: -1 for "
        "position and velocity if a is on the piston side, else swap the two columns"
    ]


def _missing(time: TimeGuess | None, signals: dict[str, Guess], names: list[str]) -> list[str]:
    """Sentences on what a recording needs and was not found among the columns of these names."""
    missing = []
    if time is None:
        missing.append("no column is a time: none rises throughout; type time: {rate: HZ}, the rows in a second")
    if "position" not in signals:
        missing.append("no column is a position; type under signals: position: {column: NAME, unit: mm}")
    if not any(name in signals for name in _BEHAVIOUR):
        currents = [name for name in names if re.search(CURRENT, words_of(name))]
        turns = "position" in signals and unit_of(signals["position"].unit).dimension == "angle"
        unit = "N m" if turns else "N"
        missing.append(
            f"no column is a force, a pressure or a command; type under signals: force: {{column: NAME, unit: {unit}}}"
            + _by_current(currents, unit)
        )
    return missing


def _by_current(columns: list[str], unit: str) -> str:
    """What else to type where a motor's current was recorded, which makes its force by a constant."""
    if not columns:
        return ""
    name = json.dumps(columns[0], ensure_ascii=False)
    return f", or, with the constant of the motor in place of K, force: {{columns: [{name}], gains: [K], unit: {unit}}}"


def _range(values: Array) -> str:
    """The range of a column in words."""
    good = values[np.isfinite(values)]
    return f"{good.min():.4g} to {good.max():.4g}" if len(good) else "no number"
