"""Charts as figures of matplotlib or plotly."""

import io
import sys
from typing import Any

from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.report.chart import Chart, HeatMap, Panel, Trace
from pneumo_ros.report.drawing import COLOURS, drawn

_POINTS = 5000  # of a line; more cannot be told apart on a screen
_WIDTHS = {"spans": 6.0, "bars": 14.0, "removed": 14.0}


def figure(chart: Chart | HeatMap, library: str = "matplotlib") -> Any:
    """The chart drawn by `library`, "matplotlib" or "plotly"; UsageError for another one, or if it is not installed."""
    if library not in ("matplotlib", "plotly"):
        raise UsageError(f"library is '{library}'; it takes 'matplotlib' or 'plotly'")
    require_libraries((library,))
    if library == "plotly":
        return _plotly(chart)
    _shown_in_notebooks()
    return drawn(chart)


def _shown_in_notebooks() -> None:
    """A notebook shows figures of matplotlib from here on, as it does once pyplot draws."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if shell is None:
        return
    from matplotlib.figure import Figure

    formatters = shell.display_formatter.formatters.values()
    if not any(Figure in formatter.type_printers for formatter in formatters):
        shell.display_formatter.formatters["image/png"].for_type(Figure, _png)


def _png(figure: Any) -> bytes:
    packed = io.BytesIO()
    figure.savefig(packed, format="png", dpi=100)
    return packed.getvalue()


def _plotly(chart: Chart | HeatMap) -> Any:
    import plotly.graph_objects as go
    from plotly.subplots import make_subplots

    if isinstance(chart, HeatMap):
        heat = go.Heatmap(
            z=chart.ratios, x=list(chart.columns), y=list(chart.rows), text=chart.texts, texttemplate="%{text}"
        )
        return go.Figure(heat).update_layout(title=chart.title)
    shares = [panel.share for panel in chart.panels]
    made = make_subplots(rows=len(shares), cols=1, shared_xaxes=True, row_heights=shares, vertical_spacing=0.04)
    named = set[str]()
    for row, panel in enumerate(chart.panels, start=1):
        for trace in panel.traces:
            for one in _traces(trace, chart.legend and trace.name not in named):
                made.add_trace(one, row=row, col=1)
            named.add(trace.name)
        made.update_yaxes(_axis(panel), row=row, col=1)
    made.update_xaxes(type="log" if chart.log_x else "linear")
    made.update_xaxes(title=chart.x_title, row=len(shares), col=1)
    return made.update_layout(title=chart.title, height=max(chart.height, 200) + 80, template="plotly_white")


def _axis(panel: Panel) -> dict[str, Any]:
    if not panel.ticks:
        return {"title": panel.title}
    return {
        "title": panel.title,
        "tickvals": list(range(len(panel.ticks))),
        "ticktext": panel.ticks,
        "autorange": "reversed",
    }


def _traces(trace: Trace, legend: bool) -> list[Any]:
    """A trace, and below it the lower edge of a band."""
    import plotly.graph_objects as go

    colour, every = COLOURS[trace.role], max(len(trace.x) // _POINTS, 1)
    x, y = trace.x[::every], trace.y[::every]
    shown = "legendonly" if trace.hidden else True
    common: dict[str, Any] = {"name": trace.name, "showlegend": legend, "visible": shown, "legendgroup": trace.name}
    if trace.kind == "labels":
        return [
            go.Scatter(x=x, y=y, mode="text", text=list(trace.texts), textposition="middle right", showlegend=False)
        ]
    if trace.kind == "dots":
        return [go.Scatter(x=x, y=y, mode="markers", marker={"color": colour, "size": 5}, **common)]
    if trace.kind == "band" and trace.y_high is not None:
        low = go.Scatter(x=x, y=y, mode="lines", line={"width": 0}, showlegend=False, visible=shown, hoverinfo="skip")
        high = go.Scatter(
            x=x, y=trace.y_high[::every], mode="lines", line={"width": 0, "color": colour}, fill="tonexty", **common
        )
        return [low, high]
    shape = "hv" if trace.kind == "steps" else "linear"
    line = {"color": colour, "width": _WIDTHS.get(trace.kind, 1.5), "shape": shape}
    return [go.Scatter(x=x, y=y, mode="lines", line=line, fill="tozeroy" if trace.kind == "area" else None, **common)]
