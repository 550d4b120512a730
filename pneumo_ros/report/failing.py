"""The first page of a comparison: where the model fails, the worst signal over time, and what to do next."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Html, tag, worded
from pneumo_ros.report.summary import over_time_chart, what_next
from pneumo_ros.wording.comparing import NEXT, failing_table, next_step

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison

HEIGHT = 340  # pixels of the plot: what a sheet of paper has room for below seven rows


def failing_section(result: dict[str, Any], comparison: "Comparison", then: str) -> Section:
    """`then`: the command line that follows, "" for none."""
    found = failing_table(result)
    table = worded(found, "Where the model fails") if found.rows else tag("p", "Noise explains every part of it.")
    name, fitted = f"'{comparison.model}'", result.get("refit", {}).get("runs")
    chart = over_time_chart(((name, "first", comparison),), fitted, HEIGHT)
    body = Html(table + what_next(NEXT[next_step(result)], then))
    return Section("summary", "On one page", body, charts=(chart,) if chart else ())
