"""The plot of a run in a browser: zoom to single samples, cursors, regimes, cuts; and the sliders."""

import numpy as np
import pytest
from workbench.leaking import SECONDS
from workbench.tab import Tab

from pneumo_ros.records import read_recording

COULOMB = "coulomb friction"


def span_of(trace: dict[str, list[float]]) -> tuple[float, float]:
    """What the x data of a trace covers."""
    return trace["x"][0], trace["x"][-1]


def test_a_drag_zooms_to_single_samples_and_back(tab: Tab, leaking: object) -> None:
    whole = tab.wait_for_traces(lambda found: len(found) == 4)
    assert len(whole[0]["x"]) < 2500  # of 8000 samples
    tab.drag(0.30, 0.34)
    near = tab.wait_for_traces(lambda found: span_of(found[0])[1] < 0.5 * SECONDS)
    recording = read_recording(f"{leaking}/holdout_steps")
    inside = (recording.time > near[0]["x"][0] - 1e-6) & (recording.time < near[0]["x"][-1] + 1e-6)
    assert near[0]["x"] == pytest.approx(recording.time[inside])
    assert near[0]["y"] == pytest.approx(1e3 * recording.position[inside])
    assert len(near[0]["x"]) == pytest.approx(0.04 * SECONDS * 1000, abs=30)
    tab.press("Whole run")
    tab.wait_for_traces(lambda found: span_of(found[0])[1] > 0.9 * SECONDS)
    tab.drag(0.5, 0.6)
    tab.wait_for_traces(lambda found: span_of(found[0])[1] < 0.7 * SECONDS)
    tab.double_click_until(lambda found: span_of(found[0])[1] > 0.9 * SECONDS)


def test_two_clicks_measure_a_difference(tab: Tab, leaking: object) -> None:
    tab.wait_for_traces(len)
    box = tab.page.locator("#signals .nsewdrag").first.bounding_box()
    for name, share in (("A", 0.25), ("B", 0.75)):
        tab.page.get_by_label(name, exact=True).check()
        tab.page.mouse.click(box["x"] + share * box["width"], box["y"] + 0.5 * box["height"])
        tab.see("#cursors tbody tr", "time")
    tab.page.locator("#cursors td:nth-child(4):not(:has-text('-'))").first.wait_for()
    rows = [row.split("\t") for row in tab.page.locator("#cursors tbody tr").all_inner_texts()]
    a, b, difference = (float(cell) for cell in rows[0][1:4])
    assert difference == pytest.approx(b - a, rel=1e-4)
    assert difference == pytest.approx(0.5 * SECONDS, rel=0.05)
    recording = read_recording(f"{leaking}/holdout_steps")
    moved = 1e3 * np.interp([a, b], recording.time, recording.position)
    assert float(rows[1][3]) == pytest.approx(moved[1] - moved[0], abs=0.5)


@pytest.mark.check
def test_a_regime_is_shaded_and_a_cut_taken_back(tab: Tab) -> None:
    tab.press("Compare")
    tab.see("#failures-content table.heat")
    tab.page.locator("#failures-content tbody td a").first.click()  # a cell leads to its run
    tab.wait_for_traces(lambda found: any(one["name"].startswith("error of") for one in found))
    tab.page.locator("#regime").click()
    tab.page.get_by_role("option", name="slide", exact=True).click()
    shapes = "one => (one.layout.shapes || []).length"
    for _ in range(100):
        if tab.page.locator("#signals").evaluate(shapes):
            break
        tab.page.wait_for_timeout(50)
    assert tab.page.locator("#signals").evaluate(shapes) > 0
    tab.press("Cut what is in view")
    tab.see("#message", "zoom to the part to cut first")
    tab.drag(0.5, 0.75)
    tab.wait_for_traces(lambda found: span_of(found[0])[0] > 0.4 * SECONDS)
    tab.press("Cut what is in view")
    back = tab.see("#bags button", "cut ")
    begin, end = back.inner_text().split()[1].split("-")
    assert float(end) - float(begin) == pytest.approx(0.25 * SECONDS, rel=0.02)
    back.click()
    back.wait_for(state="detached")


def test_the_response_follows_a_slider(tab: Tab) -> None:
    tab.view("Sliders")
    tab.see("#response .main-svg")
    response = tab.page.locator("#response")
    curve = "one => [...one._fullData.find(t => t.name === 'with the sliders').y]"
    before = response.evaluate(curve)
    tab.page.get_by_label(COULOMB).focus()
    for _ in range(50):
        tab.page.keyboard.press("ArrowRight")
    told = tab.page.locator(f"label:has-text('{COULOMB}') output")
    told.filter(has_text="140 N").wait_for()  # twice as much
    for _ in range(100):
        after = response.evaluate(curve)
        if max(abs(a - b) for a, b in zip(before, after, strict=False)) > 1.0:
            break
        tab.page.wait_for_timeout(50)
    assert max(abs(a - b) for a, b in zip(before, after, strict=False)) > 1.0  # mm
    tab.page.wait_for_timeout(600)  # the page gets the stops once the slider rests
    tab.press("Keep as a variant")
    tab.see("#machine", "by hand")
    tab.view("Save")
    tab.see("#commands", "set by hand: lugre_friction.coulomb_friction = 140")


def test_every_control_has_a_name(tab: Tab) -> None:
    tab.view("Sliders")
    tab.see("#sliders input")
    nameless = """() => [...document.querySelectorAll('button, input, select, a, [role=button]')].filter((one) => {
      const words = one.getAttribute('aria-label') || one.textContent.trim() || one.title
        || (one.labels && [...one.labels].some((label) => label.textContent.trim()))
        || one.getAttribute('aria-labelledby') || one.closest('label');
      return !words && one.type !== 'hidden' && !one.closest('.modebar');
    }).map((one) => one.outerHTML.slice(0, 120))"""
    assert tab.page.evaluate(nameless) == []


@pytest.mark.parametrize(
    ("width", "scheme"),
    [*(pytest.param(width, "light", marks=pytest.mark.check) for width in (1280, 420)), (820, "dark")],
)
def test_nothing_sticks_out(browser: object, served: object, width: int, scheme: str) -> None:
    opened = Tab(browser, served.address, width, scheme)  # type: ignore[attr-defined]  # of the fixture
    try:
        for name in ("Import", "Rig", "Sliders", "Live", "Save", "Diagnosis", "Signals"):
            opened.view(name)
            opened.page.wait_for_timeout(300)
            assert opened.page.evaluate("document.documentElement.scrollWidth") <= width, name
        paper = opened.page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert (max(map(int, paper[4:-1].split(", "))) < 80) == (scheme == "dark")
    finally:
        opened.close()
