"""Sliders for every parameter, with the simulated and the measured response."""

from typing import Any

from dash import ClientsideFunction, Input, Output, State, ctx, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.plant import Model
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, button, drop_down, revision
from pneumo_ros.workbench.response_chart import value_text, values_of

_BUTTONS = {"reset": "Back to the values", "keep": "Keep as a variant"}


def layout() -> html.Div:
    """The choice of a part of the machine, its sliders, and the response."""
    text = (
        "The machine is simulated from a measured state over the view of the tab Signals, at most 10 s of it, with the "
        "measured voltage. A slider goes from a quarter of a value to four times it."
    )
    parts = drop_down("Part of the machine", "section", clearable=False)
    return html.Div(
        [
            html.P(text, className="soft"),
            html.Div([parts, *(button(words, key) for key, words in _BUTTONS.items())], className="row"),
            html.Div(id="sliders"),
            html.P("", id="response-says", className="message", role="alert", hidden=True),
            html.Div(id="response", role="img", **{"aria-label": "Simulated response over time"}),
            *(dcc.Store(id=name) for name in ("values", "sliders-of", "response-shown")),
        ],
        id="panel-sliders", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("section", "options"), Output("section", "value")],
                [revision(), State("section", "value")], _sections)  # fmt: skip
    panels.show([Output("sliders", "children"), Output("values", "data"), Output("sliders-of", "data")],
                [Input("section", "value"), Input("reset", "n_clicks"), revision(), State("values", "data"),
                 State("sliders-of", "data")], _draw, first=False)  # fmt: skip
    panels.act([Input("keep", "n_clicks"), State("values", "data")], _keep)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "respond"), Output("response-shown", "data"), Input("values", "data"),
        Input("sliders-of", "data"), Input("tab", "value"), Input("run", "data"),
        State("span", "data"), prevent_initial_call=True,
    )  # fmt: skip


def _sections(desk: Desk, _revision: int, chosen: str | None) -> tuple[Any, str]:
    names = list(dict.fromkeys(name.partition(".")[0] for name in desk.model().parameters))
    first = "lugre_friction" if "lugre_friction" in names else names[0]
    options = [{"label": name.replace("_", " "), "value": name} for name in names]
    return options, chosen if chosen in names and chosen else first


def _draw(
    desk: Desk, section: str | None, _reset: int | None, _revision: int, moved: dict[str, int] | None, drawn: Any
) -> tuple[Any, Any, Any]:
    """The sliders of a part; `moved` holds the stops of all parts until they are kept or reset."""
    fresh = ctx.triggered_id == "reset" or (drawn or [None])[0] != desk.chosen
    now = [desk.chosen, section]
    if section is None or (not fresh and now == drawn):
        raise PreventUpdate
    stops = {} if fresh else moved or {}
    model = desk.model()
    names = [name for name in model.parameters if name.partition(".")[0] == section]
    return [_slider(model, name, stops.get(name, 0)) for name in names], stops, now


def _slider(model: Model, name: str, stop: int) -> html.Label:
    known, key = model.specification(name), name.partition(".")[2].replace("_", " ")
    bar = dcc.Input(type="range", min=-100, max=100, step=1, value=stop, id={"type": "slider", "name": name})
    value = html.Output(value_text(model, name), **{"data-told": name})
    return html.Label([html.Span(key, title=known.meaning), bar, value], className="slider-row")


def _keep(desk: Desk, clicks: int | None, moved: dict[str, int] | None) -> None:
    values = values_of(desk.model(), moved or {})
    if asked(clicks) and values:
        desk.by_hand(values)
