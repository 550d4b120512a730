"""A part: one YAML file of figures, each with its unit and its source."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.parts.figure import Figure
from pneumo_ros.parts.quantity import SI, scale

VALVE = {
    "conductance_filling": ("conductance", "sonic conductance C, supply to chamber (P to A, P to B)"),
    "conductance_exhaust": ("conductance", "sonic conductance C, chamber to exhaust (A to E, B to E)"),
    "critical_ratio_filling": ("number", "critical pressure ratio b, supply to chamber"),
    "critical_ratio_exhaust": ("number", "critical pressure ratio b, chamber to exhaust"),
    "nominal_flow": ("flow", "nominal flow qn from 6 to 5 bar gauge, at reference conditions"),
    "kv": ("number", "flow coefficient Kv, m3/h of water at 1 bar"),
    "cv": ("number", "flow coefficient Cv, US gallons of water a minute at 1 psi"),
    "orifice": ("length", "diameter of the orifice"),
    "bandwidth": ("frequency", "frequency to which the spool follows"),
    "switch_on": ("time", "time to switch on"),
    "switch_off": ("time", "time to switch off"),
    "switching_rate": ("frequency", "how often it may switch"),
    "signal_low": ("voltage", "signal at which port b fills fully"),
    "signal_closed": ("voltage", "signal at which all ports are closed"),
    "signal_high": ("voltage", "signal at which port a fills fully"),
    "supply": ("pressure", "supply pressure, gauge"),
    "response": ("time", "time in which the pressure is reached"),
    "pressure_low": ("pressure", "lowest pressure that it holds, gauge"),
    "pressure_high": ("pressure", "pressure at full signal, gauge"),
    "dead_band": ("number", "dead band of the pressure, share of the range"),
}
CYLINDER = {"bore": ("length", "bore"), "rod": ("length", "diameter of the piston rod")}
KINDS = {"valve": VALVE, "regulator": VALVE, "cylinder": CYLINDER}
OPENINGS = ("proportional", "switched")
WAYS = ("3/2", "2/2")  # of switched valves: two or four of them for a cylinder
_SOURCE = ("title", "page", "year", "checked")
_FIGURE = ("value", "unit", "low", "high", "source", "note")


@dataclass(frozen=True)
class Part:
    """A part by name; `kind` is a key of `KINDS`, `opening` one of `OPENINGS` for valves; file: where it was read.

    ways: of on/off valves that serve one chamber, one of `WAYS`; else empty.
    """

    name: str
    kind: str
    title: str
    opening: str
    figures: Mapping[str, Figure]
    file: str
    ways: str = ""

    def meaning(self, figure: str) -> str:
        """What a figure of this kind of part means."""
        return KINDS[self.kind][figure][1]


def part_of(document: object, file: str) -> Part:
    """The part that a file describes; UsageError, with the nearest names, for anything it cannot be."""
    data = _section(document, f"part file {file}", ("name", "kind", "title", "opening", "ways", "figures", "sources"))
    name, kind = _text(data, "name", file), _text(data, "kind", file)
    if kind not in KINDS:
        raise UsageError(f"part file {file}: {unknown_name('kind', kind, KINDS)}")
    opening = _text(data, "opening", file) if kind == "valve" else ""
    if kind == "valve" and opening not in OPENINGS:
        raise UsageError(f"part file {file}: opening is {brief(opening)}; it takes {' or '.join(OPENINGS)}")
    ways = _text(data, "ways", file) if "ways" in data else ""
    if ways and (ways not in WAYS or opening != "switched"):
        raise UsageError(f"part file {file}: ways is {brief(ways)}; switched valves take {' or '.join(WAYS)}, or none")
    sources = {
        str(key): source_text(_section(value, f"part file {file}: source {key}", _SOURCE), f"part file {file}")
        for key, value in _section(data.get("sources"), f"part file {file}: sources").items()
    }
    figures = {
        str(key): figure_of(value, f"part file {file}: {key}", _dimension(str(key), kind, file), sources)
        for key, value in _section(data.get("figures"), f"part file {file}: figures").items()
    }
    return Part(name, kind, _text(data, "title", file), opening, _sound(figures, kind, file), file, ways)


def figure_of(given: object, where: str, dimension: str, sources: Mapping[str, str], *, rule: str = "") -> Figure:
    """A figure of a file in SI units; UsageError where number, unit, interval or source is missing or wrong."""
    data = _section(given, where, _FIGURE)
    unit = data.get("unit", "1" if dimension == "number" else None)
    if not isinstance(unit, str):
        raise UsageError(f"{where}: its unit is {brief(unit)}; it takes a text such as {SI[dimension]}")
    factor = scale(unit, dimension, f"{where}: unit {brief(unit)}")
    value = _number(data.get("value"), where, "value") * factor
    low, high = (_number(data.get(end, data.get("value")), where, end) * factor for end in ("low", "high"))
    if not low <= value <= high:
        raise UsageError(
            f"{where}: its value lies outside low to high; they take the ends of where the true value lies"
        )
    source = data.get("source")
    if not isinstance(source, str) or source not in sources:
        named = unknown_name("source", str(source), sources) if source is not None else "it names no source"
        raise UsageError(f"{where}: {named}; every figure takes one of the file's 'sources'")
    return Figure(value, SI[dimension], low, high, sources[source], rule, str(data.get("note", "")))


def source_text(source: Mapping[str, Any], where: str) -> str:
    """Data sheet, page and year in one line."""
    title = source.get("title")
    if not isinstance(title, str) or not title.strip():
        raise UsageError(f"{where}: a source takes a title, such as 'Data sheet of ...', page and year")
    page = f", p. {source['page']}" if "page" in source else ""
    year = f", {source['year']}" if "year" in source else ", year not stated"
    return title + page + year + (f"; {source['checked']}" if "checked" in source else "")


def _dimension(name: str, kind: str, file: str) -> str:
    if name not in KINDS[kind]:
        raise UsageError(f"part file {file}: {unknown_name('figure', name, KINDS[kind])}")
    return KINDS[kind][name][0]


def _sound(figures: dict[str, Figure], kind: str, file: str) -> dict[str, Figure]:
    """The figures; UsageError for sizes that are not above 0, and for a rod as thick as the bore."""
    signals = ("signal_low", "signal_closed", "signal_high", "dead_band", "supply", "pressure_low")
    for name, figure in figures.items():
        if name not in signals and figure.low <= 0.0:
            raise UsageError(f"part file {file}: {name} is {figure.low:g} {figure.unit}; it takes a number above 0")
        if name.startswith("critical_ratio") and figure.high >= 1.0:
            raise UsageError(f"part file {file}: {name} is {figure.high:g}; it takes a ratio below 1")
    if kind == "cylinder" and not ({"bore", "rod"} <= set(figures) and figures["rod"].high < figures["bore"].low):
        raise UsageError(f"part file {file}: a cylinder takes figures 'bore' and 'rod', and the bore is the larger one")
    return figures


def _section(given: object, where: str, allowed: tuple[str, ...] = ()) -> dict[Any, Any]:
    if not isinstance(given, dict):
        raise UsageError(f"{where} is {brief(given)}; it takes names and values")
    for key in given:
        if allowed and key not in allowed:
            raise UsageError(f"{where}: {unknown_name('entry', str(key), allowed)}")
    return given


def _text(data: Mapping[Any, Any], key: str, file: str) -> str:
    value = data.get(key)
    if not isinstance(value, str) or not value.strip():
        raise UsageError(f"part file {file}: {key} is {brief(value)}; it takes a text")
    return value


def _number(value: object, where: str, key: str) -> float:
    try:
        number = float(value) if isinstance(value, str | int | float) and not isinstance(value, bool) else math.nan
    except (ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise UsageError(f"{where}: {key} is {brief(value)}; it takes a number")
    return number
