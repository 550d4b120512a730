"""Plots in a real browser: they show the measured data and zoom together."""

import pytest
from report.browser import Visit
from report.pages import SECONDS, compared

POSITION, PRESSURE, OTHER = "run-1-position_m", "run-1-pressure_a_pa", "run-2-position_m"


def test_curves_are_drawn_no_finer_than_a_screen_shows(visit: Visit) -> None:
    visit.show(POSITION)
    shown = visit.traces(POSITION)
    assert [(trace["name"], trace["visible"]) for trace in shown[:4]] == [
        ("measured", True),
        ("model", True),
        ("free run", "legendonly"),
        ("error", True),
    ]
    paths = visit.page.locator(f"#{POSITION} .scatterlayer path.js-line")
    drawn = [path for path in paths.evaluate_all("all => all.map(one => one.getAttribute('d'))") if path]
    assert len(drawn) >= 5
    assert max(map(len, drawn)) > 2000
    assert 500 < len(shown[0]["x"]) < 3000  # of 6000 samples


def test_the_largest_and_smallest_survive_the_thinning(visit: Visit) -> None:
    visit.show(PRESSURE)
    error = 1e-3 * compared()[1].runs[0].predicted["pressure_a_pa"]
    shown = [y for y in visit.traces(PRESSURE)[3]["y"] if y is not None]
    assert min(shown) == pytest.approx(float(error[error == error].min()), abs=0.05)
    assert max(shown) == pytest.approx(float(error[error == error].max()), abs=0.05)


def test_zooming_in_shows_every_sample_as_it_was_measured(visit: Visit) -> None:
    visit.show(POSITION)
    visit.drag(POSITION, 0.3, 0.35)
    visit.wait_for_range(POSITION, 0.3 * SECONDS, 0.35 * SECONDS)
    trace = visit.traces(POSITION)[0]
    run = compared()[1].runs[0]
    index = [round(t / run.motion.run.sample_time) for t in trace["x"]]
    assert index == list(range(index[0], index[0] + len(index)))
    assert len(index) == pytest.approx(0.05 * SECONDS * 1000, abs=20)
    noise = 1e3 * run.error["position_m"].noise
    assert trace["y"] == pytest.approx(1e3 * run.motion.run.position[index], abs=0.11 * noise)


def test_a_drag_zooms_every_plot_of_the_run_and_no_other(visit: Visit) -> None:
    visit.show(OTHER, PRESSURE, POSITION)
    assert visit.range(POSITION) == pytest.approx([0.0, SECONDS], abs=0.01)
    visit.drag(POSITION, 0.25, 0.5)
    zoomed = (0.25 * SECONDS, 0.5 * SECONDS)
    visit.wait_for_range(POSITION, *zoomed)
    visit.wait_for_range(PRESSURE, *zoomed)
    assert visit.range(OTHER) == pytest.approx([0.0, SECONDS], abs=0.01)
    visit.show("run-1-residuals")  # drawn only now
    visit.wait_for_range("run-1-residuals", *zoomed)
    visit.show(POSITION)
    visit.page.locator(f"#{POSITION} .nsewdrag").first.dblclick()
    visit.wait_for_range(PRESSURE, 0.0, SECONDS)


def test_a_button_leads_to_the_worst_interval(visit: Visit) -> None:
    visit.show(POSITION, PRESSURE)
    worst = compared()[1].runs[0].located["position_m"].worst[0]
    visit.page.get_by_role("button", name="position").first.click()
    margin = 0.3 * (worst.end - worst.start) + 0.1
    visit.wait_for_range(PRESSURE, max(worst.start - margin, 0.0), worst.end + margin)
    visit.page.get_by_role("button", name="Whole run").first.click()
    visit.wait_for_range(PRESSURE, 0.0, SECONDS)


def test_the_reader_brings_in_the_free_run_and_it_stays(visit: Visit) -> None:
    visit.show(POSITION)
    visit.page.locator(f"#{POSITION} .legendtoggle").nth(2).click()
    visit.wait("id => document.getElementById(id).data[2].visible === true", POSITION)
    visit.page.get_by_role("button", name="position").first.click()
    visit.page.wait_for_timeout(300)
    assert visit.traces(POSITION)[2]["visible"] is True


def test_the_heat_map_follows_the_first_page_and_leads_to_the_run(visit: Visit) -> None:
    sections = visit.page.locator("main > section")
    assert [sections.nth(k).get_attribute("id") for k in (0, 1)] == ["summary", "overview"]
    cells = visit.page.locator("#overview table.heat tbody td a")
    assert cells.count() == 2 * 6
    cells.nth(6).click()
    visit.wait("location.hash === '#run-2'")
    visit.wait("Math.abs(document.getElementById('run-2').getBoundingClientRect().top) < 60")
    visit.wait("document.getElementById('run-2-position_m').dataset.drawn === 'yes'")
