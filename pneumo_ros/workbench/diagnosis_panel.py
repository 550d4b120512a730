"""What a diagnosis found: verdict, candidates with evidence, what is not told apart, what remains, what to record."""

from typing import Any

import numpy as np
from dash import ClientsideFunction, Input, Output, dcc, html

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES, amount, number, percent, times
from pneumo_ros.report.chart import Chart, Panel, Section, Trace
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.naming import effect_words, interval, listed, sentence
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, revision
from pneumo_ros.workbench.shown import content

_EMPTY = "Press Diagnose: every effect of the catalogue is tried on what the refitted machine leaves unexplained."
_VERDICTS = {
    "adequate": "Nothing is missing: with its parameters refitted, the machine explains these recordings.",
    "effects_found": "Something was missing, and it was found.",
    "unknown_effect": "Something is at work that no effect of the catalogue explains.",
}


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
    """The last diagnosis on the way to the machine at hand."""
    found = [v for v in desk.lineage() if "candidates" in v.made_by()]
    if not found:
        return [content("diagnosis-content", [Section("", "Diagnosis", tag("p", _EMPTY))], 0)]
    return [content("diagnosis-content", sections(found[-1].made_by()), str(found[-1].result))]


def sections(result: dict[str, Any]) -> list[Section]:
    """Answer, evidence and remainder; `result` is the JSON of `pneumo diagnose`."""
    return [_answer(result), _evidence(result), _remains(result)]


def _answer(result: dict[str, Any]) -> Section:
    steps = "; ".join(f"{one['model']} {times(one['holdout_error'])}" for one in result["course"])
    parts = [
        tag("p", _VERDICTS[result["verdict"]], class_=f"verdict {_TONES[result['verdict']]}"),
        tag("p", f"Failing after the refit alone: {listed(result['failing'])}. Held-out error over noise: {steps}."),
        *(_addition(one) for one in result["added"]),
    ]
    if result["suggested_experiment"]:
        parts.append(tag("p", tag("strong", "What to record next: "), result["suggested_experiment"]))
    return Section("diagnosis-answer", "Diagnosis", Html("".join(parts)))


_TONES = {"adequate": "good", "effects_found": "found", "unknown_effect": "unknown"}


def _addition(one: dict[str, Any]) -> Html:
    rows: list[tuple[Content, ...]] = []
    for key, value in one["parameters"].items():
        std = float("inf") if value["std"] is None else value["std"]
        rows.append((tag("code", key), number(value["value"], 5), interval(value["value"], std), value["unit"]))
    told = table(
        ("parameter", "value", "95 % interval", "unit"), rows, f"+ {effect_words(one['effect'])}", numeric=(1, 2)
    )
    rivals = [effect_words(name) for name in one["indistinguishable_from"]]
    if not rivals:
        return told
    words = f" These recordings cannot tell it from {listed(rivals, 'or')}: any of them explains as much."
    return Html(told + tag("p", tag("span", "not alone", class_="chip rival"), words))


def _evidence(result: dict[str, Any]) -> Section:
    from pneumo_ros.diagnose.outcome import Ranked
    from pneumo_ros.report.candidate_charts import candidate_charts

    found = result["candidates"]
    if not found:
        return Section("diagnosis-evidence", "Evidence", tag("p", "No candidate was tried."))
    keys = ("effect", "score", "holdout_gain", "equation", "size", "objections", "holdout_error")
    ranking = [Ranked(**{key: one[key] for key in keys}) for one in found]
    states = ["added" if one["added"] else "rival" if one["rival_of"] else "refused" for one in found]
    rows = [_row(one, state) for one, state in zip(found, states, strict=True)]
    head = ("effect", "t", "held-out gain", "size / usual", "verdict")
    body = table(head, rows, "Candidates: what was added first, then by t", numeric=(1, 2, 3))
    return Section("diagnosis-evidence", "Evidence", body, charts=candidate_charts(ranking, states), columns=2)


def _row(one: dict[str, Any], state: str) -> tuple[Content, ...]:
    said = (
        {
            "added": "no other explains as much",
            "rival": f"would explain as much in place of {listed([effect_words(n) for n in one['rival_of']])}",
        }.get(state)
        or "; ".join(one["objections"])
        or "another one explains more"
    )
    chip = tag("span", {"rival": "not told apart"}.get(state, state), class_=f"chip {state}")
    gain = f"{100.0 * one['holdout_gain']:.1f} %"
    return effect_words(one["effect"]), number(one["t"]), gain, number(one["size"]), tag("div", chip, " ", said)


def _remains(result: dict[str, Any]) -> Section:
    left, title = result["unexplained"], "What remains"
    if left is None:
        return Section("diagnosis-remains", title, tag("p", "Nothing of size remains unexplained in any equation."))
    words, variable = EQUATIONS[left["equation"]][0], VARIABLES[left["against"]][0]
    share = percent(left["explained_share"])
    size = amount(left["residual_rms"], left["equation"])
    text = f"{sentence(words)} leaves {size} rms; {share} of it follows {variable}."
    chart = _shape(left)
    return Section("diagnosis-remains", title, tag("p", text), charts=(chart,) if left["shape"] else ())


def _shape(left: dict[str, Any]) -> Chart:
    """The unknown shape over the variable it follows best."""
    words, unit, factor = EQUATIONS[left["equation"]]
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
    title = f"Unexplained in {words}, over {variable}"
    return Chart("diagnosis-shape", title, "", f"{variable} [{x_unit}]", (Panel(f"residual [{unit}]", traces),))
