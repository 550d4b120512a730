"""The running job: its present step, the time left, and a button that ends it.

The page's script looks at the desk twice a second and after every action (`status_of`), and is the only one to set
`revision`, on which all panels depend.
"""

from collections.abc import Mapping
from typing import Any

from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.job import Status
from pneumo_ros.workbench.parts import Panels, asked, button


def layout() -> html.Div:
    """The bar, and the stores that the script sets."""
    stores = [dcc.Store(id=name) for name in ("revision", "acted", "looked")]
    says = html.P("", id="job-says", role="status")
    bar = html.Progress(id="job-share", max="100", value="0", **{"aria-label": "Share done"})
    stop = button("Cancel", "cancel")
    return html.Div([html.Div([says, stop, bar], id="job", hidden=True), *stores])


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.act([Input("cancel", "n_clicks")], _cancel)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "look"), Output("looked", "data"), Input("acted", "data")
    )


def _cancel(desk: Desk, clicks: int | None) -> None:
    if asked(clicks):
        desk.cancel()


def status_of(desk: Desk, _asked: Mapping[str, Any]) -> dict[str, Any]:
    """The state for the page's script: the revision, the job in words, and the tab to show for its result."""
    status = desk.job.status() if desk.job else None
    number, tab = desk.opened
    return {
        "revision": desk.revision,
        "says": words(status) if status else "",
        "share": round(100 * status.share) if status else 0,
        "running": status is not None and status.state == "running",
        "opened": number,
        "tab": tab,
    }


def words(status: Status) -> str:
    """A job in a sentence; empty when it is done."""
    if status.state == "failed":
        return f"{status.title} failed: {status.message}"
    if status.state != "running":
        return status.message
    left = "" if status.left is None else f", {_duration(status.left)} left"
    return f"{status.title}: {100 * status.share:.0f} %{left}: {status.doing}"


def _duration(seconds: float) -> str:
    return f"about {max(seconds, 1.0):.0f} s" if seconds < 100.0 else f"about {seconds / 60.0:.0f} min"
