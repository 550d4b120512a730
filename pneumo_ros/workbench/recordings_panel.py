"""The recordings on the desk: dropped or named, fitted or held out, cut, and chosen for the plot."""

from typing import Any

from dash import Input, Output, State, dcc, html, no_update
from dash.exceptions import PreventUpdate

from pneumo_ros.workbench.bags import ROLES, Bag
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, choice, pressed, revision
from pneumo_ros.workbench.uploads import MACHINES, TABLES


def layout() -> html.Section:
    """The place to drop files, and the list."""
    choose = [
        html.Button(f"Choose {what}", type="button", **{"data-choose": kind})
        for kind, what in (("folder", "a folder"), ("files", "files"))
    ]
    drop = html.Div(["Drop recordings here, folders or files", html.Div(choose, className="row")], id="drop")
    says = html.P("", id="upload-says", className="soft", role="status")
    head = html.H2("Recordings", id="recordings-title")
    stores = [dcc.Store(id="uploaded"), dcc.Store(id="run"), dcc.Store(id="bags-of"), dcc.Store(id="wanted-run")]
    return html.Section(
        [head, drop, says, html.Div(id="bags"), *stores], className="card", **{"aria-labelledby": "recordings-title"}
    )


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("bags", "children"), Output("bags-of", "data"), Output("run", "data")],
                [revision(), Input("run", "data"), State("bags-of", "data")], render)  # fmt: skip
    panels.act([Input("uploaded", "data")], _uploaded)
    panels.press("role", lambda desk, name, role: desk.shelf.set_role(str(name), str(role)))
    panels.press("uncut", _uncut)
    panels.show(
        [Output("run", "data", allow_duplicate=True), Output("tab", "value", allow_duplicate=True)],
        [Input("wanted-run", "data")], _wanted, first=False,
    )  # fmt: skip


def render(desk: Desk, _revision: int, chosen: str | None, drawn: str | None) -> tuple[Any, str, Any]:
    """The list, a text that changes with it, and the plotted recording; redrawn only after a change."""
    shown = desk.shelf.bag(chosen)
    name = shown.name if shown else None
    now = repr((desk.shelf.bags, name))
    if now == drawn:
        raise PreventUpdate
    rows = [_row(desk, bag, bag.name == name) for bag in desk.shelf.bags]
    return rows or html.P("No recordings yet.", className="soft"), now, no_update if name == chosen else name


def _row(desk: Desk, bag: Bag, shown: bool) -> html.Div:
    if bag.problem:
        return html.Div([html.B(bag.name), html.P(bag.problem, className="problem")], className="bag", role="alert")
    name = html.Button(bag.name, type="button", className="name", title=bag.path, **{"data-run": bag.name})
    seconds = html.Small(f"{desk.shelf.recording(bag).duration:.1f} s")
    options = [{"label": words, "value": role} for role, words in ROLES.items()]
    radio = dcc.RadioItems(options, bag.role, id={"type": "role", "name": bag.name}, inline=True, className="roles")
    role = html.Div(choice(f"What {bag.name} is for", radio, visible=False), **pressed("role", bag.name))
    cuts = [
        html.Button(
            f"cut {a:g}-{b:g} s \N{MULTIPLICATION SIGN}", type="button", **pressed("uncut", [bag.name, a, b]),
            **{"aria-label": f"Remove the cut from {a:g} to {b:g} s of {bag.name}"},
        )
        for a, b in bag.cuts
    ]  # fmt: skip
    return html.Div([name, seconds, role, html.Div(cuts, className="cuts")], className=f"bag{' shown' * shown}")


def _uploaded(desk: Desk, when: int | None) -> None:
    folder = desk.folder / "uploads"
    if when and folder.is_dir():
        own = (TABLES, MACHINES)
        desk.shelf.take(sorted(p for p in folder.iterdir() if not p.name.startswith(".") and p.name not in own))


def _uncut(desk: Desk, cut: Any, _value: Any) -> None:
    name, begin, end = cut
    desk.shelf.uncut(str(name), (float(begin), float(end)))


def _wanted(desk: Desk, wanted: dict[str, Any] | None) -> tuple[str, str]:
    """The recording of a cell in the heat map."""
    if not wanted or not desk.variant.compared:
        raise PreventUpdate
    return desk.variant.compared.bags[wanted["number"] - 1], "signals"
