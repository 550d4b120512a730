"""The job at hand: what it does, how long it may still take, and a button that ends it."""

from typing import Any

from dash import Input, Output, State, dcc, html, no_update
from dash.exceptions import PreventUpdate

from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.job import Status
from pneumo_ros.workbench.parts import Panels, asked, button

_OFTEN = 500  # ms between looks at the desk


def layout() -> html.Div:
    """The bar, and the clock that looks at the desk."""
    stores = [dcc.Store(id="revision"), dcc.Store(id="opened"), dcc.Interval(id="clock", interval=_OFTEN)]
    says = html.P("", id="job-says", role="status")
    bar = html.Progress(id="job-share", max="100", value="0", **{"aria-label": "Share done"})
    stop = button("Cancel", "cancel")
    return html.Div([html.Div([says, stop, bar], id="job", hidden=True), *stores])


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show(
        [Output("revision", "data"), Output("job", "hidden"), Output("job-says", "children"),
         Output("job-share", "value"), Output("cancel", "hidden"), Output("opened", "data"),
         Output("tab", "value", allow_duplicate=True)],
        [Input("clock", "n_intervals"), State("revision", "data"), State("job-says", "children"),
         State("opened", "data")],
        _look, first=False,
    )  # fmt: skip
    panels.act([Input("cancel", "n_clicks")], _cancel)


def _look(desk: Desk, _ticks: int, seen: int | None, said: str, opened: int | None) -> tuple[Any, ...]:
    status = desk.job.status() if desk.job else None
    text = words(status) if status else ""
    number, tab = desk.opened
    if seen == desk.revision and text == said and number == (opened or 0):
        raise PreventUpdate
    return (
        no_update if seen == desk.revision else desk.revision, status is None or status.state == "done", text,
        str(round(100 * status.share)) if status else "0", status is None or status.state != "running",
        number, tab if number != (opened or 0) else no_update,
    )  # fmt: skip


def _cancel(desk: Desk, clicks: int | None) -> None:
    if asked(clicks):
        desk.cancel()


def words(status: Status) -> str:
    """A job in a sentence."""
    if status.state == "failed":
        return f"{status.title} failed: {status.message}"
    if status.state != "running":
        return status.message
    left = "" if status.left is None else f", {_duration(status.left)} left"
    return f"{status.title}: {100 * status.share:.0f} %{left}: {status.doing}"


def _duration(seconds: float) -> str:
    return f"about {max(seconds, 1.0):.0f} s" if seconds < 100.0 else f"about {seconds / 60.0:.0f} min"
