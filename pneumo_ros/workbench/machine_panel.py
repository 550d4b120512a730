"""The machine: its variants, the actions on it, and its effects as check boxes."""

from itertools import chain, groupby
from typing import Any

from dash import ALL, Output, State, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.compare.wording import number
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.catalogue import body, catalogue, helpers, room, summary
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.library import FRAME
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.parts import Panels, choice, pressed, revision


def layout() -> html.Section:
    """Variants and effects."""
    return html.Section(
        [
            html.H2("Machine", id="machine-title"),
            html.Div(id="variants"),
            html.H3("Effects"),
            html.Label(
                ["Search ", dcc.Input(id="search", type="search", value="", placeholder="leak, valve, F_c ...")]
            ),
            dcc.Store(id="effects-of"),
            html.Div(id="effects", className="effects", role="group", **{"aria-label": "Effects of the machine"}),
        ],
        className="card",
        **{"aria-labelledby": "machine-title"},
    )


def register(panels: Panels) -> None:
    """Callbacks of this panel."""
    panels.show([Output("variants", "children")], [revision()], _variants)
    panels.show([Output("effects", "children"), Output("effects-of", "data")],
                [revision(), State("effects-of", "data"), State({"type": "effect", "name": ALL}, "value")],
                render)  # fmt: skip
    panels.press("variant", _choose)
    panels.press("effect", _tick)


def _variants(desk: Desk, _revision: int) -> list[Any]:
    options = [{"label": f"{v.number}: {v.label}", "value": v.number} for v in desk.variants]
    radio = choice("Variants", dcc.RadioItems(options, desk.current, id={"type": "variant", "index": 0}))
    return [html.Div(radio, **pressed("variant", None)) if len(options) > 1 else None]


def render(desk: Desk, _revision: int, shown: int | None, ticks: list[list[str]]) -> tuple[Any, int]:
    """The effects room by room; redrawn for another variant, and where the page's ticks are not those of the desk."""
    model = desk.model()
    effects = _listed(model)
    if shown == desk.chosen and {*chain(*ticks)} == desk.ticked & {effect.name for effect in effects}:
        raise PreventUpdate
    rooms = [
        html.Div([html.H3(name.capitalize()), *(_effect(desk, model, one) for one in inner)])
        for name, inner in groupby(effects, key=room)
    ]
    return rooms, desk.chosen


def _listed(model: Model) -> list[type[Effect]]:
    return [effect for effect in catalogue(model).values() if effect.name not in FRAME]


def _effect(desk: Desk, model: Model, effect: type[Effect]) -> html.Div:
    name, ticked = effect.name, effect.name in desk.ticked
    words = name.replace("_", " ")
    box = dcc.Checklist(
        [{"label": words, "value": name}], [name] if ticked else [], id={"type": "effect", "name": name}
    )
    more = [
        html.P(summary(effect)),
        *(html.Pre(html.Code(body(effect, inner))) for inner in ("equations", "advance") if inner in effect.functions),
        *(html.Pre(html.Code(one)) for one in helpers(effect).values()),
        _parameters(model, effect),
        html.P(f"Source: {effect.source}", className="soft") if effect.source else None,
    ]
    inner = html.Details(
        [html.Summary(["Equation", html.Span(f" and parameters of {words}", className="hidden-words")]), *more]
    )
    sign = html.P(effect.signature, className="sign") if effect.signature else None
    found = " ".join((words, effect.signature, effect.remedy, effect.__doc__ or "", room(effect), *(
        one.meaning for one in effect.parameters.values()))).lower()  # fmt: skip
    return html.Div([html.Div(box, **pressed("effect", name)), sign, inner],
                    className=f"effect{' extra' * (name not in model.effects)}", **{"data-words": found})  # fmt: skip


def _parameters(model: Model, effect: type[Effect]) -> Any:
    if not effect.parameters:
        return html.P("No parameter.")
    rows = [
        html.Tr([
            html.Th(name.replace("_", " "), scope="row", title=one.meaning),
            html.Td(number(model.parameters.get(f"{effect.name}.{name}", one.default), 4), className="number"),
            html.Td(one.unit), html.Td(one.range_text()),
        ])
        for name, one in effect.parameters.items()
    ]  # fmt: skip
    head = html.Thead(html.Tr([html.Th(word, scope="col") for word in ("parameter", "value", "unit", "allowed")]))
    return html.Div(html.Table([head, html.Tbody(rows)]), className="wide")


def _choose(desk: Desk, _of: Any, chosen: Any) -> None:
    if not 0 <= int(chosen) < len(desk.variants):
        raise UsageError(f"there is no variant {chosen}")
    desk.choose(int(chosen))


def _tick(desk: Desk, name: Any, on: Any) -> None:
    if name not in [effect.name for effect in _listed(desk.model())]:
        raise UsageError(f"there is no effect {str(name)[:80]!r}")
    with desk.lock:
        desk.ticked = desk.ticked | {name} if on else desk.ticked - {name}
        desk.changed()  # the next step depends on it
