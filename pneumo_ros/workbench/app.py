"""The whole page: its layout, its panels, and its files, all from this machine."""

from functools import partial
from importlib.resources import files
from pathlib import Path

from dash import ClientsideFunction, Dash, Input, Output, dcc, html
from flask import Flask, Response, redirect, request
from werkzeug.wrappers import Response as AnyResponse

from pneumo_ros.workbench import (
    commission_panel,
    diagnosis_panel,
    error_panel,
    failures_panel,
    import_panel,
    lead,
    live_panel,
    machine_panel,
    recordings_panel,
    rig_panel,
    save_panel,
    signals_panel,
    sliders_panel,
)  # fmt: skip
from pneumo_ros.workbench.answers import answer_in_words
from pneumo_ros.workbench.data import answer_page
from pneumo_ros.workbench.desks import Desks
from pneumo_ros.workbench.parts import Panels
from pneumo_ros.workbench.safety import Guard
from pneumo_ros.workbench.uploads import accept_uploads

# key -> name and module of a panel; those of `lead.VIEWS` are opened from the bar, the others from the row of tabs
TABS = {
    "import": ("Import", import_panel),
    "rig": ("Rig", rig_panel),
    "signals": ("Signals", signals_panel),
    "failures": ("Where it fails", failures_panel),
    "error": ("Error step by step", error_panel),
    "diagnosis": ("Diagnosis", diagnosis_panel),
    "sliders": ("Sliders", sliders_panel),
    "live": ("Live", live_panel),
    "commission": ("Commission", commission_panel),
    "save": ("Save", save_panel),
}
_PLOTLY = "/report/plotly.min.js"
_REPORT = {"page.css": "text/css", "series.js": "text/javascript", "plots.js": "text/javascript"}


def make_app(desks: Desks, guard: Guard) -> Dash:
    """The application over `desks`, which answers only requests that `guard` accepts."""
    server = Flask("pneumo_ros.workbench")
    app = Dash(
        "pneumo_ros.workbench", server=server, title="pneumo workbench", update_title=None,
        assets_folder=str(Path(__file__).parent / "assets"), suppress_callback_exceptions=True, enable_mcp=False,
        external_scripts=[{"src": _PLOTLY, "defer": "defer"}, "/report/series.js", "/report/plots.js"],
        external_stylesheets=["/report/page.css"],
        meta_tags=[{"name": "viewport", "content": "width=device-width, initial-scale=1"},
                   {"name": "color-scheme", "content": "light dark"}],
    )  # fmt: skip
    app.layout = _layout()
    panels = Panels(app, desks)
    for module in (lead, recordings_panel, machine_panel, *(module for _, module in TABS.values())):
        module.register(panels)
    app.clientside_callback(ClientsideFunction("bench", "tab"), Output("tab-shown", "data"), Input("tab", "value"))
    server.add_url_rule("/report/<name>", "report", _report_file)
    answer_in_words(server)
    accept_uploads(server, desks.uploads)
    answer_page(server, desks, panels.presses)
    save_panel.serve_files(server, desks)
    guard.protect(server, lambda: f"/b/{desks.new()}", app.csp_hashes())
    server.before_request(partial(_led_on, desks))
    return app


def _led_on(desks: Desks) -> AnyResponse | None:
    """Redirect from the address of a closed desk to a new one."""
    if not request.path.startswith("/b/"):
        return None
    try:
        desks.of(request.path)
    except KeyError:
        return redirect("/", 303)
    return None


def _layout() -> html.Div:
    options = [{"label": words, "value": key} for key, (words, _) in TABS.items() if key not in lead.VIEWS]
    tabs = html.Fieldset(
        [html.Legend("View", className="hidden-words"), dcc.RadioItems(options, "signals", id="tab", className="tabs")]
    )
    verdict = html.P("", id="verdict", className="verdict")
    side = html.Aside([recordings_panel.layout(), machine_panel.layout()], className="side")
    main = html.Main([verdict, tabs, *(module.layout() for _, module in TABS.values())])
    return html.Div(
        [dcc.Location(id="url", refresh=False), dcc.Store(id="tab-shown"), lead.layout(),
         html.Div([main, side], className="columns")],
        id="bench",
    )  # fmt: skip


def _report_file(name: str) -> Response:
    """The files that the page shares with reports."""
    if _PLOTLY.endswith(f"/{name}"):
        from plotly.offline import get_plotlyjs

        return Response(get_plotlyjs(), mimetype="text/javascript", headers={"Cache-Control": "private, max-age=3600"})
    if name not in _REPORT:
        return Response("there is no such file", 404)
    text = files("pneumo_ros.report").joinpath(f"assets/{name}").read_text(encoding="utf-8")
    return Response(text, mimetype=_REPORT[name])
