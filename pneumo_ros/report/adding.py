"""The report of `pneumo add`: what was added and what it changed, on one page, then the page of `compare`."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pneumo_ros.report.chart import Report, Section
from pneumo_ros.report.comparison import comparison_report
from pneumo_ros.report.markup import Html, worded
from pneumo_ros.report.summary import before_after_chart, doing_list
from pneumo_ros.wording.additions import added_table
from pneumo_ros.wording.answers import remedies
from pneumo_ros.wording.naming import counted

if TYPE_CHECKING:
    from pneumo_ros.diagnose.adding import Adding


def adding_report(found: "Adding", result: dict[str, Any], compared: dict[str, Any], origin: dict[str, Any]) -> Report:
    """The whole page; result: the JSON of the verb, compared: that of `found.after`, origin: as of `provenance`."""
    page = comparison_report(compared, found.after, found.model, origin)
    return replace(page, title=_title(found), verdict=result["headline"], good=found.errors[2] < found.errors[1],
                   sections=(_first_page(found, result), *page.sections[1:]))  # fmt: skip


def _title(found: "Adding") -> str:
    return f"'{found.model.name}' with {', '.join(found.effects)}, refitted to {counted(len(found.train), 'recording')}"


def _first_page(found: "Adding", result: dict[str, Any]) -> Section:
    """Effects with their sizes, what to do at the machine, and the worst predicted signal over time."""
    doing = remedies({name: found.model.library.find(name).remedy for name in found.effects})
    body = Html(worded(added_table(result), "Added to the model") + doing_list(doing))
    chart = before_after_chart(found.before, found.after, found.effects, not found.held_out)
    return Section("summary", "On one page", body, charts=(chart,) if chart else ())
