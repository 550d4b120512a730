"""What is kept of a comparison: files and the command line to save, and panels on paper."""

import json
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from workbench.conftest import Served
from workbench.tab import Tab

from pneumo_ros.plant import load_model

SHEET = 720  # px: A4 without its margins


@pytest.fixture(scope="module")
def compared(browser: Any, served: Served) -> Iterator[Tab]:
    """A tab in which the shipped machine was compared with both recordings."""
    tab = Tab(browser, served.address)
    tab.press("Compare")
    tab.see("#failures-content table.heat", "holdout_steps")
    yield tab
    tab.close()
    assert tab.complaints == []


def saved(tab: Tab, name: str, path: Path) -> Path:
    """The file of a link of the panel, as the browser saves it."""
    with tab.page.expect_download() as download:
        tab.page.get_by_role("link", name=name).click()
    download.value.save_as(path)
    return path


def test_after_a_comparison_the_machine_its_numbers_and_the_command_line_are_saved(
    compared: Tab, tmp_path: Path
) -> None:
    compared.view("Save")
    line = compared.see("#commands", "pneumo compare").inner_text()
    assert "axis as it was given" not in line
    machine = saved(compared, "Save the machine file: axis.yaml", tmp_path / "axis.yaml")
    assert load_model(machine).as_dict() == load_model("axis").as_dict()
    page = saved(compared, "Save the report of the comparison: axis_comparison.html", tmp_path / "shown.html")
    assert "holdout_steps" in page.read_text(encoding="utf-8")
    numbers = json.loads(saved(compared, "Save the comparison as JSON", tmp_path / "shown.json").read_text())
    words = [sys.executable, "-m", "pneumo_ros", *shlex.split(line)[1:]]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    assert json.loads((tmp_path / "compared_1.json").read_text())["runs"] == numbers["runs"]


def test_a_printed_panel_is_its_plots(compared: Tab) -> None:
    """No controls; drawings of the charts that have not been in view; the plot of the run as wide as the sheet."""
    compared.view("Where it fails")
    page = compared.page
    try:
        page.emulate_media(media="print")
        page.set_viewport_size({"width": SHEET, "height": 1000})
        figures = page.locator("#failures-content figure")
        assert figures.count() > 10
        drawn = "all => all.filter((one) => one.closest('section').checkVisibility()).map((one) => one.clientHeight)"
        heights = page.locator("#failures-content figure .still").evaluate_all(drawn)
        assert min(heights) > 80
        assert page.locator("#failures-content .plot:visible").count() == 0
        assert page.locator("#compare:visible, #tab:visible, #effects:visible, #drop:visible").count() == 0
        page.emulate_media(media="screen")
        page.set_viewport_size({"width": 1600, "height": 900})
        compared.view("Signals")
        compared.wait_for_traces(bool)
        width = "document.querySelector('#signals .main-svg').getBoundingClientRect().width"
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        assert page.evaluate(width) <= SHEET
        page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        for _ in range(600):  # the page's policy forbids Playwright's own waiting
            if page.evaluate(width) > SHEET:
                break
            page.wait_for_timeout(50)
        assert page.evaluate(width) > SHEET
    finally:
        page.emulate_media(media="screen")
