"""Presses in lists that the server redraws: none is lost, and none is made up, however late an answer comes."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from workbench.conftest import Served
from workbench.tab import Tab

from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.data import pressed
from pneumo_ros.workbench.desk import Desk, Given
from pneumo_ros.workbench.machine_panel import _choose, _tick

ROLES = "[...document.querySelectorAll('#bags .bag')].map((one) => one.querySelector('input:checked').value)"
SHOWN = "document.querySelector('#bags .shown .name').textContent"


@pytest.fixture
def tab(browser: Any, served: Served) -> Iterator[Tab]:
    """A tab whose plot is drawn."""
    opened = Tab(browser, served.address)
    opened.wait_for_traces(len)
    yield opened
    opened.close()
    assert opened.complaints == []


def radio(tab: Tab, run: str, role: str) -> Any:
    """The button of a role of a recording."""
    return tab.page.get_by_role("group", name=f"What {run} is for").get_by_label(role, exact=True)


def until(tab: Tab, what: str, wanted: Any) -> None:
    """Wait until the page gives this value, and keeps it when the late answers have come."""
    tab.page.wait_for_function(f"(wanted) => JSON.stringify({what}) === JSON.stringify(wanted)", arg=wanted)
    tab.page.wait_for_timeout(2000)
    assert tab.page.evaluate(what) == wanted


def test_a_run_is_shown_though_the_list_is_redrawn_meanwhile(tab: Tab) -> None:
    tab.answer_late("tab.value")
    for run, role, roles in (("train_steps", "leave out", ["out", "fit"]), ("holdout_steps", "fit", ["fit", "fit"])):
        tab.press(run)
        radio(tab, "holdout_steps", role).click()
        until(tab, ROLES, roles)
        until(tab, SHOWN, run)


def test_two_presses_are_kept_though_the_lists_are_redrawn_late(tab: Tab) -> None:
    tab.answer_late("revision")
    radio(tab, "holdout_steps", "leave out").click()
    tab.page.wait_for_timeout(700)  # the lists are asked for, and their answers are on their way
    radio(tab, "train_steps", "hold out").click()
    until(tab, ROLES, ["out", "hold"])


def test_a_tick_is_kept_though_the_effects_are_redrawn_late(tab: Tab) -> None:
    tab.answer_late("revision")
    tab.tick("payload mass")
    tab.tick("viscous friction")
    tab.see("#next", "with payload mass and viscous friction")
    boxes = "[...document.querySelectorAll('#effects .extra input:checked')].map((one) => one.value).sort()"
    until(tab, boxes, ["payload_mass", "viscous_friction"])


def test_a_press_of_what_does_not_exist_is_said(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Given())
    presses = {"effect": _tick, "variant": _choose}
    with pytest.raises(UsageError, match="nothing to press"):
        pressed(presses, desk, {"what": "door"})
    pressed(presses, desk, {"what": "effect", "of": "no_such_effect", "value": True})
    assert desk.message == "there is no effect 'no_such_effect'"
    pressed(presses, desk, {"what": "variant", "of": None, "value": "7"})
    assert desk.message == "there is no variant 7"
    pressed(presses, desk, {"what": "effect", "of": "payload_mass", "value": True})
    assert "payload_mass" in desk.ticked
