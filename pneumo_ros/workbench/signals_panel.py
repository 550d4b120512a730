"""The plot: zooming to single samples, regimes shaded, cuts, cursors, and a second variant beside the first."""

from typing import Any

from dash import ClientsideFunction, Input, Output, State, ctx, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.diagnose.wording import REGIMES, SIGNALS
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, button, choice, drop_down, revision, table
from pneumo_ros.workbench.signals import EXTRAS, INPUT, View, readings, signals_chart
from pneumo_ros.workbench.thin import Span
from pneumo_ros.workbench.variant import Variant

_CONFIG = {
    "displaylogo": False, "doubleClick": False, "topojsonURL": "",
    "modeBarButtons": [["toImage"], ["zoom2d", "pan2d", "autoScale2d"]],
}  # fmt: skip
_FIRST = [*SIGNALS, INPUT, "errors"]


def layout() -> html.Div:
    """Controls, plot and cursors."""
    signals = {name: words for name, (words, _, _) in SIGNALS.items()} | {INPUT: "input"} | EXTRAS
    shown = dcc.Checklist([{"label": w, "value": n} for n, w in signals.items()], _FIRST, id="shown", inline=True)
    sets = dcc.RadioItems(["A", "B"], "A", id="cursor", inline=True)
    plot = dcc.Graph(id="signals", config=_CONFIG, responsive=True, style={"height": "100%"})
    return html.Div(
        [
            html.Div(choice("Show", shown), className="row"),
            html.Div(
                [
                    drop_down("Shade", "regime", placeholder="no regime"),
                    drop_down("Beside", "other", placeholder="no other variant"),
                    button("Whole run", "whole"),
                    button("Cut what is in view", "cut"),
                    choice("A click sets", sets),
                ],
                className="row",
            ),
            html.P("Drag across the plot to zoom, double click for the whole run.", className="soft"),
            html.Div(plot, id="signals-plot", role="img", **{"aria-label": "Signals of the run over time"}),
            html.Div(id="cursors", className="cursors"),
            *(dcc.Store(id=name) for name in ("chart", "span", "marks", "theme")),
        ],
        id="panel-signals", className="card panel",
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show(
        [Output("span", "data")],
        [Input("signals", "relayoutData"), Input("whole", "n_clicks"), Input("run", "data"), State("span", "data")],
        _span, first=False,
    )  # fmt: skip
    panels.show([Output("marks", "data")], [Input("signals", "clickData"), Input("run", "data"),
                State("cursor", "value"), State("marks", "data")], _mark, first=False)  # fmt: skip
    asks = [revision(), Input("run", "data"), Input("span", "data"), Input("shown", "value"),
            Input("regime", "value"), Input("other", "value"), Input("marks", "data")]  # fmt: skip
    panels.show([Output("chart", "data"), Output("cursors", "children")], asks, render)
    panels.show([Output("regime", "options"), Output("other", "options")], [revision()], _options)
    panels.act([Input("cut", "n_clicks"), State("run", "data"), State("span", "data")], _cut)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "figure"), Output("signals", "figure"), Input("chart", "data"),
        Input("theme", "data"), prevent_initial_call=True,
    )  # fmt: skip


def _span(_desk: Desk, moved: dict[str, Any] | None, _whole: int, _run: str, now: list[float] | None) -> list[Any]:
    if ctx.triggered_id != "signals":
        return [None]
    moved = moved or {}
    if moved.get("xaxis.autorange"):
        return [None]
    span = moved.get("xaxis.range") or [moved.get("xaxis.range[0]"), moved.get("xaxis.range[1]")]
    if span[0] is None or span == now:
        raise PreventUpdate
    return [[float(span[0]), float(span[1])]]


def _mark(
    _desk: Desk, click: dict[str, Any] | None, _run: str, which: str, marks: dict[str, float] | None
) -> list[dict[str, float]]:
    if ctx.triggered_id == "run":
        return [{}]
    if not click or not click.get("points"):
        raise PreventUpdate
    return [{**(marks or {}), which: float(click["points"][0]["x"])}]


def render(
    desk: Desk, _revision: int, run: str | None, span: list[float] | None, shown: list[str], regime: str | None,
    other: int | None, marks: dict[str, float] | None,
) -> tuple[Any, Any]:  # fmt: skip
    """The chart and the table of the cursors."""
    bag = desk.shelf.bag(run)
    if bag is None:
        return None, html.P(
            "Drop a recording on the left, or start with some: pneumo workbench BAG...", className="empty"
        )
    seen: Span | None = (span[0], span[1]) if span else None
    view, variants = View(shown, seen, regime or "", marks), _variants(desk, other)
    recording = desk.shelf.recording(bag)
    if not marks:
        return signals_chart(bag, recording, view, variants), None
    rows = readings(bag, recording, view, variants)
    head = ("", "at A", "at B", "B \N{MINUS SIGN} A", "unit")
    return signals_chart(bag, recording, view, variants), table(head, rows, "Cursors A and B")


def _variants(desk: Desk, other: int | None) -> dict[str, Variant]:
    found = {"model": desk.variant}
    if other is not None and other != desk.current and other < len(desk.variants):
        found["second"] = desk.variants[other]
    return found


def _options(desk: Desk, _revision: int) -> tuple[Any, Any]:
    compared = desk.variant.compared
    names = [name for name in REGIMES if compared and name in compared.result["regimes"]]
    others = [v for v in desk.variants if v.compared and v.number != desk.current]
    return (
        [{"label": REGIMES[name], "value": name} for name in names],
        [{"label": f"{v.number}: {v.label}", "value": v.number} for v in others],
    )


def _cut(desk: Desk, clicks: int | None, run: str | None, span: list[float] | None) -> None:
    bag = desk.shelf.bag(run)
    if asked(clicks) and bag:
        desk.shelf.cut(bag.name, *(span or (0.0, 0.0)))
