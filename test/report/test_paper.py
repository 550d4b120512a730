"""A diagnosis on paper: one page first, every plot drawn, no column cut; and without scripts."""

from pathlib import Path
from typing import Any

import pytest
from report.browser import Visit
from report.diagnoses import diagnosed, diagnosis_of

from pneumo_ros.compare.wording import times
from pneumo_ros.report.page import page_html

SHEET = 700  # px: A4 without its margins
FOUND = "effects_found"
HIGH = "all => all.map(one => one.getBoundingClientRect().height)"
CUT = """() => [...document.querySelectorAll("main *")].filter((one) => one.checkVisibility()
  && one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.outerHTML.slice(0, 100))"""


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
