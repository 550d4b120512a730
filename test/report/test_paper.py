"""Reports on paper: one page first, every plot drawn, no column cut; and without scripts."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from report.browser import Visit
from report.diagnoses import diagnosed, diagnosis_of
from report.pages import compared, result_of

import pneumo_ros as pn
from pneumo_ros.command.console import plain
from pneumo_ros.compare.findings import headline
from pneumo_ros.compare.wording import times
from pneumo_ros.report.chart import Report
from pneumo_ros.report.comparison import comparison_report
from pneumo_ros.report.identification import identification_report
from pneumo_ros.report.page import page_html
from pneumo_ros.report.provenance import provenance

SHEET = 700  # px: A4 without its margins
FOUND = "effects_found"
HIGH = "all => all.map(one => one.getBoundingClientRect().height)"
CUT = """() => [...document.querySelectorAll("main *")].filter((one) => one.checkVisibility()
  && one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.outerHTML.slice(0, 100))"""


NOISE = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}  # m, Pa
FIRST = "pneumo tune --out gains.yaml"  # any command line


def comparison_page() -> Report:
    """A comparison whose friction fails."""
    model, comparison = compared()
    return comparison_report(result_of(comparison), comparison, model, provenance([], "axis", ["compare"]), FIRST)


def identification_page() -> Report:
    """An identification of too few runs, with Coulomb friction that was 10 N too low before."""
    model = pn.load_model("axis")
    runs = [
        pn.simulate(
            model, f"step:{volts}@0.5", seconds=3, position=-0.3 * np.sign(volts), noise=NOISE, seed=k, name=f"run_{k}"
        )
        for k, volts in enumerate((1.2, -1.2, 2.0, -2.0))
    ]
    found = pn.identify(runs, model.with_parameters({"lugre_friction.coulomb_friction": 60.0}))
    return identification_report(plain(found.as_dict()), found.model, provenance([], "axis", ["identify"]), FIRST)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a diagnosis that found an effect."""
    path = tmp_path_factory.mktemp("paper") / "found.html"
    path.write_text(page_html(diagnosis_of(diagnosed(FOUND))), encoding="utf-8")
    return path


@pytest.fixture
def paper(browser: Any, page: Path) -> Any:
    """The page as it is printed."""
    opened = Visit(browser, page.as_uri(), SHEET, "dark")
    opened.page.emulate_media(media="print")
    yield opened.page
    opened.close()


def test_every_plot_is_drawn_on_paper_and_no_column_is_cut(paper: Any) -> None:
    stills = paper.locator("figure .still")
    assert stills.count() == paper.locator("figure").count() > 8
    assert paper.locator("figure .plot:visible").count() == 0
    shown = paper.locator("main > section:not(#equations) figure .still").evaluate_all(HIGH)
    assert min(shown) > 80
    assert paper.evaluate(CUT) == []
    paper_colour = paper.evaluate("getComputedStyle(document.body).color")
    assert max(map(int, paper_colour[4:-1].split(", "))) < 100  # dark ink, also for a reader who prefers dark pages


def test_the_first_page_holds_the_answer_and_ends_after_it(paper: Any, page: Path) -> None:
    (added,) = diagnosed(FOUND).added
    summary = paper.locator("#summary")
    words = summary.inner_text()
    assert f"{times(added.holdout_error_before)} -> {times(added.holdout_error_after)}" in words
    assert f"At the machine, for {added.effect}: " in words
    assert f"{added.score.nats:.0f} nats of evidence" in words
    box = summary.bounding_box()
    assert box["y"] + box["height"] < SHEET * 297 / 210  # one sheet
    assert summary.evaluate("one => getComputedStyle(one).breakAfter") == "page"
    assert summary.locator("svg .trace.line").count() == 3 + 2 + 2  # curves, errors, twice the noise


def test_the_curves_of_the_first_page_are_measured_before_and_after(browser: Any, page: Path) -> None:
    visit = Visit(browser, page.as_uri())
    visit.show("before-after")
    measured, before, after, error_before, error_after, *_ = visit.traces("before-after")
    assert (measured["name"], after["name"]) == ("measured", "with viscous_friction")
    outcome = diagnosed(FOUND)
    noise = 1e3 * outcome.before.runs[0].error["position_m"].noise
    largest = [max(abs(y) for y in one["y"] if y is not None) for one in (error_before, error_after)]
    assert largest[0] > 3.0 * largest[1] > noise
    assert len(before["x"]) > 500
    visit.close()


def test_without_scripts_the_drawings_are_shown(browser: Any, page: Path) -> None:
    context = browser.new_context(java_script_enabled=False, offline=True)
    opened = context.new_page()
    opened.goto(page.as_uri())
    assert opened.locator("#summary .still").is_visible()
    assert not opened.locator("#summary .plot").is_visible()
    context.close()


@pytest.mark.parametrize("make", [comparison_page, identification_page], ids=["compare", "identify"])
def test_other_verbs_begin_with_one_sheet_and_what_to_do_next(browser: Any, tmp_path: Path, make: Any) -> None:
    report = make()
    (tmp_path / "page.html").write_text(page_html(report), encoding="utf-8")
    opened = Visit(browser, (tmp_path / "page.html").as_uri(), SHEET)
    opened.page.emulate_media(media="print")
    first = opened.page.locator("#summary")
    box, words = first.bounding_box(), first.inner_text()
    assert box["y"] + box["height"] < SHEET * 297 / 210
    assert first.evaluate("one => getComputedStyle(one).breakAfter") == "page"
    assert first.locator("svg.still").bounding_box()["height"] > 80
    assert FIRST in words
    assert opened.page.evaluate(CUT) == []
    opened.close()


def test_the_first_page_of_a_comparison_has_the_number_and_what_fails() -> None:
    text = page_html(comparison_page())
    verdict, first = text.split('id="summary"')[0], text.split('id="summary"')[1].split("</section>")[0]
    assert headline(result_of(compared()[1])).removeprefix("; ") in verdict
    assert "fails: " in first
    assert "measured and predicted" in first


def test_the_first_page_of_an_identification_has_before_and_after_and_what_is_not_known() -> None:
    report = identification_page()
    first = report.sections[0]
    (chart,) = first.charts
    assert "N rms off the machine file" in chart.words
    quality = report.result["map"]
    assert isinstance(quality, dict)
    assert 8.0 < quality["residual_before_rms_n"] < 12.0  # N
    assert quality["residual_rms_n"] < 0.1
    assert "lugre_friction.bristle_damping: not measured" in first.body
    assert '<td class="number">60</td>' in first.body
