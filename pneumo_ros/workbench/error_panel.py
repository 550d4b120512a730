"""The error step by step, from the machine as given to the noise floor, and two variants side by side."""

from typing import Any

from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.compare.wording import SIGNALS, amount, number, times
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Html, tag
from pneumo_ros.wording.errors import steps as named_steps
from pneumo_ros.wording.naming import change
from pneumo_ros.workbench.desk import Desk, commands
from pneumo_ros.workbench.parts import Panels, drop_down, revision, table
from pneumo_ros.workbench.shown import content
from pneumo_ros.workbench.variant import Compared, Variant, typical_error

_EMPTY = "Press Compare, then tick an effect and press Refit to see whether the error falls."


def layout() -> html.Div:
    """A place for the waterfall, and for two variants."""
    pick = html.Div(
        [drop_down("Variant", "first", clearable=False), drop_down("beside", "second", clearable=False)],
        className="row",
    )
    return html.Div(
        [
            html.Div(id="error-content", className="content"),
            html.H2("Two variants"), pick, html.Div(id="pair"),
            dcc.Store(id="error"), dcc.Store(id="error-shown"),
        ],
        id="panel-error", className="card panel", hidden=True,
    )  # fmt: skip


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("error", "data")], [revision()], render)
    panels.show([Output(name, key) for name in ("first", "second") for key in ("options", "value")], [revision()],
                _choices)  # fmt: skip
    panels.show([Output("pair", "children")], [revision(), Input("first", "value"), Input("second", "value")], _pair)
    panels.app.clientside_callback(
        ClientsideFunction("bench", "show"), Output("error-shown", "data"), Input("error", "data")
    )


def judged_by(desk: Desk) -> tuple[list[str], str]:
    """The recordings whose errors are shown, held-out ones or else all in use, and words for them."""
    held = [bag.name for bag in desk.shelf.bags if bag.role == "hold" and not bag.problem]
    used = [bag.name for bag in desk.shelf.bags if bag.role != "out" and not bag.problem]
    return (held, "held out, never fitted") if held else (used, "that were fitted too")


def course(desk: Desk) -> list[tuple[str, float]]:
    """(name, error in noise floors) from the machine as given to the current one; only compared steps."""
    bags, steps = judged_by(desk)[0], list[tuple[str, float]]()
    for variant in desk.lineage():
        before = variant.made_by().get("course", [])
        steps += [(one["model"], one.get("error", one.get("holdout_error"))) for one in before[bool(steps) : -1]]
        error = typical_error(variant.compared, bags) if variant.compared else None
        if error is not None:
            steps.append((_label(variant), error))
    return steps


def _label(variant: Variant) -> str:
    return variant.label if variant.number < 2 else f"{variant.label} ({variant.number})"


def render(desk: Desk, _revision: int) -> list[Any]:
    """The waterfall of the current machine."""
    from pneumo_ros.report.waterfall import waterfall_chart

    steps = course(desk)
    if not steps:
        return [content("error-content", [Section("", "Error step by step", tag("p", _EMPTY))], 0)]
    bags, what = judged_by(desk)
    text = (
        f"Predictions over windows of 1 s that start from an estimated state, on {len(bags)} "
        f"recording{'s' if len(bags) != 1 else ''} {what}. Shown is the error of a typical window in sensor noise; "
        "1 x is the noise floor."
    )
    chart = waterfall_chart(named_steps(steps))
    section = Section("step-by-step", "Error step by step", Html(tag("p", text, class_="soft")), charts=(chart,))
    return [content("error-content", [section], f"{desk.current} {steps}")]


def _choices(desk: Desk, _revision: int) -> tuple[Any, ...]:
    options = [{"label": f"{v.number}: {v.label}", "value": v.number} for v in desk.variants if v.compared]
    numbers = [one["value"] for one in options]
    first = next((v.number for v in desk.lineage() if v.number in numbers), None)
    return options, first, options, desk.current if desk.current in numbers else None


def _pair(desk: Desk, _revision: int, first: int | None, second: int | None) -> list[Any]:
    """Errors by signal, parameters that differ, and the command lines that make the second from the first."""
    pair = [desk.variants[k] for k in (first, second) if k is not None and k < len(desk.variants)]
    if len(pair) < 2 or pair[0] is pair[1] or not (pair[0].compared and pair[1].compared):
        return [html.P("Compare two variants first, then choose them here.", className="soft")]
    heads = [f"{v.number}: {v.label}" for v in pair]
    errors = table(("", *heads, "change", "noise"), _errors(desk, pair[0].compared, pair[1].compared), "Error over 1 s")
    moved = table(("", *heads, "unit"), _parameters(desk, pair), "Parameters that differ")
    return [html.Div([errors, moved, html.Pre(commands(desk.lineage(pair[1].number)), className="commands")])]


def _errors(desk: Desk, first: Compared, second: Compared) -> list[tuple[str, ...]]:
    bags, rows = judged_by(desk)[0], list[tuple[str, ...]]()
    totals = [typical_error(one, bags) for one in (first, second)]
    if None not in totals:
        a, b = (float(one or 0.0) for one in totals)
        rows.append(("typical window", times(a), times(b), change(a, b), "1 x"))
    for name in SIGNALS:
        found = [_rms(one, name, bags) for one in (first, second)]
        if None in found:
            continue
        (a, noise), (b, _) = (one or (0.0, 0.0) for one in found)
        rows.append((SIGNALS[name][0], amount(a, name), amount(b, name), change(a, b), amount(noise, name)))
    return rows


def _rms(compared: Compared, name: str, bags: list[str]) -> tuple[float, float] | None:
    """Error and noise of a signal, root mean square over recordings."""
    runs = zip(compared.bags, compared.result["runs"], strict=True)
    found = [run["error"][name] for bag, run in runs if bag in bags and name in run["error"]]
    if not found:
        return None
    rms, noise = ((sum(one[key] ** 2 for one in found) / len(found)) ** 0.5 for key in ("rms", "noise"))
    return rms, noise


def _parameters(desk: Desk, pair: list[Variant]) -> list[tuple[str, ...]]:
    models = [desk.model(v.number) for v in pair]
    names = dict.fromkeys(name for model in models for name in model.parameters)
    rows = []
    for name in names:
        values = [model.parameters.get(name) for model in models]
        if values[0] != values[1]:
            unit = next(model.specification(name).unit for model in models if name in model.parameters)
            rows.append((name, *(number(value, 5) for value in values), unit))
    return rows
