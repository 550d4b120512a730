"""The report of `pneumo compare`: its sections, from the verb's JSON and the series beside it."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.findings import findings, verdict
from pneumo_ros.compare.wording import TARGETS, amount
from pneumo_ros.report.chart import HeatMap, Report, Section
from pneumo_ros.report.equations import equations_section
from pneumo_ros.report.failing import failing_section
from pneumo_ros.report.friction import friction_section
from pneumo_ros.report.machine import machine_section
from pneumo_ros.report.markup import tag
from pneumo_ros.report.origin import origin_section
from pneumo_ros.report.regimes import regimes_section
from pneumo_ros.report.runs import runs_section, thinning

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison
    from pneumo_ros.plant import Model


def comparison_report(
    result: dict[str, Any], comparison: "Comparison", model: "Model", origin: dict[str, Any], then: str = ""
) -> Report:
    """The whole page of `compare`; then: the command line that follows, "" for none."""
    return Report(
        title=f"Model '{result['model']}' against {_count(result)}",
        verdict=verdict(result),
        good=all(one.level != "bad" for one in findings(result)),
        sections=(
            failing_section(result, comparison, then),
            *comparison_sections(result, comparison),
            machine_section(model, result.get("refit")),
            origin_section(origin),
        ),
        result=result | {"provenance": origin},
    )


def comparison_sections(result: dict[str, Any], comparison: "Comparison") -> tuple[Section, ...]:
    """Heat map first, then what fails, runs, equations, regimes and friction, for any model and runs."""
    return (
        overview_section(result),
        findings_section(result),
        runs_section(result, comparison, thinning(comparison)),
        equations_section(result),
        regimes_section(result),
        *friction_section(result),
    )


def _count(result: dict[str, Any]) -> str:
    runs = result["runs"]
    return str(runs[0]["name"]) if len(runs) == 1 else f"{len(runs)} recordings"


def overview_section(result: dict[str, Any]) -> Section:
    """The heat map: runs x signals and equations, each cell leads to its run."""
    targets = [*result["signals"], *result["equations"]]
    ratios, texts = [], []
    for run in result["runs"]:
        found = {**run["error"], **run["equations"]}
        ratios.append([found[name]["ratio_to_noise"] for name in targets])
        texts.append([amount(found[name].get("rms", found[name].get("residual_rms")), name) for name in targets])
    heat_map = HeatMap(
        name="overview",
        title=f"Error over sensor noise: signals predicted over {result['horizon_s']:g} s, residuals of the equations",
        rows=[run["name"] for run in result["runs"]],
        columns=[TARGETS[name][0] for name in targets],
        ratios=ratios,
        texts=texts,
        hrefs=[f"#run-{k}" for k in range(1, len(result["runs"]) + 1)],
    )
    text = "1 x means that only noise is left. A click on a cell opens its run."
    return Section("overview", "Overview", tag("p", text, class_="soft"), heat=heat_map)


def findings_section(result: dict[str, Any]) -> Section:
    """The sentences: what fails, in which regime, with which variable, and when."""
    items = [
        tag(
            "li",
            tag("b", f"{TARGETS[one.target][0].capitalize()} {one.verdict}"),
            tag("ul", [tag("li", detail) for detail in one.details]) if one.details else "",
            class_=one.level,
        )
        for one in findings(result)
    ]
    return Section("findings", "Where it fails", tag("ul", items, class_="findings"))
