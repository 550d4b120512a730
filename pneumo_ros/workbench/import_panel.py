"""Importing: tables whose columns and units are chosen in the page, and how recordings of other layouts are read."""

from typing import Any

from dash import ALL, Input, Output, State, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.errors import UsageError
from pneumo_ros.records.corrections import EXAMPLES as NUMBERED
from pneumo_ros.records.corrections import WORDS
from pneumo_ros.tables.signals import MOTIONS, SIGNALS
from pneumo_ros.tables.units import UNITS
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.mapping import Mapped
from pneumo_ros.workbench.parts import Panels, asked, button, choice, revision
from pneumo_ros.workbench.uploads import TABLES

KEYS = ("column", "unit", "reversed", "offset", "gauge")
_TEXT = (
    "Recordings (rosbag2 folders, MCAP, SQLite) are dropped on the page, or chosen under Recordings. Tables (CSV, MAT, "
    "Parquet, NPZ, JSON) are chosen or dropped here; then say what each column is."
)
_RULE = (
    "A value becomes sign x column + offset, in its unit; positive extends the rod, and positions are from mid stroke. "
    "A command of 0 to 10 V with its centre at 5 V has the offset -5."
)
_READ = f"Words: {', '.join((*WORDS, *NUMBERED))}. They apply to recordings, not to tables."


def layout() -> html.Div:
    """The choice of a table, its columns, and how recordings are read."""
    choose = html.Button("Choose a table", type="button", **{"data-choose": "table"})
    words = html.Label(["Read recordings as ", dcc.Input(id="read-as", type="text", value="", size="28")])
    return html.Div(
        [
            html.H2("Import"),
            html.P(_TEXT, className="soft"),
            html.Div([choose, html.Span("", id="table-says", role="status")], className="row"),
            html.Div(id="mapping"),
            html.H2("Recordings in other units"),
            html.Div([words, button("Read again", "read-again")], className="row"),
            html.P(_READ, className="soft"),
            dcc.Store(id="table-uploaded"), dcc.Store(id="mapping-of"),
        ],
        id="panel-import", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("mapping", "children"), Output("mapping-of", "data")],
                [revision(), State("mapping-of", "data")], render)  # fmt: skip
    panels.act([Input("table-uploaded", "data")], _uploaded)
    every = {"type": "map", "signal": ALL, "key": ALL}
    panels.act([Input({"type": "import-table", "index": ALL}, "n_clicks"), State(every, "value"), State(every, "id")],
               _import)  # fmt: skip
    panels.act([Input("read-again", "n_clicks"), State("read-as", "value")], _read_again)


def render(desk: Desk, _revision: int, drawn: str | None) -> tuple[Any, str]:
    """The form of the table that is mapped; redrawn for another table only, so that nothing chosen is lost."""
    one = desk.mapping
    now = one.map if one else ""
    if now == (drawn or ""):
        raise PreventUpdate
    return (_form(one) if one else None), now


def _form(one: Mapped) -> html.Div:
    known = [html.Li(text) for text in one.guess["open"]]
    head = html.Thead(html.Tr([html.Th(word, scope="col") for word in ("signal", "column", "unit", "", "offset", "")]))
    body = [_time(one), *(_row(one, signal) for signal in SIGNALS)]
    motion = dcc.RadioItems(list(MOTIONS), one.content.get("motion", "free"), inline=True,
                            id={"type": "map", "signal": "motion", "key": "motion"})  # fmt: skip
    return html.Div(
        [
            html.H3(f"Columns of {one.table.rpartition('/')[2]}"),
            html.Ul(known, className="notes") if known else None,
            html.Div(html.Table([head, html.Tbody(body)]), className="wide mapping"),
            html.Div([choice("Motion", motion), button("Import this table", {"type": "import-table", "index": 0},
                                                       main=True)], className="row"),
            html.P(_RULE, className="soft"),
        ]
    )  # fmt: skip


