"""The report of `pneumo commission`: its sections, from the verb's JSON."""

import math
from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.wording import number
from pneumo_ros.report.chart import Report, Section
from pneumo_ros.report.machine import machine_section
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.origin import origin_section
from pneumo_ros.wording.commissioning import another_minute, times, value_and_interval
from pneumo_ros.wording.naming import listed

if TYPE_CHECKING:
    from pneumo_ros.plant import Model


def commissioning_report(result: dict[str, Any], model: "Model", origin: dict[str, Any]) -> Report:
    """The whole page of a commissioning; `model` is the machine that was found."""
    error, lacking = result["error_over_noise"], result["undetermined"]
    verdict = (
        f"Over 1 s the position is predicted to {times(error['after'])} its noise; with the data sheets' "
        f"machine it was {times(error['before'])}. "
        + (f"Not determined: {listed(lacking)}." if lacking else "Every parameter is determined.")
    )
    return Report(
        title=f"'{model.name}' commissioned in {result['seconds']:.0f} s of moves",
        verdict=verdict,
        good=(error["after"] or math.inf) < (error["before"] or math.inf),
        sections=(*found_sections(result), machine_section(model, None), origin_section(origin)),
        result=result,
    )  # fmt: skip


def found_sections(result: dict[str, Any]) -> tuple[Section, ...]:
    """Wiring, and where the commissioning went on after it, parameters and moves."""
    wiring = _wiring(result["wiring"])
    return (wiring, _parameters(result["parameters"]), _moves(result)) if "moves" in result else (wiring,)


def _wiring(wiring: dict[str, Any]) -> Section:
    words = ", ".join(wiring["read_as"]) or "SI units, absolute pressures, nothing swapped or reversed"
    parts = [tag("p", f"Recorded as: {words}.")]
    if wiring["swap"]:
        parts.append(tag("ul", [tag("li", f"{word}: {how}") for word, how in wiring["swap"].items()]))
    return Section("wiring", "Wiring", Html("".join(parts)))


def _parameters(found: dict[str, Any]) -> Section:
    rows: list[tuple[Content, ...]] = []
    for name, one in found.items():
        sheet = f"{number(one['before'], 4)} ± {number(one['prior'], 2)}"
        rows.append((name, sheet, *value_and_interval(one, "not determined"), one["unit"]))
    head = ("parameter", "data sheet", "found", "95 % interval", "unit")
    return Section("parameters-found", "Found", table(head, rows, "Parameters that were uncertain", numeric=(1, 2)))


def _moves(result: dict[str, Any]) -> Section:
    rows: list[tuple[Content, ...]] = []
    for move in result["moves"]:
        ratio = move["deviations_over_predicted"]
        told = "-" if ratio is None else number(ratio, 2)
        rows.append((move["name"], f"{move['seconds']:.0f}", str(len(move["recordings"])), told))
    head = ("move", "seconds", "recordings", "deviations over predicted ones")
    body = table(head, rows, "Moves, in their order", numeric=(1, 2, 3)) + tag("p", another_minute(result))
    return Section("moves", "Moves", Html(body))
