"""The plot of one run: measured and predicted signals, errors, input, regimes."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import SIGNALS
from pneumo_ros.records import Recording
from pneumo_ros.report.chart import Role
from pneumo_ros.workbench.bags import Bag
from pneumo_ros.workbench.thin import Span, in_view, packed, stretches_in
from pneumo_ros.workbench.variant import Variant

Array = NDArray[np.float64]
FIELDS = {"position_m": "position", "pressure_a_pa": "pressure_a", "pressure_b_pa": "pressure_b"}
INPUT = "input"
EXTRAS = {"errors": "errors", "free": "free run"}
_TALL, _LOW = 170, 110  # pixels of a panel


@dataclass(frozen=True)
class View:
    """The contents of the plot: signals and extras by name, the seconds in view, a regime to shade, cursors [s]."""

    shown: Collection[str]
    span: Span | None = None
    regime: str = ""
    cursors: Mapping[str, float] | None = None


def signals_chart(bag: Bag, recording: Recording, view: View, variants: Mapping[str, Variant]) -> dict[str, Any]:
    """The chart for the page's script. `variants`: role of the colour -> variant; without a comparison no curve."""
    lanes = [_lane(name, bag, recording, view, variants) for name in FIELDS if name in view.shown]
    panels = [panel for lane in lanes for panel in lane if panel["traces"]]
    if INPUT in view.shown:
        panels.append(_input(recording, view.span))
    span = view.span or (0.0, recording.duration)
    return {
        "title": bag.name, "x": "time [s]", "link": "run", "span": list(span), "logX": False, "legend": True,
        "panels": panels, "height": 80 + sum(p["pixels"] for p in panels),
        "shades": _shades(bag, view, variants), "cursors": dict(view.cursors or {}),
    }  # fmt: skip


def _lane(
    name: str, bag: Bag, recording: Recording, view: View, variants: Mapping[str, Variant]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """A signal, and its errors below."""
    words, unit, factor = SIGNALS[name]
    signal = getattr(recording, FIELDS[name])
    top, bottom = list[dict[str, Any]](), list[dict[str, Any]]()
    if signal is not None:
        top.append(_trace("measured", "measured", recording.time, factor * signal, view.span))
    for role, variant in variants.items():
        found = _predicted(variant, bag, name)
        if found is None:
            continue
        time, measured, error, free = found
        title = _title(variant)
        top.append(_trace(title, role, time, factor * (measured + error), view.span))
        bottom.append(_trace(f"error of {title}", role, time, factor * error, view.span))
        if "free" in view.shown:
            top.append(_trace(f"free run of {title}", "free", time, factor * (measured + free), view.span))
    return (
        _panel(f"{words} [{unit}]", top, _TALL),
        _panel(f"error [{unit}]", bottom if "errors" in view.shown else [], _LOW),
    )


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


def _input(recording: Recording, span: Span | None) -> dict[str, Any]:
    driven = recording.voltage is None
    values = recording.effort if driven else recording.voltage
    title = "driving force [N]" if driven else "valve voltage [V]"
    traces = [] if values is None else [_trace("input", "third", recording.time, values, span, "steps")]
    return _panel(title, traces, _LOW)


def _trace(
    name: str, role: Role | str, time: Array, values: Array, span: Span | None, kind: str = "line"
) -> dict[str, Any]:
    x, y = in_view(time, values, span)
    return {"name": name, "role": role, "kind": kind, "hidden": False, "x": packed(x), "y": packed(y)}


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
