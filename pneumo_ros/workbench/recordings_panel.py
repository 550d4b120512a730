"""The recordings on the desk: dropped or named, fitted or held out, cut, and chosen for the plot."""

from typing import Any

from dash import ALL, Input, Output, State, ctx, dcc, html, no_update
from dash.exceptions import PreventUpdate

from pneumo_ros.workbench.bags import ROLES, Bag
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, asked, choice, revision
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
    role = {"type": "role", "index": ALL}
    panels.act([Input(role, "value"), State(role, "id")], _set_roles)
    panels.act([Input({"type": "uncut", "bag": ALL, "index": ALL}, "n_clicks")], _uncut)
    panels.show(
        [Output("run", "data", allow_duplicate=True), Output("tab", "value", allow_duplicate=True)],
        [Input({"type": "show", "index": ALL}, "n_clicks"), Input("wanted-run", "data")], _chosen, first=False,
    )  # fmt: skip


def render(desk: Desk, _revision: int, chosen: str | None, drawn: str | None) -> tuple[Any, str, Any]:
    """The list, a text that changes with it, and the plotted recording; redrawn only after a change."""
    shown = desk.shelf.bag(chosen)
    name = shown.name if shown else None
    now = repr((desk.shelf.bags, name))
    if now == drawn:
        raise PreventUpdate
    rows = [_row(desk, k, bag, bag.name == name) for k, bag in enumerate(desk.shelf.bags)]
    return rows or html.P("No recordings yet.", className="soft"), now, no_update if name == chosen else name


def _row(desk: Desk, k: int, bag: Bag, shown: bool) -> html.Div:
    if bag.problem:
        return html.Div([html.B(bag.name), html.P(bag.problem, className="problem")], className="bag", role="alert")
    name = html.Button(bag.name, id={"type": "show", "index": k}, type="button", className="name", title=bag.path)
    seconds = html.Small(f"{desk.shelf.recording(bag).duration:.1f} s")
    options = [{"label": words, "value": role} for role, words in ROLES.items()]
    radio = dcc.RadioItems(options, bag.role, id={"type": "role", "index": k}, inline=True, className="roles")
    role = choice(f"What {bag.name} is for", radio, visible=False)
    cuts = [
        html.Button(
            f"cut {a:g}-{b:g} s \N{MULTIPLICATION SIGN}", id={"type": "uncut", "bag": k, "index": i}, type="button",
            **{"aria-label": f"Remove the cut from {a:g} to {b:g} s of {bag.name}"},
        )
        for i, (a, b) in enumerate(bag.cuts)
    ]  # fmt: skip
    return html.Div([name, seconds, role, html.Div(cuts, className="cuts")], className=f"bag{' shown' * shown}")


def _uploaded(desk: Desk, when: int | None) -> None:
    folder = desk.folder / "uploads"
    if when and folder.is_dir():
        own = (TABLES, MACHINES)
        desk.shelf.take(sorted(p for p in folder.iterdir() if not p.name.startswith(".") and p.name not in own))


def _set_roles(desk: Desk, values: list[str | None], names: list[dict[str, Any]]) -> None:
    for role, one in zip(values, names, strict=True):
        bag = desk.shelf.bags[one["index"]]
        if role and role != bag.role:
            desk.shelf.set_role(bag.name, role)


def _uncut(desk: Desk, clicks: list[int | None]) -> None:
    if asked(clicks) and ctx.triggered_id:
        desk.shelf.uncut(desk.shelf.bags[ctx.triggered_id["bag"]].name, ctx.triggered_id["index"])


def _chosen(desk: Desk, clicks: list[int | None], wanted: dict[str, Any] | None) -> tuple[str, str]:
    """A recording by its name in the list, or by its cell in the heat map."""
    if ctx.triggered_id == "wanted-run" and wanted and desk.variant.compared:
        return desk.variant.compared.bags[wanted["number"] - 1], "signals"
    if not asked(clicks) or not isinstance(ctx.triggered_id, dict):
        raise PreventUpdate
    return desk.shelf.bags[ctx.triggered_id["index"]].name, "signals"
