"""The bar that stays in sight: the steps from recordings to a saved machine, the next sensible one, the running job."""

from functools import partial
from typing import Any

from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.workbench import job_panel
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.next_step import done, next_step
from pneumo_ros.workbench.parts import Panels, asked, button, revision

ACTIONS = {
    "compare": ("Compare", "the machine with all recordings: where does it fail?"),
    "refit": ("Refit", "with the effects that are ticked, to the recordings to fit"),
    "diagnose": ("Diagnose", "look for what is missing, add it and refit"),
    "undo": ("Undo", "back to the machine that this one was made from"),
}
VIEWS = {
    "import": ("Import", "recordings of other units, and tables: say what each column is"),
    "rig": ("Rig", "the machine file and its numbers"),
    "save": ("Save", "the machine file, the reports, and the command lines"),
}  # steps that open a panel
STEPS = ("import", "rig", "compare", "refit", "diagnose", "save")  # in the order of the work


def layout() -> html.Header:
    """The name of the machine, the buttons, the next step or the job, and what went wrong."""
    steps = html.Div([_step(key) for key in (*STEPS, "undo")], className="steps", role="group",
                     **{"aria-label": "Steps"})  # fmt: skip
    title = html.H1([html.Span("pneumo workbench: ", className="hidden-words"), html.Span(id="machine")])
    return html.Header(
        [
            html.Div([title, steps], className="lead-row"),
            html.P("", id="next", role="status"),
            job_panel.layout(),
            html.P("", id="message", className="message", role="alert", hidden=True),
            dcc.Store(id="lead-shown"),
        ],
        id="lead",
    )  # fmt: skip


def _step(key: str) -> html.Button:
    if key in VIEWS:
        words, title = VIEWS[key]
        opens: dict[str, Any] = {"data-tab": key}
        return button(words, f"go-{key}", title=title, **opens)
    words, title = ACTIONS[key]
    return button(words, key, title=title)


def identifier(key: str) -> str:
    """The id of a step's button."""
    return f"go-{key}" if key in VIEWS else key


def register(panels: Panels) -> None:
    """Callbacks of the bar and of the job in it."""
    job_panel.register(panels)
    panels.show([Output("machine", "children")], [revision()], _machine)
    panels.show([Output("message", "children"), Output("message", "hidden")], [revision()], _message)
    panels.show([Output(key, "disabled") for key in ACTIONS], [revision()], _disabled)
    panels.show([Output("next", "children"), *(Output(identifier(key), "className") for key in STEPS)], [revision()],
                render)  # fmt: skip
    for key in ACTIONS:
        panels.act([Input(key, "n_clicks")], partial(_press, key))
    panels.app.clientside_callback(
        ClientsideFunction("bench", "go"), Output("lead-shown", "data"),
        *(Input(identifier(key), "n_clicks") for key in VIEWS), prevent_initial_call=True,
    )  # fmt: skip


def _machine(desk: Desk, _revision: int) -> list[str]:
    return [f"{desk.variant.machine.rpartition('/')[2]} ({desk.variant.label})"]


def _message(desk: Desk, _revision: int) -> tuple[str, bool]:
    return desk.message, not desk.message


def _disabled(desk: Desk, _revision: int) -> list[bool]:
    busy = desk.job is not None and desk.job.running
    return [busy, busy, busy, busy or desk.variant.parent is None]


def _press(key: str, desk: Desk, clicks: int | None) -> None:
    if asked(clicks):
        getattr(desk, key)()


def render(desk: Desk, _revision: int) -> list[Any]:
    """The sentence on the next step, and the class of every step's button."""
    step, finished = next_step(desk), done(desk)
    classes = [" ".join(["main"] * (key == step.key) + ["done"] * (key in finished)) for key in STEPS]
    return [[html.B(f"Next: {step.title}. "), step.why] if step.why else "", *classes]
