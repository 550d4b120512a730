"""The report of `pneumo identify`: its sections, from the verb's JSON."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.wording import number
from pneumo_ros.report.chart import Report, Section
from pneumo_ros.report.machine import machine_section
from pneumo_ros.report.markup import Content, Html, table, tag, worded
from pneumo_ros.report.origin import origin_section
from pneumo_ros.report.static_map import before_after_chart, static_map_section
from pneumo_ros.report.summary import what_next
from pneumo_ros.wording.identification import found_table, next_sentence, sentences

if TYPE_CHECKING:
    from pneumo_ros.plant import Model


def identification_report(result: dict[str, Any], model: "Model", origin: dict[str, Any], then: str = "") -> Report:
    """The whole page of an identification; model: the identified one, then: the command line that follows, or ""."""
    unknown = result["undetermined"]
    fits = result["map"]["fits"]
    verdict = "Everything asked for is determined." if not unknown else f"Not determined: {', '.join(unknown)}."
    if not fits:
        verdict += " The static map does not fit."
    return Report(
        title=f"Friction of '{result['model']}' identified from {len(result['runs'])} runs",
        verdict=verdict,
        good=fits and not unknown,
        sections=(
            summary_section(result, then),
            found_section(result),
            *(() if result["motion"] else (static_map_section(result), windows_section(result))),
            machine_section(model, None),
            origin_section(origin),
        ),
        result=result,
    )


def summary_section(result: dict[str, Any], then: str) -> Section:
    """The first page: what was found and how sure, what the recordings do not determine, before and after."""
    table = worded(found_table(result), "Identified from these recordings")
    said = tag("ul", [tag("li", one) for one in sentences(result)], class_="notes")
    charts = () if result["motion"] else (before_after_chart(result),)
    return Section("summary", "On one page", Html(table + said + what_next(next_sentence(result), then)), charts=charts)


def found_section(result: dict[str, Any]) -> Section:
    """The table of parameters, and a sentence for what is not determined."""
    rows: list[tuple[Content, ...]] = []
    for name, one in result["parameters"].items():
        interval = f"{number(one['low'], 6)} to {number(one['high'], 6)}" if one["determined"] else "-"
        rows.append(
            (
                name,
                one["meaning"],
                number(one["before"], 5),
                number(one["value"], 6),
                interval,
                one["unit"],
                one["source"],
            )
        )
    head = ("parameter", "meaning", "before", "value", "95 % interval", "unit", "from")
    parts = [table(head, rows, "Identified parameters", numeric=(2, 3))]
    together = [pair for pair in result["correlations"] if pair["strong"]]
    if together:
        items = [tag("li", f"{' and '.join(pair['between'])}: {pair['r']:+.2f}") for pair in together]
        parts.append(tag("p", "Hard to distinguish (correlation):"))
        parts.append(tag("ul", items))
    return Section("identified", "Identified", Html("".join(parts)))


def windows_section(result: dict[str, Any]) -> Section:
    """Which stretches of which run were used, and why others were refused."""
    rows: list[tuple[Content, ...]] = []
    for run in result["runs"]:
        used = ", ".join(f"{part['start_s']:.2f} - {part['stop_s']:.2f}" for part in run["stretches"]) or "-"
        why = ", ".join(f"{count} {reason}" for reason, count in run["refused"].items()) or "-"
        rows.append((run["name"], f"{run['used']} of {run['windows']}", used, why))
    refused: list[tuple[Content, ...]] = [
        (one["run"], f"{one['start_s']:.2f} - {one['stop_s']:.2f}", f"{one['input']:+.4g}", one["detail"])
        for one in result["refused"]
    ]
    every = tag("details", tag("summary", "Every refused window"),
                table(("run", "from - to [s]", "input", "why"), refused, "Refused windows"))  # fmt: skip
    body = table(("run", "steady windows", "stretches [s]", "refused windows"), rows, "Stretches used")
    return Section("windows", "Stretches", Html(body + every))
