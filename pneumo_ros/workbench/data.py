"""What the page's script asks for, as JSON: charts during a zoom or a slide, the job, the live axis, presses."""

import math
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

from flask import Flask, Response, jsonify, request

from pneumo_ros.errors import PneumoError, UsageError
from pneumo_ros.units import writing
from pneumo_ros.workbench.bags import Bag
from pneumo_ros.workbench.columns import columns
from pneumo_ros.workbench.curves import Rig
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.desks import Desks
from pneumo_ros.workbench.job_panel import status_of
from pneumo_ros.workbench.live_panel import live_of
from pneumo_ros.workbench.response_chart import response_chart
from pneumo_ros.workbench.signals import Source, View, readings, signals_chart
from pneumo_ros.workbench.thin import Span
from pneumo_ros.workbench.variant import Variant

_LONGEST = 100_000  # bytes of a request


def answer_page(server: Flask, desks: Desks, presses: Mapping[str, Callable[[Desk, Any, Any], None]]) -> None:
    """POST /signals/DESK and the others take a JSON object and return one; status 400 says what is wrong.

    `presses`: name of a control -> what a press of it does.
    """

    def answering(make: Callable[[Desk, Mapping[str, Any]], Any]) -> Callable[[str], Response]:
        def answer(desk: str) -> Response:
            asked = request.get_json(silent=True) if (request.content_length or 0) < _LONGEST else None
            if not isinstance(asked, dict):
                return Response("the request is not a JSON object", 400)
            try:
                found = desks.of(f"/b/{desk}")
                with writing(found.coordinate):
                    return jsonify(make(found, asked))
            except KeyError:
                return Response("there is no such desk; open the page again", 404)
            except (PneumoError, TypeError, ValueError) as problem:
                return Response(str(problem), 400)

        return answer

    answers: dict[str, Callable[[Desk, Mapping[str, Any]], Any]]
    answers = {"signals": signals_of, "response": response_chart, "status": status_of, "live": live_of,
               "press": partial(pressed, presses)}  # fmt: skip
    for name, make in answers.items():
        server.add_url_rule(f"/{name}/<desk>", name, answering(make), methods=["POST"])


def pressed(
    presses: Mapping[str, Callable[[Desk, Any, Any], None]], desk: Desk, asked: Mapping[str, Any]
) -> dict[str, int]:
    """Do what a press asks for; `asked` has what, of and value. The desk says what is wrong."""
    do = presses.get(str(asked.get("what")))
    if do is None:
        raise UsageError(f"there is nothing to press that is called {str(asked.get('what'))[:80]!r}")
    try:
        do(desk, asked.get("of"), asked.get("value"))
    except PneumoError as problem:
        desk.say(problem)
    return {"revision": desk.revision}


def signals_of(desk: Desk, asked: Mapping[str, Any]) -> dict[str, Any] | None:
    """The chart of a run, None without recordings. `asked` has run, also, span, shown, over, regime, other, marks."""
    bag = desk.shelf.bag(asked.get("run"))
    if bag is None:
        return None
    view = view_of(asked)
    wanted = {*view.shown, view.over}
    chosen = (desk.shelf.bag(str(name)) for name in asked.get("also") or ())
    others = [source_of(desk, one, wanted) for one in chosen if one is not None and one.name != bag.name]
    return signals_chart(source_of(desk, bag, wanted), view, variants_of(desk, asked.get("other")), others)


def source_of(desk: Desk, bag: Bag, wanted: Collection[str]) -> Source:
    """A recording to plot; topics are read only where one of their columns, which begin with a slash, is wanted."""
    recording, values = desk.shelf.recording(bag), desk.model().parameters
    found = columns(desk.shelf.path(bag), recording) if any(name.startswith("/") for name in wanted) else {}
    atmosphere = values.get("air.atmospheric_pressure", desk.shelf.atmosphere)
    return Source(
        bag, recording, found, Rig(values.get("piston.area_a", 0.0), values.get("piston.area_b", 0.0), atmosphere)
    )


def cursors_of(desk: Desk, asked: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of the cursors; see `signals.readings`."""
    bag = desk.shelf.bag(asked.get("run"))
    if bag is None or not asked.get("marks"):
        return []
    return readings(bag, desk.shelf.recording(bag), view_of(asked), variants_of(desk, asked.get("other")))


def view_of(asked: Mapping[str, Any]) -> View:
    """The view that is requested; ValueError for texts that are not numbers."""
    marks = {str(name): number(x) for name, x in (asked.get("marks") or {}).items()}
    return View([str(name) for name in asked.get("shown") or ()], span_of(asked), str(asked.get("regime") or ""), marks,
                str(asked.get("over") or ""))  # fmt: skip


def span_of(asked: Mapping[str, Any]) -> Span | None:
    """The seconds in view; ValueError for texts that are not numbers."""
    span = asked.get("span")
    return (number(span[0]), number(span[1])) if span else None


def number(value: Any) -> float:
    """A finite number; UsageError if it is not finite."""
    found = float(value)
    if not math.isfinite(found):
        raise UsageError("the request has a number that is not finite")
    return found


def variants_of(desk: Desk, other: Any) -> dict[str, Variant]:
    """The current machine and the one beside it, by the role of their colour."""
    found = {"model": desk.variant}
    if isinstance(other, int) and other != desk.current and 0 <= other < len(desk.variants):
        found["second"] = desk.variants[other]
    return found
