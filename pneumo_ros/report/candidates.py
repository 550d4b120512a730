"""The evidence: every candidate that was tried, with its figures, and why it was or was not added."""

from collections.abc import Sequence

from pneumo_ros.diagnose.score import MARGIN
from pneumo_ros.report.candidate_charts import candidate_charts
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.wording.candidates import CandidateWords

TEXT = (
    "An effect is added by its score: the logarithm of how much more probable all recordings are with it than without "
    f"it, in nats. The score must be at least {MARGIN:g}, and its part from the held-out recordings, which were never "
    "fitted, above zero; the size must matter, and the effect must remove a good part of the misfit beyond noise. Each "
    "candidate is listed with the round in which it was tried last."
)


def candidates_section(found: Sequence[CandidateWords]) -> Section:
    """Two bar charts, and the table with the reasons."""
    if not found:
        return Section("evidence", "Evidence", tag("p", "No candidate was tried."))
    rows = Section("candidates", "Candidate by candidate", _table(found))
    body = tag("p", TEXT, class_="soft")
    return Section("evidence", "Evidence", body, charts=candidate_charts(found), parts=(rows,), columns=2)


def _table(found: Sequence[CandidateWords]) -> Html:
    rows: list[tuple[Content, ...]] = []
    for one in found:
        evidence = (one.effect, f"{one.nats:.0f}", f"{100.0 * one.gain:.1f} %", one.equation, one.size, one.interval)
        chip = tag("span", one.word, class_=f"chip {one.state}")
        rows.append((*evidence, tag("div", chip, " ", "; ".join(one.reasons), class_="reason")))
    head = ("effect", "nats", "held-out gain", "in", "size / usual", "95 % interval", "verdict")
    return table(head, rows, "Candidates: what was added first, then by score", numeric=(1, 2, 4, 5))
