"""The rig: which machine file describes it, and its numbers, to be edited with or without units."""

from typing import Any

from dash import ALL, Input, Output, State, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.compare.wording import number
from pneumo_ros.plant import Model
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, button, drop_down, revision
from pneumo_ros.workbench.quantity import typed
from pneumo_ros.workbench.uploads import MACHINES

SHIPPED = {
    "axis": "the example axis",
    "paper": "the axis of the paper",
    "emps": "a ball screw driven by a motor",
    "vane": "a rotary vane actuator",
}
_DIGITS = 10  # of a number that is edited
_TEXT = (
    "The machine file describes your rig. Choose one, or start from an example and type the numbers of your data "
    "sheet, with or without a unit: 25 mm, 6 bar, 0.5. From parts with data sheets: pneumo new."
)


def layout() -> html.Div:
    """The choice of a machine file, and a place for its numbers."""
    shipped = drop_down("Example", "shipped", options=[{"label": f"{k}: {w}", "value": k} for k, w in SHIPPED.items()],
                        placeholder="choose one")  # fmt: skip
    own = html.Button("Choose a machine file", type="button", **{"data-choose": "machine"})
    return html.Div(
        [
            html.H2("Rig"),
            html.P(_TEXT, className="soft"),
            html.Div([shipped, own, button("Keep these numbers", "keep-numbers", main=True)], className="row"),
            html.P("", id="machine-says", role="status"),
            html.Div(id="numbers"),
            dcc.Store(id="machine-uploaded"), dcc.Store(id="numbers-of"),
        ],
        id="panel-rig", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("numbers", "children"), Output("numbers-of", "data")],
                [revision(), Input("tab", "value"), State("numbers-of", "data")], render)  # fmt: skip
    panels.act([Input("shipped", "value")], _example)
    panels.act([Input("machine-uploaded", "data")], _uploaded)
    every = {"type": "number", "name": ALL}
    panels.act([Input("keep-numbers", "n_clicks"), State(every, "value"), State(every, "id")], _keep)


def render(desk: Desk, _revision: int, tab: str, drawn: int | None) -> tuple[Any, int]:
    """A table for each part of the machine, once the panel is opened.

    It is redrawn for another variant only, so that nothing typed is lost.
    """
    if tab != "rig" or drawn == desk.chosen:
        raise PreventUpdate
    model = desk.model()
    sections = dict.fromkeys(name.partition(".")[0] for name in model.parameters)
    return [_section(model, section, k < 3) for k, section in enumerate(sections)], desk.chosen


def _section(model: Model, section: str, opened: bool) -> html.Details:
    names = [name for name in model.parameters if name.partition(".")[0] == section]
    head = html.Thead(
        html.Tr([html.Th("parameter and value", scope="col", colSpan=2), html.Th("unit", scope="col"),
                 html.Th("allowed", scope="col")])
    )  # fmt: skip
    table = html.Table([head, html.Tbody([_row(model, name) for name in names])])
    return html.Details(
        [html.Summary(section.replace("_", " ")), html.Div(table, className="wide")], open=opened, className="numbers"
    )


def _row(model: Model, name: str) -> html.Tr:
    known, words = model.specification(name), name.partition(".")[2].replace("_", " ")
    field = dcc.Input(type="text", value=_shown(model[name]), id={"type": "number", "name": name}, size="12")
    label = html.Label(
        [
            html.Span(words),
            html.Span(", ", className="hidden-words"),
            html.Span(known.meaning, className="soft meaning"),
            field,
        ]
    )
    return html.Tr([html.Th(label, scope="row", colSpan=2), html.Td(known.unit), html.Td(known.range_text())])


def _shown(value: float) -> str:
    return number(value, _DIGITS)


def _example(desk: Desk, name: str | None) -> None:
    if name in SHIPPED:
        desk.take_machine(name, f"example {name}")


def _uploaded(desk: Desk, what: dict[str, Any] | None) -> None:
    if what:
        path = desk.folder / "uploads" / MACHINES / str(what["name"]).rpartition("/")[2]
        desk.take_machine(str(path.relative_to(desk.folder)), f"from {path.name}")


def _keep(desk: Desk, clicks: int | None, values: list[str | None], names: list[dict[str, str]]) -> None:
    """A variant with the numbers that differ from the machine's."""
    if not asked(clicks):
        return
    model, changed = desk.model(), dict[str, float]()
    atmosphere = model.parameters.get("air.atmospheric_pressure", desk.shelf.atmosphere)
    for text, one in zip(values, names, strict=True):
        name = one["name"]
        if name in model.parameters and text is not None and text.strip() != _shown(model[name]):
            changed[name] = typed(text, name, model.specification(name).unit, atmosphere)
    if not changed:
        desk.say("No number was changed.")
    else:
        desk.by_hand(changed)
