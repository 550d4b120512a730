"""What the page shows of a diagnosis, from the JSON of the verb."""

from functools import lru_cache
from typing import Any

import pytest
from report.diagnoses import EXPERIMENT, HOSTILE, diagnosed

from pneumo_ros.command.console import plain
from pneumo_ros.command.diagnosis_json import diagnosis_dict
from pneumo_ros.report.page import section_html
from pneumo_ros.workbench.diagnosis_panel import sections


@lru_cache(3)
def result_of(verdict: str) -> dict[str, Any]:
    """The JSON of a diagnosis with this verdict."""
    result: dict[str, Any] = plain(diagnosis_dict(diagnosed(verdict), {}, EXPERIMENT))
    return result


def shown(verdict: str) -> str:
    """All sections as markup."""
    return "".join(section_html(section) for section in sections(result_of(verdict)))


def test_what_was_found_comes_with_its_interval_and_the_others_with_reasons() -> None:
    text, result = shown("effects_found"), result_of("effects_found")
    assert "Something was missing, and it was found." in text
    assert "+ viscous friction" in text
    assert "N s/m" in text
    for one in result["candidates"]:
        for reason in one["objections"]:
            assert reason.split(";")[0][:30] in text
    charts = [chart.name for section in sections(result) for chart in section.charts]
    assert charts[:2] == ["evidence-t", "evidence-gain"]


def test_an_unknown_effect_is_drawn() -> None:
    result = result_of("unknown_effect")
    charts = {chart.name: chart for section in sections(result) for chart in section.charts}
    assert "no effect of the catalogue explains" in shown("unknown_effect")
    curve = charts["diagnosis-shape"].panels[0].traces[1]
    assert len(curve.x) == len(result["unexplained"]["shape"])


@pytest.mark.parametrize("verdict", ["effects_found", "unknown_effect"])
def test_every_verdict_is_shown_and_nothing_becomes_markup(verdict: str) -> None:
    text = shown(verdict)
    assert HOSTILE not in text
    assert "<script" not in text
    assert EXPERIMENT not in text  # it holds markup
    assert "&lt;slowly&gt;" in text
