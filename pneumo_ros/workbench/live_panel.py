"""The live tab: signals of a running axis, its parameters, a record button and the constant-voltage campaign."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from dash import ClientsideFunction, Input, Output, State, dcc, html

from pneumo_ros.errors import UsageError
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.units import shown
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.live import KEPT, Live
from pneumo_ros.workbench.parts import Panels, asked, button, revision
from pneumo_ros.workbench.thin import packed

# panel and its unit -> its series: name, colour, factor
_PANELS: dict[tuple[str, str], tuple[tuple[str, str, float], ...]] = {
    ("position", "mm"): (
        ("position", "measured", 1e3),
        ("setpoint", "second", 1e3),
        ("reference", "third", 1e3),
        ("predicted_position", "model", 1e3),
    ),
    ("velocity", "m/s"): (("velocity", "model", 1.0),),
    ("pressure", "kPa"): (
        ("pressure_a", "measured", 1e-3),
        ("pressure_b", "noise", 1e-3),
        ("predicted_pressure_a", "model", 1e-3),
        ("predicted_pressure_b", "second", 1e-3),
    ),
    ("voltage", "V"): (("voltage", "third", 1.0),),
}
_TEXT = (
    "A simulator or a rig whose nodes run in the ROS domain of this computer; to try it, type simulator in a terminal, "
    "and controller in another one. Beside it, the current machine predicts every second from the measured voltage."
)
_RESTS = 1e-3  # m/s; a slower piston sticks


def layout() -> html.Div:
    """Controls, plot and status."""
    place = html.Label(["Namespace ", dcc.Input(id="namespace", value="", type="text", size="14")])
    closed = html.Label(
        ["Valve closes at ", dcc.Input(id="campaign-closed", value="", type="text", size="6", placeholder="0V or 5V")]
    )
    setting = [
        html.Label(["Node ", dcc.Input(id="set-node", value="simulator", type="text", size="12")]),
        html.Label(["Parameter ", dcc.Input(id="set-name", value="lugre_friction.coulomb_friction", type="text")]),
        html.Label(["Value ", dcc.Input(id="set-value", value="", type="text", size="8")]),
        button("Set", "set"),
        html.Span("", id="set-says", role="status"),
    ]
    return html.Div(
        [
            html.P(_TEXT, className="soft"),
            html.Div([place, button("Watch", "watch", main=True), button("Record", "record")], className="row"),
            html.Details(
                [
                    html.Summary("A campaign, a parameter"),
                    html.Div([closed, button("Constant-voltage campaign", "campaign")], className="row"),
                    html.Div(setting, className="row"),
                ],
                open=True, className="fold",
            ),
            html.P("", id="live-says", role="status"),
            html.Div(id="live-plot", role="img", **{"aria-label": "The axis over the last 20 s"}),
            html.Div(id="live-status"),
            dcc.Store(id="live-on"), dcc.Store(id="live-shown"),
        ],
        id="panel-live", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.act([Input("watch", "n_clicks"), State("namespace", "value")], _watch)
    panels.act([Input("record", "n_clicks")], _record)
    panels.act(
        [Input("campaign", "n_clicks"), State("namespace", "value"), State("campaign-closed", "value")], _campaign
    )
    panels.act([Input("set", "n_clicks"), State("set-node", "value"), State("set-name", "value"),
                State("set-value", "value")], _set)  # fmt: skip
    panels.show([Output("watch", "children"), Output("record", "children"), Output("record", "disabled"),
                 Output("live-on", "data")], [revision()], _buttons)  # fmt: skip
    panels.app.clientside_callback(
        ClientsideFunction("bench", "live"), Output("live-shown", "data"), Input("live-on", "data"),
        Input("tab", "value"),
    )  # fmt: skip


def _watch(desk: Desk, clicks: int | None, namespace: str | None) -> None:
    if not asked(clicks):
        return
    if desk.live is None:
        desk.live = Live((namespace or "").strip().strip("/"), desk.folder)
    else:
        _taken(desk)
        desk.live.close()
        desk.live = None
    desk.changed()


def _taken(desk: Desk) -> None:
    """End a recording and add it to the desk."""
    path = desk.live.stop_recording() if desk.live else None
    if path is not None:
        desk.shelf.take([path])


def _record(desk: Desk, clicks: int | None) -> None:
    if not asked(clicks):
        return
    if desk.live is None:
        raise UsageError("press Watch first: it chooses the axis")
    if desk.live.recording is None:
        desk.live.record()
    else:
        _taken(desk)
    desk.changed()


def _campaign(desk: Desk, clicks: int | None, namespace: str | None, closed: str | None) -> None:
    if asked(clicks):
        desk.campaign((namespace or "").strip().strip("/"), (closed or "").strip())


def _set(desk: Desk, clicks: int | None, node: str, name: str, value: str) -> None:
    if not asked(clicks):
        return
    if desk.live is None:
        raise UsageError("press Watch first")
    try:
        number = float(value)
    except ValueError as problem:
        raise UsageError(f"'{value[:40]}' is no value for {name}; give a number") from problem
    desk.live.set(node or "", name or "", number)


def _buttons(desk: Desk, _revision: int) -> tuple[str, str, bool, bool]:
    live = desk.live
    recording = live is not None and live.recording is not None
    watch, record = "Stop watching" if live else "Watch", "Stop recording" if recording else "Record"
    return watch, record, live is None, live is not None


def live_of(desk: Desk, _asked: Mapping[str, Any]) -> dict[str, Any]:
    """The axis for the page's script: chart, sentence, status of the nodes, and the answer to a setting."""
    live = desk.live
    if live is None:
        return {"chart": None, "says": "", "status": "", "answer": ""}
    curves = live.curves()
    says = "No messages yet: does an axis run in this namespace?"
    if curves:
        live.twin.look(curves, desk.model)
        says = f"{state(curves)} {live.twin.says()}"
    return {"chart": live_chart(curves | _twin(live)) if curves else None, "says": says, "status": _status(live),
            "answer": live.answer}  # fmt: skip