def _time(one: Mapped) -> html.Tr:
    """The column of time, or the rate of the rows."""
    time = one.content.get("time") or {}
    if isinstance(time, str):
        time = {"column": time}
    units = [name for name, unit in UNITS.items() if unit.dimension == "time"]
    column = _pick("time", "column", one.columns, time.get("column"), "column of the time")
    unit = _pick("time", "unit", units, time.get("unit"), "unit of the time")
    rate = _field("time", "rate", time.get("rate", ""), "rows a second, where no column is the time")
    return html.Tr([html.Th("time", scope="row"), html.Td(column), html.Td(unit), html.Td("or rows a second"),
                    html.Td(rate), html.Td()])  # fmt: skip


def _row(one: Mapped, signal: str) -> html.Tr:
    known, given = SIGNALS[signal], (one.content.get("signals") or {}).get(signal, {})
    units = [name for name, unit in UNITS.items() if unit.dimension in known.dimensions]
    turned = dcc.Checklist(["reversed"], ["reversed"] if given.get("sign", 1) == -1 else [],
                           id={"type": "map", "signal": signal, "key": "reversed"})  # fmt: skip
    gauge = dcc.Checklist(["gauge"], ["gauge"] if given.get("gauge") else [],
                          id={"type": "map", "signal": signal, "key": "gauge"})  # fmt: skip
    cells = [
        _pick(signal, "column", one.columns, given.get("column"), f"column of the {known.words}"),
        _pick(signal, "unit", units, given.get("unit"), f"unit of the {known.words}"),
        turned,
        _field(signal, "offset", given.get("offset", 0), f"offset of the {known.words}"),
        gauge if "pressure" in known.dimensions else None,
    ]
    return html.Tr([html.Th(known.words, scope="row"), *(html.Td(cell) for cell in cells)])


def _pick(signal: str, key: str, options: list[str], value: str | None, name: str) -> html.Label:
    identifier = {"type": "map", "signal": signal, "key": key}
    drop = dcc.Dropdown(options=options, value=value, id=identifier, placeholder="none" if key == "column" else "unit")
    return html.Label([html.Span(name, className="hidden-words"), drop])


def _field(signal: str, key: str, value: Any, name: str) -> html.Label:
    field = dcc.Input(type="text", value=str(value), id={"type": "map", "signal": signal, "key": key}, size="6")
    return html.Label([html.Span(name, className="hidden-words"), field])


def _uploaded(desk: Desk, what: dict[str, Any] | None) -> None:
    if what:
        desk.guess(f"uploads/{TABLES}/{str(what['name']).rpartition('/')[2]}")


def _import(desk: Desk, clicks: list[int | None], values: list[Any], names: list[dict[str, str]]) -> None:
    """Start importing with what the form says."""
    if not asked(clicks) or desk.mapping is None:
        return
    form = {(one["signal"], one["key"]): value for value, one in zip(values, names, strict=True)}
    rows = {signal: row_of(form, signal) for signal in SIGNALS}
    rate, column = str(form["time", "rate"] or "").strip(), form["time", "column"]
    if rate and column:
        raise UsageError("the time is either a column or the rows a second; clear one of them")
    timing = {"rate": rate} if rate else {"column": column, "unit": form["time", "unit"]}
    desk.import_table({key: value for key, value in timing.items() if value}, rows, form["motion", "motion"])


def row_of(form: dict[tuple[str, str], Any], signal: str) -> dict[str, Any]:
    """The entry of a signal in the map."""
    row = {key: form.get((signal, key)) for key in KEYS}
    gauge = {"gauge": "gauge" in row["gauge"]} if row["gauge"] is not None else {}
    sign = -1 if "reversed" in (row["reversed"] or []) else 1
    return {"column": row["column"], "unit": row["unit"], "sign": sign, "offset": row["offset"] or 0} | gauge


def _read_again(desk: Desk, clicks: int | None, words: str | None) -> None:
    if asked(clicks):
        desk.shelf.read_as(words or "")
