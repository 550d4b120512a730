"""The bar of steps: always in sight, first for the keyboard, and with the next sensible step."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from workbench.conftest import Served
from workbench.tab import Tab

from pneumo_ros.workbench.bags import Bag
from pneumo_ros.workbench.desk import Desk, Given
from pneumo_ros.workbench.error_panel import course
from pneumo_ros.workbench.failures_panel import banner
from pneumo_ros.workbench.next_step import done, next_step
from pneumo_ros.workbench.variant import Compared

NARROW = 420
IN_SIGHT = "document.querySelector('#{}').getBoundingClientRect().y"


def with_bags(desk: Desk, *roles: str) -> None:
    """Recordings in these roles, without files."""
    desk.shelf.bags = tuple(Bag(f"run_{k}", f"/run_{k}", role) for k, role in enumerate(roles))  # type: ignore[arg-type]


def with_comparison(desk: Desk, folder: Path, explained: bool) -> None:
    """The current machine compared: noise explains all of it, or one equation fails."""
    path = folder / f"compared_{explained}.json"
    one = {"explained_by_noise": explained}
    path.write_text(json.dumps({"equations": {"momentum": one}, "signals": {"position_m": one}, "runs": []}))
    desk.variants[desk.current] = replace(desk.variant, compared=Compared((), path, path, path))


def with_diagnosis(desk: Desk, folder: Path) -> None:
    """The current machine made by a diagnosis that asks for an experiment."""
    path = folder / "made.json"
    path.write_text(json.dumps({"candidates": [], "suggested_experiment": "Creep slowly."}))
    desk.variants[desk.current] = replace(desk.variant, result=path)


def test_the_next_step_follows_from_what_was_done(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    assert next_step(desk).key == "import"
    with_bags(desk, "fit")
    assert (next_step(desk).key, done(desk)) == ("compare", {"import"})
    with_comparison(desk, tmp_path, explained=False)
    assert "first mark one 'hold out'" in next_step(desk).why
    with_bags(desk, "fit", "hold")
    assert (next_step(desk).key, done(desk)) == ("diagnose", {"import", "compare"})
    desk.ticked |= {"payload_mass"}
    assert (next_step(desk).key, "with payload mass" in next_step(desk).why) == ("refit", True)
    desk.ticked -= {"payload_mass"}
    with_diagnosis(desk, tmp_path)
    assert (next_step(desk).key, done(desk)) == ("save", {"import", "compare", "diagnose"})
    assert "Creep slowly." in next_step(desk).why


def test_a_machine_that_noise_explains_is_saved(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    with_bags(desk, "fit", "hold")
    with_comparison(desk, tmp_path, explained=True)
    assert (next_step(desk).key, done(desk)) == ("save", {"import", "compare"})


def test_the_sentence_above_the_panels_holds_the_error_of_the_recordings_held_out(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    with_bags(desk, "fit", "hold")
    runs = [{"name": f"run_{k}", "windows": 1, "error": {"position_m": {"typical_ratio_to_noise": error}}}
            for k, error in enumerate((90.0, 2.5))]  # fmt: skip
    path = tmp_path / "compared.json"
    path.write_text(json.dumps({"model": "axis", "horizon_s": 1.0, "runs": runs, "equations": {}, "signals": {}}))
    desk.variants[0] = replace(desk.variant, compared=Compared(("run_0", "run_1"), path, path, path))
    words, tone = banner(desk, json.loads(path.read_text()))
    assert words.endswith("; the error over 1 s is 2.5 x the noise floor on recordings held out, never fitted.")
    assert tone == "verdict good"
    assert course(desk) == [("as given", 2.5)]
    assert next_step(desk).key == "diagnose"
    desk.shelf.set_role("run_1", "out")
    runs[0]["error"] = {"position_m": {"typical_ratio_to_noise": 1.1}}
    other = tmp_path / "other.json"
    other.write_text(json.dumps({"runs": runs, "equations": {}, "signals": {}}))
    desk.variants[0] = replace(desk.variant, compared=Compared(("run_0", "run_1"), other, other, other))
    assert next_step(desk).key == "save"


def test_recordings_that_cannot_be_read_are_replaced_first(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    desk.shelf.bags = (Bag("run", "/run", "fit", problem="broken"),)
    assert next_step(desk).why.startswith("None of these recordings can be read")


def test_the_bar_stays_in_sight_on_a_telephone_and_is_first_for_the_keyboard(browser: Any, served: Served) -> None:
    tab = Tab(browser, served.address, NARROW)
    try:
        tab.see("#next", "Next: Compare.")
        tab.wait_for_traces(bool)
        assert tab.page.evaluate(IN_SIGHT.format("signals")) < 300.0
        for _ in range(3):  # after Import and Rig
            tab.page.keyboard.press("Tab")
        assert tab.page.evaluate("document.activeElement.id") == "compare"
        tab.page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
        assert tab.page.evaluate(IN_SIGHT.format("lead")) == pytest.approx(0.0, abs=1.0)
        tab.page.keyboard.press("Enter")
        tab.see("#job-says", "Comparing")
        assert 0.0 <= tab.page.evaluate(IN_SIGHT.format("job-says")) < 300.0
        tab.see("#next", "Next: Diagnose.")
        tab.see("#diagnose.main")
        tab.see("#compare.done")
        assert tab.page.evaluate("document.documentElement.scrollWidth") <= NARROW
        assert tab.page.evaluate(IN_SIGHT.format("panel-failures")) < 700.0
        right = "document.querySelector('#failures-content table.heat caption').getBoundingClientRect().right"
        assert tab.page.evaluate(right) < NARROW  # its table is wider, and scrolls
        tab.view("Signals")
        tab.wait_for_traces(lambda found: sum(one["name"] == "measured" for one in found) == 3)
        tab.page.evaluate("window.scrollTo(0, 0)")
        assert tab.page.evaluate(IN_SIGHT.format("signals")) < 420.0  # below the verdict, in the upper half
        tab.page.get_by_text("Signals, other runs, regimes and cuts").click()
        tab.page.get_by_label("velocity", exact=True).check()
        tab.wait_for_traces(lambda found: sum(one["name"] == "measured" for one in found) == 4)
        assert tab.complaints == []
    finally:
        tab.close()
