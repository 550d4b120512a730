"""Commissioning a live axis: the same options as the verb, what to swap, and the machine that was found."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from dash import ClientsideFunction, Input, Output, State, dcc, html

from pneumo_ros.errors import UsageError
from pneumo_ros.report.chart import Section
from pneumo_ros.report.commissioning import found_sections
from pneumo_ros.report.markup import tag
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.job import Job, Line
from pneumo_ros.workbench.parts import Panels, asked, button, revision
from pneumo_ros.workbench.plans import live_options
from pneumo_ros.workbench.shown import content
from pneumo_ros.workbench.variant import Variant

_EMPTY = (
    "The rig's driver runs, the supply pressure is on, and nobody is within reach of the rod. Commission finds out how "
    "the rig is wired, moves it for some minutes, and fits the current machine, as its data sheets tell it."
)
_FIELDS = (  # id, label, width, what it shows when empty
    ("place", "Namespace", "12", "none"), ("closed", "Valve closes at", "6", "0V or 5V"),
    ("sensors", "Pressure sensors", "12", "gauge-bar"), ("minutes", "Minutes of moves", "4", "5"),
    ("timeout", "Silence that ends a move, ms", "5", "200"),
)  # fmt: skip
_OPTIONS = {
    "place": "--namespace",
    "closed": "--closed",
    "sensors": "--sensors",
    "minutes": "--minutes",
    "timeout": "--timeout",
}


def layout() -> html.Div:
    """Fields, a button, and a place for what was found."""
    fields = [
        html.Label(
            [f"{label} ", dcc.Input(id=f"commission-{name}", type="text", value="", size=size, placeholder=hint)]
        )
        for name, label, size, hint in _FIELDS
    ]
    wired = dcc.Checklist([{"label": "go on with wrong plugs", "value": "as-wired"}], [], id="commission-wired")
    inner = html.Div(id="commission-content", className="content")
    return html.Div(
        [html.Div([*fields, wired, button("Commission", "commission", main=True)], className="row"), inner,
         dcc.Store(id="commissioned"), dcc.Store(id="commissioned-shown")],
        id="panel-commission", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    states = [State(f"commission-{name}", "value") for name, *_ in _FIELDS]
    panels.act([Input("commission", "n_clicks"), *states, State("commission-wired", "value")], _begin)
    panels.show([Output("commissioned", "data")], [revision()], render)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "show"), Output("commissioned-shown", "data"), Input("commissioned", "data")
    )


def _begin(desk: Desk, clicks: int | None, *said: Any) -> None:
    if asked(clicks):
        *texts, wired = said
        given = dict(zip(_OPTIONS, ((text or "").strip() for text in texts), strict=True))
        begin(desk, given, bool(wired))


def begin(desk: Desk, given: dict[str, str], as_wired: bool) -> None:
    """Start the verb; UsageError while another job runs."""
    with desk.lock:
        if desk.job is not None and desk.job.running:
            raise UsageError(f"{desk.job.title} is running; cancel it first")
        words, stem = command(desk, given, as_wired), _stem(desk)
        done = partial(_done, desk, stem, words)
        desk.job = Job("Commissioning", [Line(tuple(words))], desk.folder, done, desk.changed)
        desk.changed()


def command(desk: Desk, given: dict[str, str], as_wired: bool) -> list[str]:
    """The words of the verb for what is `given` by field."""
    stem = _stem(desk)
    words = ["commission", "--model", desk.variant.machine, "--out", f"{stem}.yaml", "--folder", f"{stem}_runs"]
    words += [part for name, option in _OPTIONS.items() if given[name] for part in (option, given[name].strip("/"))]
    words += [part for path in desk.given.effects for part in ("--effects", str(Path(path).resolve()))]
    words += live_options(desk.given.how, desk.given.rig)
    words += ["--as-wired"] if as_wired else []
    return [*words, "--json", f"{stem}.json", "--report", f"{stem}.html"]


def _stem(desk: Desk) -> str:
    """A name that no earlier commissioning of this desk has used."""
    return f"commissioned_{1 + len(list(desk.folder.glob('commissioned_*.json')))}"


def _done(desk: Desk, stem: str, words: list[str]) -> None:
    """The machine that was found becomes the current one, and its recordings come to the desk."""
    path = desk.folder / f"{stem}.json"
    result = json.loads(path.read_text(encoding="utf-8"))
    if "machine_file" not in result:
        desk.changed()
        return
    line, before, number = " ".join(["pneumo", *words]), desk.variant, len(desk.variants)
    with desk.lock:
        machine, report = f"{stem}.yaml", desk.folder / f"{stem}.html"
        desk.variants.append(Variant(number, machine, "commissioned", before.number, (line,), path, report))
        desk.choose(number)
    _take(desk, stem, tuple(result["wiring"]["read_as"]))


def _take(desk: Desk, stem: str, wired: tuple[str, ...]) -> None:
    """Add the recordings, where all of this desk are read in the same way."""
    if not desk.shelf.bags:
        desk.shelf.how = replace(desk.shelf.how, words=wired)
        desk.given = replace(desk.given, how=desk.shelf.how)
    if desk.shelf.how.words == wired:
        desk.shelf.take(sorted(one for one in (desk.folder / f"{stem}_runs").iterdir() if one.is_dir()))


def render(desk: Desk, _revision: int) -> list[Any]:
    """The last commissioning of this desk."""
    files = sorted(desk.folder.glob("commissioned_*.json"), key=lambda path: path.stat().st_mtime)
    if not files:
        return [content("commission-content", [Section("", "Commissioning", tag("p", _EMPTY))], 0)]
    result = json.loads(files[-1].read_text(encoding="utf-8"))
    return [content("commission-content", found_sections(result), files[-1].name)]
