"""The evidence: every candidate that was tried, with what speaks for it, and why it was or was not added."""

import math
from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.compare.wording import number, percent
from pneumo_ros.diagnose.candidate import GAIN_LEAST, T_LEAST
from pneumo_ros.diagnose.judging import sizes
from pneumo_ros.report.candidate_charts import candidate_charts
from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.naming import NORMAL, effect_words, equation_words, listed, resolved

if TYPE_CHECKING:
    from pneumo_ros.diagnose.candidate import Candidate
    from pneumo_ros.diagnose.outcome import Outcome, Ranked

ADDED, RIVAL, REFUSED = "added", "rival", "refused"


def candidates_section(outcome: "Outcome") -> Section:
    """Two bar charts for the eye, and the table with the reasons."""
    states = [state(outcome, one) for one in outcome.ranking]
    if not outcome.ranking:
        return Section("evidence", "Evidence", tag("p", "No candidate was tried."))
    text = (
        "An effect is added when it passes every test: on the recordings it was fitted to, its size must be "
        f"{T_LEAST:g} times what chance makes of it (t); on the held-out ones, which were never fitted, it must remove "
        f"at least {percent(GAIN_LEAST)} of an equation's squared residual, beyond the scatter between stretches of "
        "time, and spoil no other equation; its size must matter, and be the same whichever recording is left out. "
        "Each candidate is listed with the round in which it was tried last."
    )
    rows = Section("candidates", "Candidate by candidate", _table(outcome, states))
    charts = candidate_charts(outcome.ranking, states)
    return Section("evidence", "Evidence", tag("p", text, class_="soft"), charts=charts, parts=(rows,), columns=2)


def state(outcome: "Outcome", one: "Ranked") -> str:
    """Whether a candidate was added, cannot be told apart from one that was, or was refused."""
    if one.effect in [addition.effect for addition in outcome.added]:
        return ADDED
    return RIVAL if _stands_in_for(outcome, one.effect) else REFUSED


def _stands_in_for(outcome: "Outcome", effect: str) -> list[str]:
    """Added effects that a candidate would replace equally well."""
    return [one.effect for one in outcome.added if effect in one.indistinguishable_from]


def _table(outcome: "Outcome", states: list[str]) -> Html:
    rows: list[tuple[Content, ...]] = []
    for one, found in zip(outcome.ranking, states, strict=True):
        share = "-" if one.holdout_gain < 0.0005 else equation_words(one.equation)
        evidence = (effect_words(one.effect), f"{one.score:.1f}", f"{100.0 * one.holdout_gain:.1f} %", share)
        size = f"{number(one.size)} x" if one.size else "0"
        rows.append((*evidence, size, size_interval(outcome, one), _reason(outcome, one, found)))
    head = ("effect", "t", "held-out gain", "in", "size / usual", "95 % interval", "verdict")
    return table(head, rows, "Candidates: what was added first, then by t", numeric=(1, 2, 4, 5))


def size_interval(outcome: "Outcome", one: "Ranked") -> str:
    """95 % interval of a candidate's size in usual ones; a dash where the candidate has none."""
    candidates = [candidate for step in outcome.steps for candidate in step.candidates if candidate.name == one.effect]
    own = [candidate for candidate in candidates if candidate.hypothesis.t == one.score]
    found = _bounds(own[-1]) if own and one.size else None
    if not found:
        return "-"
    std = (found[1] - found[0]) / (2.0 * NORMAL)
    return f"{resolved(found[0], std)} to {resolved(found[1], std)}"


def _bounds(candidate: "Candidate") -> tuple[float, float] | None:
    """Bounds of the largest size in usual ones, as `magnitude` counts it."""
    h = candidate.hypothesis
    if len(h.covariance) != len(h.coordinates):
        return None
    here = sizes(h.coordinates, h.u)
    largest = int(np.argmax(np.abs(here)))
    spread = np.zeros(len(here))
    spread[largest] = NORMAL * math.sqrt(max(float(h.covariance[largest, largest]), 0.0))
    ends = [sizes(h.coordinates, h.u + off)[largest] * np.sign(here[largest]) for off in (-spread, spread)]
    return float(min(ends)), float(max(ends))


def _reason(outcome: "Outcome", one: "Ranked", found: str) -> Html:
    """A chip and the reasons."""
    if found == ADDED:
        (own,) = (addition for addition in outcome.added if addition.effect == one.effect)
        rivals = [effect_words(name) for name in own.indistinguishable_from]
        said = f"these recordings cannot tell it from {listed(rivals, 'or')}" if rivals else "no other explains as much"
    elif found == RIVAL:
        names = [effect_words(name) for name in _stands_in_for(outcome, one.effect)]
        said = f"would explain as much in place of {listed(names)}"
    elif one.size == 0.0:
        said = "fits best when it is not there at all"
    else:
        said = _plain("; ".join(one.objections) or "another one explains more")
    return tag("div", _chip({RIVAL: "not told apart"}.get(found, found), found), " ", said, class_="reason")


def _plain(objection: str) -> str:
    """Objections with the equations named as people do."""
    for name in ("chamber_a", "chamber_b"):
        objection = objection.replace(name, equation_words(name))
    return objection


def _chip(text: str, kind: str) -> Html:
    return tag("span", text, class_=f"chip {kind}")
