"""The report of `pneumo diagnose`: what is missing, with its evidence, and the final model on the held-out runs."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pneumo_ros.diagnose.outcome import UNKNOWN
from pneumo_ros.report.answer import answer_section, badge
from pneumo_ros.report.candidates import candidates_section
from pneumo_ros.report.chart import Report, Section
from pneumo_ros.report.comparison import comparison_sections
from pneumo_ros.report.machine import machine_section
from pneumo_ros.report.origin import origin_section
from pneumo_ros.report.remains import remains_section
from pneumo_ros.report.residuals import residuals_section
from pneumo_ros.report.summary import summary_section
from pneumo_ros.report.waterfall import waterfall_section
from pneumo_ros.wording.diagnosis import diagnosis

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Outcome


def diagnosis_report(
    outcome: "Outcome", result: dict[str, Any], compared: dict[str, Any], origin: dict[str, Any]
) -> Report:
    """The whole page of a diagnosis.

    result: the JSON of the verb, which the page shows and holds; compared: the JSON of `outcome.after`; both of plain
    types. origin: what `provenance` returns, with the command line that repeats the diagnosis.
    """
    said, runs = diagnosis(result), len(outcome.train) + len(outcome.held)
    return Report(
        title=f"What '{outcome.model.name}' lacks, from {runs} recordings",
        verdict=said.headline,
        good=outcome.verdict != UNKNOWN,
        badge=badge(said),
        sections=(
            summary_section(said, outcome),
            answer_section(said, outcome, origin),
            waterfall_section(said),
            candidates_section(said.candidates),
            residuals_section(outcome),
            remains_section(said, outcome),
            *_final(outcome, compared),
            machine_section(outcome.model, None),
            origin_section(origin),
        ),
        result=result | {"provenance": origin},
    )


def _final(outcome: "Outcome", compared: dict[str, Any]) -> tuple[Section, ...]:
    """The page of `compare` for the final model on the held-out runs, under a title of its own."""
    first, *others = comparison_sections(compared, outcome.after)
    return replace(first, title="Final model on the held-out recordings"), *others
