"""Where the machine fails: heat map, findings, every equation's residual against every variable, and regimes."""

from typing import Any

from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.compare.findings import verdict
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import tag
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.error_panel import judged_by
from pneumo_ros.workbench.parts import Panels, revision
from pneumo_ros.workbench.shown import content

_EMPTY = "Press Compare: every recording is predicted, every equation judged against the noise of its sensors."


def layout() -> html.Div:
    """A place for the sections of the report of `compare`."""
    inner = html.Div(id="failures-content", className="content")
    return html.Div([inner, dcc.Store(id="failures"), dcc.Store(id="failures-shown")], id="panel-failures",
                    className="card panel", hidden=True)  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("failures", "data"), Output("verdict", "children"), Output("verdict", "className")],
                [revision()], render)  # fmt: skip
    panels.app.clientside_callback(
        ClientsideFunction("bench", "show"), Output("failures-shown", "data"), Input("failures", "data")
    )


def render(desk: Desk, _revision: int) -> tuple[Any, str, str]:
    """The sections of the current machine, its verdict, and the tone of the verdict."""
    from pneumo_ros.report.comparison import findings_section, overview_section
    from pneumo_ros.report.equations import equations_section
    from pneumo_ros.report.regimes import regimes_section

    compared = desk.variant.compared
    if compared is None:
        return (
            content("failures-content", [Section("", "Where it fails", tag("p", _EMPTY))], desk.current),
            "",
            "verdict",
        )
    result = compared.result
    sections = [made(result) for made in (overview_section, findings_section, equations_section, regimes_section)]
    stamp = str(compared.json)
    return content("failures-content", sections, stamp), *banner(desk, result)


def banner(desk: Desk, result: dict[str, Any]) -> tuple[str, str]:
    """The verdict above all panels, with the one headline number, and its tone.

    That of the diagnosis that made the machine, else that of `compare` with the error on the held-out recordings.
    """
    from pneumo_ros.report.answer import SIGNS
    from pneumo_ros.wording.diagnosis import headline

    made = desk.variant.made_by()
    if "candidates" in made:
        return headline(made), f"verdict {SIGNS[made['verdict']][1]}"
    compared, (bags, what) = desk.variant.compared, judged_by(desk)
    assert compared is not None
    runs = [run for name, run in zip(compared.bags, result["runs"], strict=True) if name in bags]
    good = not any(one["explained_by_noise"] is False for one in result["equations"].values())
    return verdict(result, runs, f" on recordings {what}"), f"verdict {'good' if good else 'bad'}"
