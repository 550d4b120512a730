"""The figures of a report as files, PNG and SVG, drawn by matplotlib from the same charts as the page."""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pneumo_ros.compare.wording import times
from pneumo_ros.report.chart import Chart, HeatMap, Panel, Trace

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {  # of each role
    "measured": "#8791a1", "model": "#0b6fc2", "error": "#c2410c", "free": "#7a5195", "noise": "#6b7688",
    "quiet": "#9aa5b5", "first": "#0b6fc2", "second": "#c2410c", "third": "#2f855a",
}  # fmt: skip
_DPI = 150
_INCH = 100.0  # pixels of the page
_WIDTH = 9.0  # inches
_NAMELESS = ("band", "area", "spans", "labels")  # kinds that the legend leaves out
_THICK = {"spans": 6.0, "bars": 11.0, "removed": 11.0}


def draw_charts(
    figures: Sequence[Chart | HeatMap], folder: Path, progress: Callable[[float], None] | None = None
) -> int:
    """Draw every figure into `folder` as NAME.png and NAME.svg; returns how many.

    `progress` is called with the share done.
    """
    import matplotlib as mpl

    with mpl.rc_context(_settings()):
        for k, one in enumerate(figures):
            if progress:
                progress(k / len(figures))
            made = _heat(one) if isinstance(one, HeatMap) else _chart(one)
            for kind, metadata in (("png", {}), ("svg", {"Date": None})):
                made.savefig(folder / f"{one.name}.{kind}", dpi=_DPI, metadata=metadata)
    return len(figures)


def drawn(chart: Chart | HeatMap) -> "Figure":
    """One chart as a figure of matplotlib."""
    import matplotlib as mpl

    with mpl.rc_context(_settings()):
        return _heat(chart) if isinstance(chart, HeatMap) else _chart(chart)


def _settings() -> Any:
    return {
        "svg.fonttype": "none", "svg.hashsalt": "pneumo_ros", "path.simplify": True, "axes.grid": True,
        "grid.color": "#e6eaf0", "axes.spines.top": False, "axes.spines.right": False, "font.size": 9.0,
        "axes.formatter.useoffset": False, "text.usetex": False, "text.parse_math": False,
    }  # fmt: skip


def _chart(chart: Chart) -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, max(chart.height / _INCH, 2.0)), layout="constrained")
    shares = [panel.share for panel in chart.panels]
    rows: Any = figure.subplots(len(shares), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": shares})
    figure.suptitle(chart.title)
    for axes, panel in zip(rows[:, 0], chart.panels, strict=True):
        _panel(axes, panel)
        if chart.legend and axes.get_legend_handles_labels()[0]:
            axes.legend(loc="best", fontsize="small", frameon=False, ncols=3)
    last = rows[-1, 0]
    last.set_xlabel(chart.x_title)
    if chart.log_x:
        _log(last)
    if chart.span:
        last.set_xlim(*chart.span)
    return figure


def _log(axes: "Axes") -> None:
    """A logarithmic x axis with plain numbers at 1, 2 and 5."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _panel(axes: "Axes", panel: Panel) -> None:
    axes.set_ylabel(panel.title)
    named: set[str] = set()
    for trace in panel.traces:
        if trace.hidden:
            continue
        label = trace.name if trace.name not in named and trace.kind not in _NAMELESS else None
        named.add(trace.name)
        _trace(axes, trace, label)
    if panel.ticks:
        axes.set_yticks(range(len(panel.ticks)), panel.ticks)
        axes.set_ylim(len(panel.ticks) - 0.3, -0.7)


def _trace(axes: "Axes", trace: Trace, label: str | None) -> None:
    colour = COLOURS[trace.role]
    if trace.kind == "band":
        axes.fill_between(trace.x, trace.y, _upper(trace), color=colour, alpha=0.18, linewidth=0.0)
    elif trace.kind == "area":
        axes.fill_between(trace.x, trace.y, color=colour, alpha=0.6, linewidth=0.5)
    elif trace.kind == "labels":
        for x, y, text in zip(trace.x, trace.y, trace.texts, strict=True):
            axes.annotate(text, (x, y), (4.0, 0.0), textcoords="offset points", va="center", fontsize="small")
    elif trace.kind == "dots":
        axes.plot(trace.x, trace.y, "o", color=colour, markersize=3.5, label=label)
    else:
        dotted = ":" if trace.role == "noise" and trace.kind not in _THICK else "-"
        width = _THICK.get(trace.kind, {"measured": 2.2, "noise": 0.8}.get(trace.role, 1.0))
        style = "steps-post" if trace.kind == "steps" else "default"
        alpha = 0.25 if trace.kind == "removed" else None
        axes.plot(trace.x, trace.y, dotted, color=colour, linewidth=width, label=label, drawstyle=style, alpha=alpha,
                  solid_capstyle="butt", rasterized=len(trace.x) > 20000)  # fmt: skip


def _upper(trace: Trace) -> Any:
    return trace.y if trace.y_high is None else trace.y_high


def _heat(heat_map: HeatMap) -> "Figure":
    from matplotlib.figure import Figure

    values = np.array([[math.nan if r is None else r for r in row] for row in heat_map.ratios], dtype=float)
    figure = Figure(figsize=(_WIDTH, 1.4 + 0.42 * len(heat_map.rows)), layout="constrained")
    axes = figure.subplots()
    axes.grid(False)
    axes.imshow(np.log2(np.maximum(values, 1.0)), cmap="YlOrRd", vmin=0.0, vmax=7.0, aspect="auto")
    axes.set_title(heat_map.title)
    axes.set_xticks(range(len(heat_map.columns)), heat_map.columns)
    axes.set_yticks(range(len(heat_map.rows)), [name[:40] for name in heat_map.rows])
    for i, row in enumerate(values):
        for k, ratio in enumerate(row):
            text = f"{times(ratio)}\n{heat_map.texts[i][k]}"
            axes.text(k, i, text, ha="center", va="center", fontsize=7.5, color="white" if ratio > 24.0 else "black")
    return figure
