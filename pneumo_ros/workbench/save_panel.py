"""Results to save: the machine file, the report, and the command lines that make them."""

from importlib.resources import files
from pathlib import Path
from typing import Any

from dash import Output, dcc, html
from flask import Flask, Response, send_file

from pneumo_ros.plant.axes_section import place_of
from pneumo_ros.workbench.desk import Desk, commands
from pneumo_ros.workbench.desks import Desks
from pneumo_ros.workbench.parts import Panels, revision


def layout() -> html.Div:
    """Links and command lines."""
    copy = dcc.Clipboard(target_id="commands", id="copy", title="Copy the command lines")
    return html.Div(
        [
            html.H2("Files"), html.Div(id="files", className="row"),
            html.H2("The same from a terminal"),
            html.P("This page computes with verbs. In an empty folder, these lines do the same:"),
            html.Div(["Copy ", copy], className="row"),
            html.Pre("", id="commands", className="commands"),
        ],
        id="panel-save", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("files", "children"), Output("commands", "children")], [revision()], render)


def machine_path(desk: Desk) -> Path:
    """The file of the current machine: of the desk, as it was given, or shipped with the package."""
    machine = place_of(desk.variant.machine)[0]
    own = desk.folder / machine
    return own if own.is_file() else Path(str(files("pneumo_ros.config") / f"{machine}.yaml"))


def saved_files(desk: Desk) -> dict[str, tuple[str, Path]]:
    """Name for the browser -> (description, path), of the current machine."""
    variant, found = desk.variant, dict[str, tuple[str, Path]]()
    machine = machine_path(desk)
    if machine.is_file():
        found[machine.name] = ("machine file", machine)
    stem = machine.stem
    if variant.report and variant.report.is_file():
        found[f"{stem}_report.html"] = ("report of what made it", variant.report)
    for name in desk.maps:
        found[name] = ("map of a table", desk.folder / name)
    if variant.compared:
        found[f"{stem}_comparison.html"] = ("report of the comparison", variant.compared.report)
        found[f"{stem}_comparison.json"] = ("comparison as JSON", variant.compared.json)
    return found


def render(desk: Desk, _revision: int) -> tuple[Any, str]:
    """Links to the files, and the command lines."""
    links = [
        html.A(f"Save the {what}: {name}", href=f"/files/{desk.folder.name}/{name}", download=name, className="button")
        for name, (what, _) in saved_files(desk).items()
    ]
    lines = [*desk.imported, *commands(desk.lineage()).splitlines()]
    if desk.variant.compared and desk.variant.compared.line not in lines:  # it was compared after it was made
        lines.append(desk.variant.compared.line)
    text = "\n".join(filter(None, lines)) or f"# {desk.variant.machine} as it was given"
    return links or html.P("There are no files yet: press Compare.", className="soft"), text


def serve_files(server: Flask, desks: Desks) -> None:
    """GET /files/DESK/NAME sends one of `saved_files`, and nothing else."""

    def send(desk: str, name: str) -> Response:
        try:
            path = saved_files(desks.of(f"/b/{desk}"))[name][1]
        except KeyError:
            return Response("there is no such file", 404)
        return send_file(path.resolve(), as_attachment=True, download_name=name)

    server.add_url_rule("/files/<desk>/<name>", "files", send)
