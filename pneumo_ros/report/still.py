"""A chart as a drawing that needs no script: what a page shows on paper, and where scripts are off."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.report.chart import Chart, Panel, Trace
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.report.scale import Scale, ticks
from pneumo_ros.report.series import extremes

Array = NDArray[np.float64]
WIDTH = 1440  # units of the drawing: half a pixel of a sheet of paper, so that whole numbers are fine enough
_POINTS = 360  # buckets of a curve, each with two points
_RIGHT, _BOTTOM, _LETTER, _LINE = 24, 84, 13, 30  # room right of and below the panels, width and height of a letter
_WIDTHS = {"spans": 14, "bars": 36, "removed": 36, "area": 2}
_NAMELESS = ("band", "area", "spans", "labels")  # kinds that the legend leaves out


def still(chart: Chart) -> Html:
    """The chart as SVG in the colours of the page's style; hidden traces are left out."""
    legend = _legend(chart)
    top = 20 + _LINE * len(legend)
    height, left = 2 * chart.height, _left(chart)
    total, gap = sum(panel.share for panel in chart.panels), 24
    room = height - top - _BOTTOM - gap * (len(chart.panels) - 1)
    x, parts, y = _across(chart, left), list(legend), float(top)
    for panel in chart.panels:
        own = room * panel.share / total
        parts.append(_panel(panel, x, y, y + own))
        y += own + gap
    parts.append(_x_axis(chart, x, y - gap))
    return tag("svg", parts, class_="still", viewBox=f"0 0 {WIDTH} {height}", aria_hidden="true")


def _left(chart: Chart) -> int:
    names = [len(name) for panel in chart.panels for name in panel.ticks]
    return max(150, _LETTER * max(names, default=0) + 30)


def _legend(chart: Chart) -> list[Html]:
    """Rows of named lines."""
    named = {t.name: t for p in chart.panels for t in p.traces if t.kind not in _NAMELESS and not t.hidden}
    if not chart.legend:
        return []
    rows, row, x = list[Html](), list[Html](), 150
    for name, trace in named.items():
        needed = 70 + _LETTER * len(name)
        if row and x + needed > WIDTH - _RIGHT:
            rows.append(tag("g", row))
            row, x = [], 150
        y = 22 + _LINE * len(rows)
        row.append(_path(f"M{x} {y - 8}h44", trace, "key"))
        row.append(_text(x + 54, y, name, "start"))
        x += needed + 20
    return [*rows, tag("g", row)] if row else rows


def _across(chart: Chart, left: int) -> Scale:
    ends = chart.span or _ends([t.x for p in chart.panels for t in p.traces if not t.hidden], chart.log_x)
    return Scale(*ends, left, WIDTH - _RIGHT, chart.log_x)


def _ends(columns: Sequence[Array], log: bool = False) -> tuple[float, float]:
    """The smallest and largest finite value, on a logarithmic axis of those above 0; room around a single value."""
    found = np.concatenate([np.ravel(one)[np.isfinite(np.ravel(one))] for one in columns] or [np.empty(0)])
    found = found[found > 0.0] if log else found
    if not len(found):
        return (0.1, 1.0) if log else (0.0, 1.0)
    low, high = float(found.min()), float(found.max())
    if high > low:
        return low, high
    return (0.5 * low, 2.0 * high) if log else (low - 0.5, high + 0.5)


def _panel(panel: Panel, x: Scale, top: float, bottom: float) -> Html:
    shown = [t for t in panel.traces if not t.hidden]
    if panel.ticks:
        y = Scale(len(panel.ticks) - 0.3, -0.7, bottom, top)
        marks = [(float(k), name) for k, name in enumerate(panel.ticks)]
    else:
        low, high = _ends([part for t in shown for part in _inside(t, x)])
        room = 0.05 * (high - low)
        y = Scale(low - room, high + room, bottom, top)
        marks = [(value, f"{value:.6g}") for value in ticks(y.low, y.high)]
    grid = "".join(f"M{x.start:.0f} {y(v):.0f}H{x.end:.0f}" for v, _ in marks) if not panel.ticks else ""
    frame = f"M{x.start:.0f} {top:.0f}V{bottom:.0f}H{x.end:.0f}"
    middle, at = 0.5 * (top + bottom), 26
    title = tag("text", panel.title, transform=f"translate({at} {middle:.0f}) rotate(-90)", text_anchor="middle")
    return tag(
        "g",
        tag("path", d=grid, class_="grid") if grid else "",
        tag("path", d=frame, class_="frame"),
        [_text(x.start - 10, y(v) + 8, name, "end") for v, name in marks],
        title if panel.title else "",
        [_trace(t, x, y) for t in shown],
    )


