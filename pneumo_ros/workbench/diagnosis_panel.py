"""A diagnosis: verdict, added effects, candidates with evidence, what remains, what to record next."""

from typing import Any

import numpy as np
from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES
from pneumo_ros.report.chart import Chart, Panel, Section, Trace
from pneumo_ros.report.markup import Html, tag, worded
from pneumo_ros.wording.errors import steps_table
from pneumo_ros.wording.naming import the
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, revision
from pneumo_ros.workbench.shown import content

_EMPTY = "Press Diagnose: every effect of the catalogue is tried on what the refitted machine leaves unexplained."


def layout() -> html.Div:
    """A place for the sections."""
    inner = html.Div(id="diagnosis-content", className="content")
    return html.Div([inner, dcc.Store(id="diagnosis"), dcc.Store(id="diagnosis-shown")], id="panel-diagnosis",
                    className="card panel", hidden=True)  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("diagnosis", "data")], [revision()], render)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "show"), Output("diagnosis-shown", "data"), Input("diagnosis", "data")
    )


def render(desk: Desk, _revision: int) -> list[Any]:
    """The last diagnosis on the way to the current machine."""
    found = [v for v in desk.lineage() if "candidates" in v.made_by()]
    if not found:
        return [content("diagnosis-content", [Section("", "Diagnosis", tag("p", _EMPTY))], 0)]
    return [content("diagnosis-content", sections(found[-1].made_by()), str(found[-1].result))]


def sections(result: dict[str, Any]) -> list[Section]:
    """Answer, evidence and remainder; `result` is the JSON of `pneumo diagnose`."""
    from pneumo_ros.report.answer import addition_section, badge, notes
    from pneumo_ros.report.candidates import candidates_section
    from pneumo_ros.report.remains import remains_text
    from pneumo_ros.report.summary import summary_text
    from pneumo_ros.wording.diagnosis import diagnosis

    said, left = diagnosis(result), result["unexplained"]
    word = tag("strong", badge(said).word, class_="badge")
    verdict = tag("p", word, " ", said.headline, class_=f"verdict {badge(said).tone}")
    errors = worded(steps_table(said.steps, said.horizon), "Held-out error step by step") + worded(said.signals)
    charts = (_shape(left),) if left and left["shape"] else ()
    return [
        Section("diagnosis-answer", "Diagnosis", Html(verdict + summary_text(said) + notes(said)),
                parts=tuple(addition_section(one) for one in said.added)),
        Section("diagnosis-error", "Held-out error", Html(errors)),
        candidates_section(said.candidates),
        Section("diagnosis-remains", "What remains", remains_text(said), charts=charts),
    ]  # fmt: skip


def _shape(left: dict[str, Any]) -> Chart:
    """The unknown shape over the variable it follows best."""
    _, unit, factor = EQUATIONS[left["equation"]]
    variable, x_unit, x_factor = VARIABLES[left["against"]]
    x = x_factor * np.array([point[0] for point in left["shape"]])
    mean, low, high, noise = (
        factor * np.array([np.nan if v is None else v for v in column], dtype=float)
        for column in ([point[1] for point in left["shape"]], left["low"], left["high"], left["noise"])
    )
    traces = (
        Trace("95 % of the mean", "second", "band", x, low, high),
        Trace("mean of what remains", "second", "line", x, mean),
        Trace("noise of a window", "noise", "line", x, noise), Trace("noise of a window", "noise", "line", x, -noise),
    )  # fmt: skip
    title = f"Unexplained in {the(left['equation'])}, over {variable}"
    return Chart("diagnosis-shape", title, "", f"{variable} [{x_unit}]", (Panel(f"residual [{unit}]", traces),))
