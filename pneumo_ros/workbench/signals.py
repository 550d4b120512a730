"""The plot of one run: measured and predicted signals, errors, any topic, other runs; over time or another signal."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import SIGNALS
from pneumo_ros.records import Recording
from pneumo_ros.report.chart import Role
from pneumo_ros.workbench.bags import Bag
from pneumo_ros.workbench.columns import Column
from pneumo_ros.workbench.curves import EFFORT, FIELDS, INPUT, VELOCITY, Curve, Rig, curve
from pneumo_ros.workbench.thin import ROOM, Span, in_view, packed, stretches_in
from pneumo_ros.workbench.variant import Variant

Array = NDArray[np.float64]
EXTRAS = {"errors": "errors", "free": "free run"}
OVERLAID: tuple[Role, ...] = ("free", "third", "error", "quiet")  # colours of other runs; further ones are left out
_TALL, _LOW, _SQUARE = 170, 110, 340  # pixels of a panel
_NO_RIG = Rig(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class View:
    """The contents of the plot: signals, extras and columns of topics by name, the seconds in view, a regime to shade,
    cursors [s], and the signal that is the x axis instead of the time.
    """

    shown: Collection[str]
    span: Span | None = None
    regime: str = ""
    cursors: Mapping[str, float] | None = None
    over: str = ""


@dataclass(frozen=True)
class Source:
    """A recording with the columns of its topics, if they are asked for, and what forces need."""

    bag: Bag
    recording: Recording
    columns: Mapping[str, Column]
    rig: Rig = _NO_RIG

    def curve(self, name: str) -> Curve | None:
        """A signal by its name."""
        return curve(name, self.recording, self.rig, self.columns)


@dataclass(frozen=True)
class Sheet:
    """Draws curves of one run: over the time in view, or over another signal at the same times."""

    view: View
    across: Curve | None

    def trace(self, name: str, role: Role | str, time: Array, values: Array, kind: str = "line") -> dict[str, Any]:
        """A curve for the page's script."""
        if self.across is None:
            x, y = in_view(time, values, self.view.span)
        else:
            low, high = self.view.span or (-math.inf, math.inf)
            inside = np.flatnonzero((time >= low) & (time <= high))
            inside = inside[:: -(-len(inside) // (2 * ROOM)) or 1]
            x, y, kind = self.across.at(time[inside]), np.asarray(values[inside], dtype=float), "line"
        return {"name": name, "role": role, "kind": kind, "hidden": False, "x": packed(x), "y": packed(y)}


def signals_chart(
    source: Source, view: View, variants: Mapping[str, Variant], others: Sequence[Source] = ()
) -> dict[str, Any]:
    """The chart for the page's script. `variants`: role of the colour -> variant; without a comparison no curve."""
    across = source.curve(view.over) if view.over else None
    sheet = Sheet(view, across)
    panels = [panel for name in FIELDS if name in view.shown for panel in _lane(name, source, sheet, variants, others)]
    more = [name for name in (VELOCITY, EFFORT, INPUT, *source.columns) if name in view.shown]
    panels += [_more(name, source, sheet, others) for name in more]
    panels = [panel for panel in panels if panel["traces"]]
    for panel in panels if across else ():
        panel["pixels"] = panel["share"] = _SQUARE
    return {
        "title": source.bag.name, "x": across.label if across else "time [s]", "link": "run",
        "span": None if across else list(view.span or (0.0, source.recording.duration)), "logX": False, "legend": True,
        "panels": panels, "height": 80 + sum(p["pixels"] for p in panels), "over": view.over if across else "",
        "shades": [] if across else _shades(source.bag, view, variants),
        "cursors": {} if across else dict(view.cursors or {}),
    }  # fmt: skip


def _lane(
    name: str, source: Source, sheet: Sheet, variants: Mapping[str, Variant], others: Sequence[Source]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """A signal of this run and of others, and its errors below."""
    words, unit, factor = SIGNALS[name]
    top, bottom = _measured(name, source, sheet, others), list[dict[str, Any]]()
    for role, variant in variants.items():
        found = _predicted(variant, source.bag, name)
        if found is None:
            continue
        time, measured, error, free = found
        title = _title(variant)
        top.append(sheet.trace(title, role, time, factor * (measured + error)))
        bottom.append(sheet.trace(f"error of {title}", role, time, factor * error))
        if "free" in sheet.view.shown:
            top.append(sheet.trace(f"free run of {title}", "free", time, factor * (measured + free)))
    return (
        _panel(f"{words} [{unit}]", top, _TALL),
        _panel(f"error [{unit}]", bottom if "errors" in sheet.view.shown else [], _LOW),
    )


def _measured(name: str, source: Source, sheet: Sheet, others: Sequence[Source]) -> list[dict[str, Any]]:
    """The signal as measured, in this run and in others, each over its own signal of the x axis."""
    own = source.curve(name)
    found = [] if own is None else [_drawn(own, sheet, "third" if name == INPUT else "measured", "measured")]
    for other, role in zip(others, OVERLAID, strict=False):
        beside = other.curve(name)
        if beside is not None:
            across = other.curve(sheet.view.over) if sheet.across else None
            found.append(_drawn(beside, Sheet(sheet.view, across), role, f"measured, {other.bag.name}"))
    return found


def _drawn(one: Curve, sheet: Sheet, role: Role, name: str) -> dict[str, Any]:
    named = "input" if name == "measured" and one.steps else name
    return sheet.trace(named, role, one.time, one.values, "steps" if one.steps else "line")


def _more(name: str, source: Source, sheet: Sheet, others: Sequence[Source]) -> dict[str, Any]:
    """A panel of a signal that is not predicted."""
    own = source.curve(name)
    return _panel(own.label if own else name, _measured(name, source, sheet, others), _LOW)


def _title(variant: Variant) -> str:
    return f"model {variant.number} ({variant.label})"


def _predicted(variant: Variant, bag: Bag, name: str) -> tuple[Array, Array, Array, Array] | None:
    """Time, measured, errors of the windows and of the free run; None where they were not compared."""
    compared = variant.compared
    k = compared.run(bag.name) if compared else None
    if compared is None or k is None or name not in compared.result["runs"][k - 1]["error"]:
        return None
    keys = ("time", f"measured/{name}", f"error/{name}", f"free/{name}")
    time, measured, error, free = (compared.array(f"{k}/{key}") for key in keys)
    return time, measured, error, free


def _panel(title: str, traces: list[dict[str, Any]], pixels: int) -> dict[str, Any]:
    return {"title": title, "share": pixels, "pixels": pixels, "ticks": [], "traces": traces}


def _shades(bag: Bag, view: View, variants: Mapping[str, Variant]) -> list[dict[str, Any]]:
    """Shaded stretches behind the curves: one regime, and the cuts."""
    found = [{"from": begin, "to": end, "cut": True} for begin, end in bag.cuts]
    for variant in list(variants.values())[:1]:
        compared = variant.compared
        k = compared.run(bag.name) if compared else None
        if compared is None or k is None or view.regime not in compared.result["runs"][k - 1]["regimes"]:
            continue
        time, mask = compared.array(f"{k}/time"), compared.array(f"{k}/regime/{view.regime}")
        found += [{"from": begin, "to": end, "cut": False} for begin, end in stretches_in(time, mask, view.span)]
    return found


def readings(bag: Bag, recording: Recording, view: View, variants: Mapping[str, Variant]) -> list[tuple[str, ...]]:
    """Rows for the cursors A and B: name, value at A, at B, their difference, unit."""
    at = view.cursors or {}
    rows: list[tuple[str, ...]] = [("time", *_values(at, lambda t: t), "s")]
    for name in (name for name in FIELDS if name in view.shown):
        words, unit, factor = SIGNALS[name]
        signal = getattr(recording, FIELDS[name])
        if signal is not None:
            rows.append((f"{words}, measured", *_values(at, _at(recording.time, factor * signal)), unit))
        for variant in variants.values():
            found = _predicted(variant, bag, name)
            if found is not None:
                values = _at(found[0], factor * (found[1] + found[2]))
                rows.append((f"{words}, {_title(variant)}", *_values(at, values), unit))
    return rows


def _at(time: Array, values: Array) -> Any:
    return lambda t: float(values[min(int(np.searchsorted(time, t)), len(values) - 1)])


def _values(at: Mapping[str, float], value: Any) -> tuple[str, str, str]:
    a, b = (value(at[name]) if name in at else math.nan for name in "AB")
    texts = ("-" if math.isnan(one) else f"{one:.6g}" for one in (a, b, b - a))
    return next(texts), next(texts), next(texts)
