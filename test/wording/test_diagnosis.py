"""Terminal, report and workbench say the same of one diagnosis; and what else the panel of the workbench shows."""

import re
from dataclasses import replace
from functools import lru_cache
from html import unescape
from typing import Any

import pytest
from report.diagnoses import EXPERIMENT, HOSTILE, diagnosed, diagnosis_of, json_of

from pneumo_ros.command.diagnosis_text import text
from pneumo_ros.diagnose.between import Moved
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.report.page import page_html, section_html
from pneumo_ros.wording.diagnosis import diagnosis
from pneumo_ros.workbench.diagnosis_panel import sections

CASES = ("adequate", "rivals", "moved", "interrupted")


@lru_cache(maxsize=4)
def outcome_of(case: str) -> Outcome:
    """A diagnosis: adequate; an effect found, with a rival; a remainder that is the machine's change; interrupted."""
    if case == "moved":
        unknown = diagnosed("unknown_effect")
        assert unknown.unexplained is not None
        moved = Moved(0.7, {"lugre_friction.coulomb_friction": (70.0, 81.5, "N")})
        return replace(unknown, unexplained=replace(unknown.unexplained, moved=moved))
    if case == "adequate":
        return diagnosed("adequate")
    found = diagnosed("effects_found")
    tied = replace(found.added[0], indistinguishable_from=("constant_load",))
    return replace(found, added=(tied,), interrupted=case == "interrupted")


@lru_cache(maxsize=4)
def result_of(case: str) -> dict[str, Any]:
    """Its JSON, with a parameter that the refit moved."""
    result = json_of(outcome_of(case))
    one = {"before": 5.0, "value": 5.5, "std": 0.1, "low": 5.3, "high": 5.7, "unit": "kg"}
    moved = {"runs": [], "undetermined": [], "moved": ["piston.mass"], "parameters": {"piston.mass": one}}
    return result | {"refit": moved} if case == "moved" else result


def visible(markup: str) -> str:
    """What a page shows, as text."""
    return unescape(re.sub(r"<[^>]*>", "", re.sub(r"<script.*?</script>", "", markup, flags=re.DOTALL)))


@lru_cache(maxsize=4)
def page_of(case: str) -> str:
    """The page of `--report`, as text; it is worded from the same JSON."""
    report = diagnosis_of(outcome_of(case), result_of(case))
    return visible(page_html(report))


@lru_cache(maxsize=4)
def panel_of(case: str) -> str:
    """What the workbench shows, as text."""
    return visible("".join(section_html(section) for section in sections(result_of(case))))


@pytest.mark.parametrize("case", CASES)
def test_all_three_contain_every_sentence(case: str) -> None:
    sentences = diagnosis(result_of(case)).sentences()
    assert len(sentences) >= 5
    for shown in (text(result_of(case)), page_of(case), panel_of(case)):
        assert [one for one in sentences if one not in shown] == []


@pytest.mark.parametrize("case", CASES)
def test_all_three_contain_every_step_signal_and_parameter(case: str) -> None:
    said = diagnosis(result_of(case))
    parameters = [part for one in said.added for p in one.parameters for part in (p.key, p.value, p.interval, p.unit)]
    signals = [cell for row in said.signals.rows for cell in row]
    equations = [cell for row in said.equations.rows for cell in row]
    for shown in (text(result_of(case)), page_of(case), panel_of(case)):
        steps = [part for one in said.steps for part in (one.name, one.text.split("  ")[0])]
        assert [one for one in (*steps, *parameters, *signals, *equations) if one not in shown] == []


def test_the_held_out_error_is_the_headline_of_every_verdict() -> None:
    for case in CASES:
        assert "the held-out error" in diagnosis(result_of(case)).headline
    assert diagnosis(result_of("rivals")).headline.startswith(
        "'axis' lacks viscous_friction (or constant_load, which explains as much): with it, the held-out error falls "
    )


def test_what_remains_names_equation_size_variable_and_what_moved() -> None:
    said = " ".join(diagnosis(result_of("moved")).remains)
    assert said.startswith("The momentum equation leaves ")
    assert "lugre_friction.coulomb_friction 70 -> 81.5 N" in said
    assert diagnosis(result_of("moved")).moved.endswith("what was known before: piston.mass.")


def panel_markup(verdict: str) -> str:
    """All sections of the workbench's panel."""
    return "".join(section_html(section) for section in sections(json_of(diagnosed(verdict))))


def test_the_panel_shows_every_candidate_with_all_reasons_and_both_charts() -> None:
    markup, result = panel_markup("effects_found"), json_of(diagnosed("effects_found"))
    assert "+ viscous_friction" in markup
    for one in result["candidates"]:
        assert all(reason.split(";")[0][:30] in markup for reason in one["objections"])
    charts = [chart.name for section in sections(result) for chart in section.charts]
    assert charts[:2] == ["evidence-nats", "evidence-gain"]


def test_the_panel_draws_what_remains() -> None:
    result = json_of(diagnosed("unknown_effect"))
    charts = {chart.name: chart for section in sections(result) for chart in section.charts}
    curve = charts["diagnosis-shape"].panels[0].traces[1]
    assert len(curve.x) == len(result["unexplained"]["shape"])


@pytest.mark.parametrize("verdict", ["effects_found", "unknown_effect"])
def test_nothing_in_the_panel_becomes_markup(verdict: str) -> None:
    markup = panel_markup(verdict)
    assert HOSTILE not in markup
    assert "<script" not in markup
    assert EXPERIMENT not in markup  # it holds markup
    assert "&lt;slowly&gt;" in markup


@pytest.mark.parametrize("stop", ["interrupted", "deadline"])
def test_a_search_that_was_stopped_does_not_say_that_no_known_effect_explains_the_rest(stop: str) -> None:
    """Whether one does was not found out."""
    result = json_of(diagnosed("unknown_effect"))
    assert any("no known effect explains" in one for one in diagnosis(result).doing)
    stopped = diagnosis(result | {stop: True}).doing
    assert not any("no known effect explains" in one for one in stopped)
    assert any("the search was stopped" in one for one in stopped)
