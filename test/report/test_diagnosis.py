"""The report of a diagnosis in a real browser: all three verdicts, and the numbers of the outcome."""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest
from report.browser import Visit
from report.diagnoses import COEFFICIENT, COMMAND, EXPERIMENT, diagnosed, diagnosis_of
from report.pages import many
from report.test_readable import CONTRASTS

from pneumo_ros.compare.wording import number, times
from pneumo_ros.report.chart import Chart
from pneumo_ros.report.drawing import draw_charts
from pneumo_ros.report.page import page_html

WORDS = {"adequate": "Adequate", "effects_found": "Effect found", "unknown_effect": "Unknown effect"}
Open = Callable[[str], Visit]
FOUND, UNKNOWN = "effects_found", "unknown_effect"
ORDER = ["answer", "held-out", "evidence", "residuals", "remains", "overview", "findings", "runs", "equations",
         "regimes", "friction", "machine", "origin"]  # fmt: skip


@lru_cache(maxsize=3)
def text_of(verdict: str) -> str:
    """The page of a diagnosis."""
    return page_html(diagnosis_of(diagnosed(verdict)))


def followed() -> str:
    """The variable that explains most of the momentum's residual before anything was added."""
    against = diagnosed(FOUND).before.dependences["momentum"]
    return max(against, key=lambda name: against[name].explained_share)


@pytest.fixture(scope="module")
def opened(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Open]:
    """The page of a verdict in a browser: one for all tests, which leave it unchanged."""
    folder, visits = tmp_path_factory.mktemp("diagnosis"), dict[str, Visit]()

    def visit(verdict: str) -> Visit:
        if verdict not in visits:
            path = folder / f"{verdict}.html"
            path.write_text(text_of(verdict), encoding="utf-8")
            visits[verdict] = Visit(browser, path.as_uri())
        return visits[verdict]

    yield visit
    for one in visits.values():
        one.close()


@pytest.mark.check
def test_the_verdicts_differ_in_word_sign_and_colour(opened: Open) -> None:
    for scheme in ("dark", "light"):
        signs, colours = set(), set()
        for verdict, word in WORDS.items():
            assert diagnosed(verdict).verdict == verdict
            page = opened(verdict).page
            page.emulate_media(color_scheme=scheme)
            banner = page.locator("header .verdict")
            assert banner.locator(".badge").text_content() == word
            assert banner.bounding_box()["width"] > 1000
            signs.add(banner.locator(".sign").inner_text())
            colours.add(banner.evaluate("one => getComputedStyle(one).backgroundColor"))
        assert len(signs) == len(colours) == len(WORDS)


@pytest.mark.check
def test_sections_follow_each_other_from_the_answer_to_the_origin(opened: Open) -> None:
    for verdict in WORDS:
        sections = opened(verdict).page.locator("main > section")
        assert [one for one in sections.evaluate_all("all => all.map(one => one.id)") if one in ORDER] == ORDER


@pytest.mark.parametrize("verdict", [FOUND, UNKNOWN])
def test_every_plot_is_drawn_and_nothing_is_asked_for(opened: Open, verdict: str) -> None:
    visit = opened(verdict)
    visit.page.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
    names = visit.page.eval_on_selector_all(".plot", "all => all.map(one => one.id)")
    own = {"waterfall", "evidence-nats", "evidence-gain"}
    assert own | {"remains-shape" if verdict == UNKNOWN else f"residual-momentum-{followed()}"} <= set(names)
    visit.show(*names)
    assert len(visit.requests) == 1
    assert visit.complaints == []
    assert visit.page.evaluate("window.hacked") is None
    every = visit.page.eval_on_selector_all("[id]", "all => all.map(one => one.id)")
    assert len([one for one in every if one in names]) == len(names)  # no section has the name of a plot
    labels = visit.page.eval_on_selector_all(".plot", "all => all.map(one => one.getAttribute('aria-label'))")
    assert min(map(len, labels)) > 40


def test_the_waterfall_shows_the_course_of_the_error(opened: Open) -> None:
    visit, waterfall = opened(FOUND), diagnosed(FOUND).waterfall
    visit.show("waterfall")
    traces = {trace["name"]: trace for trace in visit.traces("waterfall")}
    shown = [traces[name]["x"][1] for name in ("as given", "refitted", "with what was added", "noise floor")]
    assert shown == pytest.approx([*(error for _, error in waterfall), 1.0], rel=1e-5)
    names = visit.page.locator("#waterfall .ytick text").all_text_contents()
    assert names == ["as given", "refitted", "+ viscous_friction", "noise floor"]
    for _, error in waterfall:
        assert times(error) in visit.page.locator("figure:has(#waterfall) figcaption").inner_text()


def test_the_parameters_of_what_was_added_stand_with_interval_and_unit(opened: Open) -> None:
    (added,) = diagnosed(FOUND).added
    (cells,) = opened(FOUND).page.locator("#added-viscous_friction tbody tr").all()
    _, dotted, value, interval, unit = (cell.inner_text() for cell in cells.locator("th, td").all())
    assert (dotted, unit) == ("viscous_friction.coefficient", "N s/m")
    known = added.parameters["coefficient"]
    low, high = map(float, interval.split(" to "))
    assert float(value) == pytest.approx(known.value, abs=0.5 * known.std)
    assert high - low == pytest.approx(2.0 * 1.96 * known.std, rel=0.2)
    assert low < COEFFICIENT < high


