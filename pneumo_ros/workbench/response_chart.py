"""The chart behind the sliders: measured, the current machine, and the same machine with the sliders' values."""

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from pneumo_ros.compare.wording import SIGNALS, number
from pneumo_ros.plant import Model
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.thin import Span, in_view, packed

_ROOM = 600  # pixels
_TITLES = {"measured": "measured", "second": "current machine", "model": "with the sliders"}


def values_of(model: Model, stops: Mapping[str, Any]) -> dict[str, float]:
    """Values of the parameters whose sliders were moved, from the stops of the sliders."""
    from pneumo_ros.workbench.response import slid

    own = {name: int(stop) for name, stop in stops.items() if name in model.parameters and int(stop)}
    return {name: slid(model[name], stop, model.specification(name)) for name, stop in own.items()}


def value_text(model: Model, name: str) -> str:
    """A parameter with its unit: '80 N'."""
    return f"{number(model[name], 4)} {model.specification(name).unit}".removesuffix(" 1")


def response_chart(desk: Desk, asked: Mapping[str, Any]) -> dict[str, Any] | None:
    """The chart and `values`, parameter -> text; None without recordings. `asked` has run, span, stops and names.

    Raises NumericalError when the machine diverges, UsageError for a value out of range.
    """
    bag = desk.shelf.bag(asked.get("run"))
    if bag is None:
        return None
    from pneumo_ros.runs.inputs import measuring
    from pneumo_ros.workbench.response import respond

    base = desk.model()
    model = base.with_parameters(values_of(base, asked.get("stops") or {}))
    span = asked.get("span") or (0.0, 1e9)
    part, before = _begun(desk, desk.chosen, bag.name, (float(span[0]), float(span[1])))
    after, panels = respond(measuring(model, [part.run]), part), []
    inside = slice(part.first + 1, part.first + part.samples + 1)
    for signal, values in after.items():
        words, unit, factor = SIGNALS[signal]
        curves = {"measured": part.run.signals[signal][inside], "second": before[signal], "model": values}
        traces = [_trace(role, part.time, factor * curve) for role, curve in curves.items()]
        panels.append({"title": f"{words} [{unit}]", "share": 1, "ticks": [], "traces": traces})
    ends = [float(part.time[0]), float(part.time[-1])]
    texts = {name: value_text(model, name) for name in asked.get("names") or () if name in model.parameters}
    return {"title": bag.name, "x": "time [s]", "link": "response", "span": ends, "logX": False, "legend": True,
            "panels": panels, "height": 90 + 150 * len(panels), "values": texts}  # fmt: skip


def _trace(role: str, time: Any, values: Any) -> dict[str, Any]:
    x, y = in_view(time, values, None, _ROOM)
    return {"name": _TITLES[role], "role": role, "kind": "line", "hidden": False, "x": packed(x), "y": packed(y)}


@lru_cache(8)
def _begun(desk: Desk, _chosen: int, name: str, span: Span) -> Any:
    """The stretch with its start, and the response of the current machine."""
    from pneumo_ros.reading.read import run_of
    from pneumo_ros.runs.inputs import measuring
    from pneumo_ros.workbench.response import respond, stretch

    bag = desk.shelf.bag(name)
    assert bag is not None
    run, _ = run_of(desk.shelf.recording(bag), desk.model(), mechanics=True)
    model = measuring(desk.model(), [run])  # with what the recording measured in place of constants
    part = stretch(model, run, *span)
    return part, respond(model, part)
