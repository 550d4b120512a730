"""The evidence: every candidate that was tried, with its figures, and why it was or was not added."""

from collections.abc import Sequence

from pneumo_ros.compare.wording import percent
from pneumo_ros.diagnose.candidate import GAIN_LEAST, T_LEAST
from pneumo_ros.report.candidate_charts import candidate_charts
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.wording.candidates import CandidateWords

TEXT = (
    "An effect is added when it passes every test: on the recordings it was fitted to, its size must be at least "
    f"{T_LEAST:g} standard deviations (t); on the held-out ones, which were never fitted, it must remove at least "
    f"{percent(GAIN_LEAST)} of an equation's squared residual, beyond the scatter between stretches of time, and make "
    "no other equation worse; its size must matter, and be the same whichever recording is left out. Each candidate is "
    "listed with the round in which it was tried last."
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
        evidence = (one.effect, f"{one.t:.1f}", f"{100.0 * one.gain:.1f} %", one.equation, one.size, one.interval)
        chip = tag("span", one.word, class_=f"chip {one.state}")
        rows.append((*evidence, tag("div", chip, " ", "; ".join(one.reasons), class_="reason")))
    head = ("effect", "t", "held-out gain", "in", "size / usual", "95 % interval", "verdict")
    return table(head, rows, "Candidates: what was added first, then by t", numeric=(1, 2, 4, 5))
