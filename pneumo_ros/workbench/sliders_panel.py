"""Sliders for every parameter, with the simulated response beside what was measured."""

from functools import lru_cache
from typing import Any

from dash import ALL, ClientsideFunction, Input, Output, State, ctx, dcc, html, no_update
from dash.exceptions import PreventUpdate

from pneumo_ros.diagnose.wording import SIGNALS, number
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, button, drop_down, revision
from pneumo_ros.workbench.thin import in_view, packed

_SLIDER = {"type": "slider", "name": ALL}
_BUTTONS = {"reset": "Back to the values", "keep": "Keep as a variant"}
_TOLD = {"type": "slid", "name": ALL}


def layout() -> html.Div:
    """The choice of a part of the machine, its sliders, and the response."""
    plot = dcc.Graph(id="response", responsive=True, style={"height": "100%"}, config={"displayModeBar": False})
    text = (
        "The machine is simulated from a measured state over what is in view under Signals, at most 10 s of it, with "
        "the measured voltage. A slider goes from a quarter of a value to four times it."
    )
    parts = drop_down("Part of the machine", "section", clearable=False)
    return html.Div(
        [
            html.P(text, className="soft"),
            html.Div([parts, *(button(words, key) for key, words in _BUTTONS.items())], className="row"),
            html.Div(id="sliders"),
            html.P("", id="response-says", className="message", role="alert", hidden=True),
            html.Div(plot, id="response-plot", role="img", **{"aria-label": "Simulated response over time"}),
            *(dcc.Store(id=name) for name in ("values", "response-chart", "sliders-of")),
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
    panels.show(
        [Output("response-chart", "data"), Output("response-says", "children"), Output("response-says", "hidden"),
         Output(_TOLD, "children"), Output("values", "data", allow_duplicate=True)],
        [Input(_SLIDER, "value"), Input("tab", "value"), Input("run", "data"), Input("span", "data"),
         State(_SLIDER, "id"), State("values", "data")], _respond, first=False,
    )  # fmt: skip
    panels.act([Input("keep", "n_clicks"), State("values", "data")], _keep)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "figure"), Output("response", "figure"), Input("response-chart", "data"),
        Input("theme", "data"), prevent_initial_call=True,
    )  # fmt: skip


def _sections(desk: Desk, _revision: int, chosen: str | None) -> tuple[Any, str]:
    names = list(dict.fromkeys(name.partition(".")[0] for name in desk.model().parameters))
    if chosen in names and _revision:
        return [{"label": name.replace("_", " "), "value": name} for name in names], chosen or names[0]
    first = "lugre_friction" if "lugre_friction" in names else names[0]
    return [{"label": name.replace("_", " "), "value": name} for name in names], first


def _draw(
    desk: Desk, section: str | None, _reset: int | None, _revision: int, moved: dict[str, int] | None, drawn: Any
) -> tuple[Any, Any, Any]:
    """The sliders of a part; `moved` keeps the stops of all parts until they are kept or taken back."""
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
    told = html.Output("", id={"type": "slid", "name": name})
    return html.Label([html.Span(key, title=known.meaning), bar, told], className="slider-row")


def _values(model: Model, stops: dict[str, int]) -> dict[str, float]:
    from pneumo_ros.workbench.response import slid

    own = {name: stop for name, stop in stops.items() if name in model.parameters and stop}
    return {name: slid(model[name], stop, model.specification(name)) for name, stop in own.items()}


def _respond(
    desk: Desk, at: list[Any], tab: str, run: str | None, span: list[float] | None, names: list[dict[str, str]],
    moved: dict[str, int] | None,
) -> tuple[Any, ...]:  # fmt: skip
    """The response, what is wrong with it, the values told, and the stops."""
    bag = desk.shelf.bag(run)
    if tab != "sliders" or bag is None or not names:
        raise PreventUpdate
    stops = (moved or {}) | {one["name"]: int(stop or 0) for one, stop in zip(names, at, strict=True)}
    base = desk.model()
    model, values = base, {}
    try:
        values = _values(base, stops)
        model = base.with_parameters(values)
        chart = response_chart(desk, bag.name, model, (span[0], span[1]) if span else (0.0, 1e9))
    except PneumoError as problem:
        return no_update, str(problem), False, _told(base, values, names), stops
    return chart, "", True, _told(model, {}, names), stops


def _told(model: Model, values: dict[str, float], names: list[dict[str, str]]) -> list[str]:
    found = [(one["name"], values.get(one["name"], model.parameters.get(one["name"]))) for one in names]
    return [f"{number(value, 4)} {model.specification(name).unit}".removesuffix(" 1") for name, value in found]


def response_chart(desk: Desk, name: str, model: Model, span: tuple[float, float]) -> dict[str, Any]:
    """Measured, the machine at hand, and the same with the sliders' values, over a stretch of a run."""
    from pneumo_ros.workbench.response import respond

    part, before = _begun(desk, desk.chosen, name, span)
    after = respond(model, part)
    panels = []
    for signal, values in after.items():
        words, unit, factor = SIGNALS[signal]
        inside = slice(part.first + 1, part.first + part.samples + 1)
        curves = {"measured": part.run.signals[signal][inside], "second": before[signal], "model": values}
        titles = {"measured": "measured", "second": "machine at hand", "model": "with the sliders"}
        traces = [_trace(titles[role], role, part.time, factor * curve) for role, curve in curves.items()]
        panels.append({"title": f"{words} [{unit}]", "share": 1, "ticks": [], "traces": traces})
    ends = [float(part.time[0]), float(part.time[-1])]
    return {"title": name, "x": "time [s]", "link": "response", "span": ends, "logX": False, "legend": True,
            "panels": panels, "place": "response-plot", "height": 90 + 150 * len(panels)}  # fmt: skip


def _trace(name: str, role: str, time: Any, values: Any) -> dict[str, Any]:
    x, y = in_view(time, values, None, 600)
    return {"name": name, "role": role, "kind": "line", "hidden": False, "x": packed(x), "y": packed(y)}


@lru_cache(8)
def _begun(desk: Desk, _chosen: int, name: str, span: tuple[float, float]) -> Any:
    """The stretch with its start, and the response of the machine at hand."""
    from pneumo_ros.identify.run import make_run
    from pneumo_ros.workbench.response import respond, stretch

    bag = desk.shelf.bag(name)
    assert bag is not None
    model = desk.model()
    part = stretch(model, make_run(desk.shelf.recording(bag), model.force_driven), *span)
    return part, respond(model, part)


def _keep(desk: Desk, clicks: int | None, moved: dict[str, int] | None) -> None:
    values = _values(desk.model(), moved or {})
    if asked(clicks) and values:
        desk.by_hand(values)
