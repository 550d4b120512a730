"""Signals of a run by name: derived ones, any topic, over another signal, and of other runs."""

import base64
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from workbench.tab import Tab

from pneumo_ros.records import read_recording
from pneumo_ros.workbench.bags import Bag
from pneumo_ros.workbench.columns import columns
from pneumo_ros.workbench.curves import EFFORT, INPUT, VELOCITY, Rig, curve
from pneumo_ros.workbench.signals import Source, View, signals_chart

RIG = Rig(4.1e-4, 3.0e-4, 1e5)


def source(leaking: Path, name: str) -> Source:
    """A recording with all its columns."""
    recording = read_recording(leaking / name)
    return Source(Bag(name, str(leaking / name), "fit"), recording, columns(leaking / name, recording), RIG)


def unpacked(trace: dict[str, Any], axis: str) -> np.ndarray:
    """x or y of a trace."""
    return np.frombuffer(base64.b64decode(trace[axis]["bdata"]), "<f8")


def test_every_number_of_every_topic_has_a_name_and_the_time_of_the_run(leaking: Path) -> None:
    one = source(leaking, "train_steps")
    (position,) = [name for name in one.columns if name.endswith("joint_states position[0]")]
    time, values = one.columns[position]
    assert time == pytest.approx(one.recording.time, abs=1e-9)
    assert values == pytest.approx(one.recording.position)
    (command,) = [name for name in one.columns if name.endswith("valve/command data")]
    assert abs(one.columns[command][0][0]) < 1.0  # s, though it is timed by when it was recorded


def test_velocity_and_force_follow_from_what_was_measured(leaking: Path) -> None:
    one = source(leaking, "train_steps")
    velocity, force = one.curve(VELOCITY), one.curve(EFFORT)
    assert velocity is not None
    assert force is not None
    moved = np.concatenate(
        [[0.0], np.cumsum(0.5 * np.diff(velocity.time) * (velocity.values[1:] + velocity.values[:-1]))]
    )
    assert moved == pytest.approx(one.recording.position - one.recording.position[0], abs=2e-3)
    a, b = one.recording.signals["pressure_a"], one.recording.signals["pressure_b"]
    assert force.values == pytest.approx(4.1e-4 * (a - 1e5) - 3.0e-4 * (b - 1e5))
    assert curve("no such signal", one.recording, RIG, one.columns) is None


def test_a_signal_is_drawn_over_another_one_within_the_seconds_in_view(leaking: Path) -> None:
    one = source(leaking, "train_steps")
    view = View(["position_m", INPUT], (1.0, 2.0), over=VELOCITY)
    chart = signals_chart(one, view, {})
    assert (chart["x"], chart["span"], chart["shades"]) == ("velocity from positions [m/s]", None, [])
    drawn = chart["panels"][0]["traces"][0]
    inside = (one.recording.time >= 1.0) & (one.recording.time <= 2.0)
    velocity = one.curve(VELOCITY)
    assert velocity is not None
    assert unpacked(drawn, "x") == pytest.approx(velocity.values[inside])
    assert unpacked(drawn, "y") == pytest.approx(1e3 * one.recording.position[inside])


def test_other_runs_are_laid_over_each_in_its_colour(leaking: Path) -> None:
    one, other = source(leaking, "train_steps"), source(leaking, "holdout_steps")
    chart = signals_chart(one, View(["pressure_a_pa"]), {}, [other])
    assert [(t["name"], t["role"]) for t in chart["panels"][0]["traces"]] == [
        ("measured", "measured"), ("measured, holdout_steps", "free"),
    ]  # fmt: skip


def pick(tab: Tab, where: str, what: str) -> None:
    """Choose from a drop-down list by the keyboard."""
    tab.page.locator(f"#{where}").focus()
    tab.page.keyboard.press("Enter")
    opened = tab.page.locator(".dash-dropdown-content")  # check boxes of the page are options, too
    opened.get_by_role("option", name=what, exact=True).last.click()
    tab.page.keyboard.press("Escape")
    opened.wait_for(state="hidden")


def test_runs_topics_and_axes_are_chosen_in_the_page(tab: Tab) -> None:
    tab.wait_for_traces(lambda found: len(found) == 4)
    pick(tab, "also", "train_steps")
    tab.wait_for_traces(lambda found: any(one["name"] == "measured, train_steps" for one in found))
    pick(tab, "over", "position")
    over = tab.wait_for_traces(lambda found: found and found[0]["x"] != sorted(found[0]["x"]))
    assert max(over[0]["x"]) > 20.0  # mm, no seconds