def _twin(live: Live) -> dict[str, tuple[list[float], list[float]]]:
    """The twin's predictions as series of their own."""
    found = {f"predicted_{name}": live.twin.curve(name) for name in ("position", "pressure_a", "pressure_b")}
    return {name: one for name, one in found.items() if one is not None}


def state(curves: dict[str, tuple[list[float], list[float]]]) -> str:
    """Whether the piston sticks or slides: by its velocity, else by its travel in half a second."""
    if "velocity" in curves:
        speed = abs(curves["velocity"][1][-1])
    else:
        times, values = (np.array(column) for column in curves.get("position", ([0.0], [0.0])))
        late = times > times[-1] - 0.5
        speed = float(np.ptp(values[late])) / 0.5
    return f"The piston {'sticks' if speed < _RESTS else 'slides'}, {speed:.4f} {shown('m/s')}."


def live_chart(curves: dict[str, tuple[list[float], list[float]]]) -> dict[str, Any]:
    """The last seconds for the page's script."""
    last = max(times[-1] for times, _ in curves.values())
    panels = []
    for (title, unit), own in _PANELS.items():
        traces = [_trace(name, role, factor, curves[name]) for name, role, factor in own if name in curves]
        panels += [{"title": f"{title} [{shown(unit)}]", "share": 1, "ticks": [], "traces": traces}] if traces else []
    return {"title": "live", "x": "time [s]", "link": "live", "span": [last - KEPT, last], "logX": False,
            "legend": True, "panels": panels, "height": 90 + 125 * len(panels)}  # fmt: skip


def _trace(name: str, role: str, factor: float, curve: tuple[list[float], list[float]]) -> dict[str, Any]:
    times, values = (np.array(column, dtype=float) for column in curve)
    kind = "steps" if name == "voltage" else "line"
    return {"name": name.replace("_", " "), "role": role, "kind": kind, "hidden": False, "x": packed(times),
            "y": packed(factor * values)}  # fmt: skip


def _status(live: Live) -> Html:
    """The status that every node reports."""
    signs = ("good", "warning", "bad")
    rows = []
    for name, one in sorted(live.status.items()):
        values = ", ".join(f"{key} {value}" for key, value in one["values"].items() if str(value).strip())
        more = tag("ul", tag("li", values)) if values else ""
        rows.append(tag("li", tag("b", f"{name}: {one['message']}"), more, class_=signs[min(one["level"], 2)]))
    return Html(tag("h2", "Diagnostics") + tag("ul", rows, class_="findings")) if rows else Html()
