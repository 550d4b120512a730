"""What the panels share: callbacks on the desk of their tab, and controls with names."""

import json
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

from dash import Dash, Input, Output, State, dcc, html
from dash.exceptions import PreventUpdate

from pneumo_ros.errors import PneumoError
from pneumo_ros.units import writing
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.desks import Desks

WHERE = State("url", "pathname")
ACTED = Output("acted", "data", allow_duplicate=True)  # makes the page look at the desk


class Panels:
    """Callbacks of all panels: each gets the desk of its tab first, then its inputs and states."""

    def __init__(self, app: Dash, desks: Desks) -> None:
        self.app, self.desks = app, desks
        self.presses: dict[str, Callable[[Desk, Any, Any], None]] = {}

    def show(
        self, outputs: Sequence[Output], inputs: Sequence[Any], render: Callable[..., Any], *, first: bool = True
    ) -> None:
        """`render(desk, *inputs)` gives the outputs when an input changes, and at the start if `first`."""

        def drawn(desk: Desk, *values: Any) -> Any:
            try:
                return render(desk, *values)
            except PneumoError as problem:  # for example, a file was deleted
                if desk.message != str(problem):
                    desk.say(problem)
                raise PreventUpdate from problem

        self.app.callback(list(outputs), list(inputs), WHERE, prevent_initial_call=not first)(self._on_desk(drawn))

    def act(self, inputs: Sequence[Any], do: Callable[..., None]) -> None:
        """`do(desk, *inputs)` changes the desk when an input changes; the page shows errors."""

        def change(desk: Desk, *values: Any) -> int:
            before = desk.revision
            try:
                do(desk, *values)
            except PneumoError as problem:
                desk.say(problem)
            if desk.revision == before:
                raise PreventUpdate  # a redrawn control triggers it, too
            return desk.revision

        self.app.callback(ACTED, list(inputs), WHERE, prevent_initial_call=True)(self._on_desk(change))

    def press(self, what: str, do: Callable[[Desk, Any, Any], None]) -> None:
        """`do(desk, of, value)` when a control inside `pressed(what, of, ...)` is pressed; the page shows errors.

        For controls of lists that the desk redraws. A callback on them would start again with the redrawn values while
        it waits: a press would be lost, and what is redrawn would be taken for one.
        """
        self.presses[what] = do

    def _on_desk(self, function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def found(*values: Any) -> Any:
            try:
                desk = self.desks.of(values[-1])
            except KeyError:
                raise PreventUpdate from None
            with writing(desk.coordinate):
                return function(desk, *values[:-1])

        return found


def revision() -> Input:
    """The input of every panel that shows the desk."""
    return Input("revision", "data")


def button(text: str, identifier: Any, *, main: bool = False, **more: Any) -> html.Button:
    """A button."""
    return html.Button(text, id=identifier, type="button", className="main" if main else "", **more)


def pressed(what: str, of: Any) -> dict[str, str]:
    """Attributes of a button, or of what holds check boxes or radio buttons: each press is sent, with `of`."""
    return {"data-press": what, "data-of": json.dumps(of)}


def choice(legend: str, control: Any, *, visible: bool = True) -> html.Fieldset:
    """Radio buttons or check boxes with the name of the group."""
    words = html.Legend(legend, className="" if visible else "hidden-words")
    return html.Fieldset([words, control], className="row choices" if visible else "choices")


def drop_down(label: str, identifier: str, **more: Any) -> html.Label:
    """A drop-down list with its name."""
    return html.Label([f"{label} ", html.Span(dcc.Dropdown(id=identifier, **more), className="drop-down")])


def table(head: Sequence[str], rows: Sequence[Sequence[Any]], caption: str) -> html.Div:
    """A table whose first column names its rows; the others are numbers."""
    top = html.Thead(
        html.Tr([html.Th(cell, scope="col", className="number" if k else "") for k, cell in enumerate(head)])
    )
    body = [
        html.Tr([html.Th(row[0], scope="row"), *(html.Td(cell, className="number") for cell in row[1:])])
        for row in rows
    ]
    inner = html.Table([html.Caption(caption), top, html.Tbody(body)])
    return html.Div(inner, className="wide", role="region", tabIndex=0, **{"aria-label": caption})


def asked(clicks: Sequence[int | None] | int | None) -> bool:
    """Whether a button was pressed, rather than redrawn."""
    return any(clicks) if isinstance(clicks, (list, tuple)) else bool(clicks)
