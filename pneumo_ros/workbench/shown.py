"""Charts and sections of the report, in the form that the page's script takes."""

from collections.abc import Sequence
from typing import Any

from pneumo_ros.report.chart import Chart, Report, Section
from pneumo_ros.report.page import chart_json, section_html


def content(target: str, sections: Sequence[Section], stamp: object) -> dict[str, Any]:
    """Sections for the element `target`: escaped markup and charts by name. `stamp` differs between contents."""
    found = Report("", "", True, tuple(sections), {}).charts()
    charts = {chart.name: chart_json(chart) for chart in found if isinstance(chart, Chart)}
    html = "".join(section_html(section, stills=True) for section in sections)  # the drawings are for paper
    return {"target": target, "html": html, "charts": charts, "stamp": stamp}