def _inside(trace: Trace, x: Scale) -> list[Array]:
    within = (trace.x >= x.low) & (trace.x <= x.high)
    high = trace.y if trace.y_high is None else trace.y_high
    return [trace.y[within], high[within]]


def _x_axis(chart: Chart, x: Scale, bottom: float) -> Html:
    values = ticks(x.low, x.high, chart.log_x)
    numbers = [_text(x(v), bottom + 34, f"{v:.6g}", "middle") for v in values]
    return tag("g", numbers, _text(0.5 * (x.start + x.end), bottom + 70, chart.x_title, "middle"))


def _trace(trace: Trace, x: Scale, y: Scale) -> Html:
    within = (trace.x >= x.low) & (trace.x <= x.high) | ~np.isfinite(trace.x)
    along, values = trace.x[within], trace.y[within]
    if trace.kind == "labels":
        return tag("g", [_text(x(a) + 10, y(b) + 8, text, "start") for a, b, text in zip(trace.x, trace.y, trace.texts,
                                                                                        strict=True)])  # fmt: skip
    if trace.kind == "band":
        return _path(_band(x, y, along, values, values if trace.y_high is None else trace.y_high[within]), trace)
    if trace.kind == "dots":
        return _path("".join(f"M{x(a):.0f} {y(b):.0f}h0" for a, b in zip(along, values, strict=True) if b == b), trace)
    if trace.kind not in _WIDTHS:
        kept = extremes(values, -(-len(values) // _POINTS))
        along, values = along[kept], values[kept]
    if trace.kind == "steps" and len(along):
        along, values = np.repeat(along, 2)[1:], np.repeat(values, 2)[:-1]
    closing = f"V{y(0.0):.0f}H{x(along[0]):.0f}z" if trace.kind == "area" and len(along) else ""
    return _path(_line(x, y, along, values) + closing, trace)


def _band(x: Scale, y: Scale, along: Array, low: Array, high: Array) -> str:
    """An outline of every stretch without a gap."""
    good = np.isfinite(along) & np.isfinite(low) & np.isfinite(high)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(np.int8)))
    outlines = [
        _line(x, y, np.append(along[a:b], along[a:b][::-1]), np.append(low[a:b], high[a:b][::-1])) + "z"
        for a, b in edges.reshape(-1, 2).tolist()
    ]
    return "".join(outlines)


def _line(x: Scale, y: Scale, along: Array, values: Array) -> str:
    """A path in whole units, with a gap where a value is not finite."""
    words = list[str]()
    before: tuple[int, int] | None = None
    for a, b in zip(along.tolist(), values.tolist(), strict=True):
        if not (math.isfinite(a) and math.isfinite(b)):
            before = None
            continue
        here = (round(x(a)), round(y(b)))
        if before is None:
            words.append(f"M{here[0]} {here[1]}")
        elif here != before:
            words.append(f"l{here[0] - before[0]} {here[1] - before[1]}")
        before = here
    return "".join(words)


def _path(d: str, trace: Trace, what: str = "trace") -> Html:
    """A path in the colour of its role; filled, dotted or thick by its kind."""
    paint = trace.role + "-band" if trace.kind in ("band", "removed") else trace.role
    filled = trace.kind in ("band", "area")
    style = f"fill:var(--{paint})" if filled else f"stroke:var(--{paint})"
    if trace.kind in _WIDTHS and not filled:
        style += f";stroke-width:{_WIDTHS[trace.kind]}"
    kinds = " ".join([what, trace.role, trace.kind, *(["filled"] if filled else [])])
    return tag("path", d=d, class_=kinds, style=style)


def _text(x: float, y: float, words: str, anchor: str) -> Html:
    return tag("text", words, x=f"{x:.0f}", y=f"{y:.0f}", text_anchor=anchor)
