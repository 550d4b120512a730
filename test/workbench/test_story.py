"""The whole story in a browser: recordings, where the model fails, an effect ticked, the error falls."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from workbench.leaking import LEAK
from workbench.tab import Tab

from pneumo_ros.plant import load_model


def errors(tab: Tab) -> list[float]:
    """The steps of the waterfall, in noise floors, as in its text."""
    words = tab.see("#error-content figcaption").inner_text()
    return [float(found) for found in re.findall(r"([\d.]+) x", words)]


@pytest.mark.check
@pytest.mark.parametrize("typed_too", [False, True])
def test_an_effect_is_ticked_and_the_error_falls(tab: Tab, tmp_path: Path, typed_too: bool) -> None:
    tab.press("Compare")
    tab.see("#failures-content table.heat", "holdout_steps")
    assert tab.page.locator("#failures-content table.heat").first.locator("tbody td a").count() == 2 * 6
    tab.see("#verdict", "fail")
    tab.tick(LEAK.replace("_", " "))
    tab.press("Refit")
    tab.see("#job-says", "left")
    # until then the waterfall of the original machine may be shown
    tab.see("#error-content figcaption", LEAK)
    given, refitted, after, *_ = errors(tab)
    assert tab.clicks < 10
    assert after < 1.5
    assert given > refitted > 10.0 * after
    tab.see("#pair table", "cross_piston_leakage.conductance")
    tab.view("Signals")
    both = {f"model 1 (+ {LEAK})", "model 0 (as given)"}  # before and after in one plot
    tab.wait_for_traces(lambda found: both <= {one["name"] for one in found})
    machine = saved(tab, tmp_path / "saved.yaml")
    assert load_model(machine).effects[-1] == LEAK
    if typed_too:
        (tmp_path / "typed").mkdir()
        typed(tab, machine, tmp_path / "typed")
    undone(tab)


def saved(tab: Tab, path: Path) -> Path:
    """The machine file as the browser saves it."""
    tab.view("Save")
    with tab.page.expect_download() as download:
        tab.page.get_by_role("link", name="Save the machine file: axis_1.yaml").click()
    download.value.save_as(path)
    return path


def undone(tab: Tab) -> None:
    """Undo returns to the original machine; the variant can be chosen again."""
    tab.press("Undo")
    tab.see("#machine", "axis (as given)")
    tab.wait_for_tick("cross piston leakage", False)
    tab.page.get_by_label(f"1: + {LEAK}").click()
    tab.see("#machine", "axis_1.yaml")
    tab.wait_for_tick("cross piston leakage", True)


def typed(tab: Tab, machine: Path, folder: Path) -> None:
    """The command lines that the page shows give the very same machine and the same comparison."""
    lines = tab.see("#commands", "pneumo add").inner_text().splitlines()
    assert [shlex.split(line)[:2] for line in lines] == [["pneumo", "add"], ["pneumo", "compare"]]
    for line in lines:
        words = [sys.executable, "-m", "pneumo_ros", *shlex.split(line)[1:]]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert (folder / "axis_1.yaml").read_text() == machine.read_text()
    with tab.page.expect_download() as download:
        tab.page.get_by_role("link", name="comparison as JSON").click()
    shown = json.loads(Path(download.value.path()).read_text())
    assert shown["runs"] == json.loads((folder / "compared_2.json").read_text())["runs"]