def test_the_evidence_stands_in_table_and_bars(opened: Open) -> None:
    visit, outcome = opened(FOUND), diagnosed(FOUND)
    rows = visit.page.locator("#candidates tbody tr").all()
    for row, one in zip(rows, outcome.ranking, strict=True):
        name, nats, gain, _, size, _, verdict = (cell.inner_text() for cell in row.locator("th, td").all())
        assert name == one.effect
        assert (nats, gain) == (f"{one.score.nats:.0f}", f"{100.0 * one.holdout_gain:.1f} %")
        assert size == f"{number(one.size)} x"
        assert verdict.startswith("refused" if one.objections else "added")
        assert all(text in verdict for text in one.objections)
    visit.show("evidence-gain")
    ends = {trace["name"]: trace["x"][1] for trace in visit.traces("evidence-gain")}
    assert ends["added"] == pytest.approx(100.0 * outcome.ranking[0].holdout_gain, rel=1e-5)


def test_the_residual_before_and_after_is_that_of_the_comparisons(opened: Open) -> None:
    visit, outcome = opened(FOUND), diagnosed(FOUND)
    plot, variable = f"residual-momentum-{followed()}", followed()
    visit.show(plot)
    traces = {trace["name"]: trace for trace in visit.traces(plot)}
    for name, comparison in (("refitted", outcome.before), ("final model", outcome.after)):
        shown = [y for y in traces[name]["y"] if y is not None]
        assert shown == pytest.approx(comparison.dependences["momentum"][variable].bins.mean, rel=1e-4)


def test_what_remains_is_drawn_or_said_to_be_nothing(opened: Open) -> None:
    left = diagnosed(UNKNOWN).unexplained
    assert left is not None
    visit = opened(UNKNOWN)
    visit.show("remains-shape")
    (mean,) = (trace for trace in visit.traces("remains-shape") if trace["name"] == "mean of what remains")
    assert [y for y in mean["y"] if y is not None] == pytest.approx(left.mean, rel=1e-4)
    nothing = opened("adequate").page.locator("#remains")
    assert nothing.locator(".plot").count() == 0
    assert "Nothing significant remains" in nothing.inner_text()


def test_command_line_experiment_and_json_stand_as_they_were_given(opened: Open) -> None:
    page = opened(FOUND).page
    assert page.locator("#repeat code").inner_text() == f"pneumo {' '.join(COMMAND)}".replace("held out", "'held out'")
    assert EXPERIMENT in page.locator("#remains").inner_text()
    (block,) = re.findall(r'<script type="application/json" id="result">(.*?)</script>', text_of(FOUND), re.DOTALL)
    assert json.loads(block)["verdict"] == FOUND


@pytest.mark.parametrize("verdict", [FOUND, *(pytest.param(w, marks=pytest.mark.check) for w in WORDS if w != FOUND)])
def test_it_can_be_read_in_light_and_dark_wide_and_narrow(opened: Open, verdict: str) -> None:
    visit = opened(verdict)
    visit.show("waterfall", "evidence-nats")
    for width in (390, 1280):
        visit.page.set_viewport_size({"width": width, "height": 900})
        for scheme in ("dark", "light"):
            visit.page.emulate_media(color_scheme=scheme)
            assert visit.page.evaluate("document.documentElement.scrollWidth") <= width, width
            assert visit.page.evaluate(CONTRASTS) == [], (width, scheme)


def test_an_effect_that_cannot_be_distinguished_from_others_says_so() -> None:
    outcome = diagnosed(FOUND)
    tied = replace(outcome.added[0], indistinguishable_from=("constant_load",))
    text = page_html(diagnosis_of(replace(outcome, added=(tied,))))
    assert "lacks viscous_friction (or constant_load, which explains as much)" in text
    assert "cannot distinguish viscous_friction from constant_load" in text
    assert "would explain as much in place of viscous_friction" in text
    assert "cannot distinguish" not in text_of(FOUND)


def test_what_was_interrupted_says_so() -> None:
    words = "INTERRUPTED after 2 rounds of the search"
    assert words in page_html(diagnosis_of(replace(diagnosed(FOUND), interrupted=True)))
    assert words not in text_of(FOUND)


def test_figures_have_names_of_their_own_and_words() -> None:
    figures = diagnosis_of(diagnosed(FOUND)).charts()
    names = [one.name for one in figures]
    assert len(names) == len(set(names))
    assert all(one.words for one in figures if isinstance(one, Chart))


def test_its_figures_can_be_drawn_as_files(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="comes with the extra 'figures'")
    names = ("waterfall", "evidence-nats", f"residual-momentum-{followed()}")
    draw_charts([one for one in diagnosis_of(diagnosed(FOUND)).charts() if one.name in names], tmp_path)
    assert {path.stem for path in tmp_path.iterdir()} == set(names)
    drawn = (tmp_path / "waterfall.svg").read_text(encoding="utf-8")
    assert "+ viscous_friction" in drawn
    assert all(times(error) in drawn for _, error in diagnosed(FOUND).waterfall)


def test_ten_held_out_runs_stay_below_ten_megabytes() -> None:
    outcome = diagnosed(FOUND)
    page = page_html(diagnosis_of(replace(outcome, after=many(outcome.after, 10, 4))))
    assert len(page.encode()) < 10e6
