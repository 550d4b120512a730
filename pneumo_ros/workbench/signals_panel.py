"""The plot: zooming to single samples, regimes shaded, cuts, cursors, and a second variant beside the first."""

from typing import Any

from dash import ClientsideFunction, Input, Output, State, ctx, dcc, html, no_update
from dash.exceptions import PreventUpdate

from pneumo_ros.compare.wording import REGIMES, SIGNALS
from pneumo_ros.workbench.columns import columns
from pneumo_ros.workbench.curves import EFFORT, FIELDS, INPUT, VELOCITY
from pneumo_ros.workbench.data import cursors_of
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, button, choice, drop_down, revision, table
from pneumo_ros.workbench.signals import EXTRAS

_FIRST = [*SIGNALS, INPUT, "errors"]
_DERIVED = {VELOCITY: "velocity", EFFORT: "piston force"}
_OVER = {name: words for name, (words, _, _) in SIGNALS.items() if name in FIELDS} | _DERIVED | {INPUT: "input"}
_STORES = ("other-of", "signals-shown", "span", "clicked", "marks", "whole-pressed")
_EMPTY = "Drop a recording on the left, or give it at the start: pneumo workbench BAG..."
_MINUS = "\N{MINUS SIGN}"


def layout() -> html.Div:
    """Controls, plot and cursors."""
    signals = {name: words for name, (words, _, _) in SIGNALS.items()} | _DERIVED | {INPUT: "input"} | EXTRAS
    shown = dcc.Checklist([{"label": w, "value": n} for n, w in signals.items()], _FIRST, id="shown", inline=True)
    sets = dcc.RadioItems(["A", "B"], "A", id="cursor", inline=True)
    return html.Div(
        [
            html.Details(
                [
                    html.Summary("Signals, other runs, regimes and cuts"),
                    html.Div(choice("Show", shown), className="row"),
                    html.Div(
                        [
                            drop_down("Also", "also", placeholder="no other run", multi=True),
                            drop_down("Topics", "topics", placeholder="any other number", multi=True),
                            drop_down("Over", "over", placeholder="time"),
                        ],
                        className="row",
                    ),
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
                ],
                open=True, className="fold",
            ),
            html.P(id="signals-says", className="soft"),
            html.Div(id="signals", role="img", **{"aria-label": "Signals of the run over time"}),
            html.Div(id="cursors", className="cursors"),
            *(dcc.Store(id=name) for name in _STORES),
        ],
        id="panel-signals", className="card panel",
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    asks = [revision(), Input("run", "data"), Input("shown", "value"), Input("regime", "value"),
            Input("other", "value"), Input("marks", "data"), Input("also", "value"), Input("topics", "value"),
            Input("over", "value")]  # fmt: skip
    panels.app.clientside_callback(ClientsideFunction("bench", "signals"), Output("signals-shown", "data"), *asks)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "whole"), Output("whole-pressed", "data"), Input("whole", "n_clicks"),
        prevent_initial_call=True,
    )  # fmt: skip
    panels.show([Output("marks", "data")], [Input("clicked", "data"), Input("run", "data"), State("cursor", "value"),
                State("marks", "data")], _mark, first=False)  # fmt: skip
    panels.show([Output("cursors", "children"), Output("signals-says", "children")], asks, render)
    panels.show([Output("regime", "options")], [revision()], _regimes)
    # one callback for both: a list drops a value that comes before its options
    panels.show([Output("other", "options"), Output("other", "value"), Output("other-of", "data")],
                [revision(), State("other-of", "data")], _others)  # fmt: skip
    panels.show([Output("also", "options"), Output("topics", "options"), Output("over", "options")],
                [revision(), Input("run", "data")], _choices)  # fmt: skip
    panels.act([Input("cut", "n_clicks"), State("run", "data"), State("span", "data")], _cut)


def _mark(
    _desk: Desk, click: dict[str, float] | None, _run: str, which: str, marks: dict[str, float] | None
) -> list[dict[str, float]]:
    if ctx.triggered_id == "run" or click is None:
        if not marks:
            raise PreventUpdate
        return [{}]
    return [{**(marks or {}), which: float(click["x"])}]


def render(
    desk: Desk, _revision: int, run: str | None, shown: list[str], regime: str | None, other: int | None,
    marks: dict[str, float] | None, _also: list[str] | None, _topics: list[str] | None, over: str | None,
) -> tuple[Any, str]:  # fmt: skip
    """The table of the cursors, and a sentence."""
    if desk.shelf.bag(run) is None:
        return None, _EMPTY
    asked_for = {"run": run, "shown": shown, "regime": regime, "other": other, "marks": marks}
    rows = cursors_of(desk, asked_for)
    head = ("", "at A", "at B", f"B {_MINUS} A", "unit")
    found = table(head, rows, "Cursors A and B") if rows else None
    if over:
        return None, "Over a signal, the plot shows the seconds that were in view over time."
    return found, "Drag across the plot to zoom, double click for the whole run."


def _regimes(desk: Desk, _revision: int) -> list[Any]:
    compared = desk.variant.compared
    names = [name for name in REGIMES if compared and name in compared.result["regimes"]]
    return [[{"label": REGIMES[name], "value": name} for name in names]]


def _others(desk: Desk, _revision: int, drawn: int | None) -> tuple[Any, Any, int]:
    """The variants that can be shown beside; at first the one that a machine was made from: before and after."""
    others = [v for v in desk.variants if v.compared and v.number != desk.current]
    options = [{"label": f"{v.number}: {v.label}", "value": v.number} for v in others]
    if drawn == desk.chosen:
        return options, no_update, desk.chosen
    parent = desk.variant.parent
    return options, parent if parent in [v.number for v in others] else None, desk.chosen


def _choices(desk: Desk, _revision: int, run: str | None) -> tuple[Any, Any, Any]:
    """Other runs, numbers of all topics, and what the x axis may be."""
    bag = desk.shelf.bag(run)
    if bag is None:
        return [], [], []
    others = [one.name for one in desk.shelf.bags if not one.problem and one.name != bag.name]
    topics = [{"label": name, "value": name} for name in columns(desk.shelf.path(bag), desk.shelf.recording(bag))]
    return others, topics, [*({"label": words, "value": name} for name, words in _OVER.items()), *topics]


def _cut(desk: Desk, clicks: int | None, run: str | None, span: list[float] | None) -> None:
    bag = desk.shelf.bag(run)
    if asked(clicks) and bag:
        desk.shelf.cut(bag.name, *(span or (0.0, 0.0)))
