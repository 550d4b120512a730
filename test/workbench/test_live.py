"""The live tab with real nodes: the motion of the axis, a parameter set and one refused, and a recording."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from ros.processes import Running
from workbench.conftest import Served
from workbench.tab import Tab

from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.live import Live

CONFIG = Path(__file__).parents[2] / "pneumo_ros" / "config" / "axis.yaml"
COULOMB = "lugre_friction.coulomb_friction"


@pytest.fixture
def axis(tmp_path: Path) -> Iterator[None]:
    """A simulator and a controller that moves it along a sine."""
    pytest.importorskip("rclpy", reason="comes with ROS 2, or with the extra 'ros'")
    given = ("--ros-args", "-r", "__ns:=/cylinder", "--params-file", str(CONFIG))
    nodes = [
        Running("-m", "pneumo_ros.ros.simulator", *given, cwd=tmp_path),
        Running("-m", "pneumo_ros.ros.controller", *given, "-p", "reference.shape:=sine", cwd=tmp_path),
    ]
    yield
    for node in nodes:
        node.end()


@pytest.fixture
def live(browser: object, tmp_path: Path) -> Iterator[Tab]:
    """A tab of a workbench without recordings, on the live view."""
    running = Served(tmp_path)
    tab = Tab(browser, running.address)
    tab.view("Live")
    tab.page.locator("#namespace").fill("cylinder")
    yield tab
    tab.close()
    assert running.close() == 0


def set_parameter(tab: Tab, value: str) -> None:
    """Ask the simulator to take a value."""
    tab.page.get_by_label("Parameter ").fill(COULOMB)
    tab.page.get_by_label("Value ").fill(value)
    tab.page.keyboard.press("Tab")
    tab.press("Set")


@pytest.mark.usefixtures("axis")
def test_a_live_axis_is_watched_set_and_recorded(live: Tab) -> None:
    live.press("Watch")
    live.see("#live-says", "The piston ")
    names = "one => one._fullData.map(t => t.name)"
    live.see("#live-plot .main-svg")
    for _ in range(100):
        shown = live.page.locator("#live-plot").evaluate(names)
        if {"position", "setpoint", "velocity", "pressure a", "pressure b", "voltage"} <= set(shown):
            break
        live.page.wait_for_timeout(100)
    assert {"position", "setpoint", "velocity", "pressure a", "pressure b", "voltage"} <= set(shown)
    live.see("#live-status", "cylinder/simulator: ")
    live.see("#live-says", "Over the last second the model was off by: position ")
    assert {"predicted position", "predicted pressure a"} <= set(live.page.locator("#live-plot").evaluate(names))
    colours = "one => one._fullData.filter(t => t.name.includes('pressure')).map(t => t.line.color + t.line.dash)"
    assert len(set(live.page.locator("#live-plot").evaluate(colours))) == 4, "two pressures, measured and predicted"
    assert " ," not in live.see("#live-status", "cylinder/controller: ").inner_text(), "a value that is empty"
    live.press("Record")
    set_parameter(live, "-5")
    live.see("#set-says", "Refused: ")
    set_parameter(live, "65")
    live.see("#set-says", "Set.")
    live.page.wait_for_timeout(2000)
    live.press("Stop recording")
    live.see("#bags", "live_1")
    assert live.page.locator("#bags .problem").count() == 0
    live.press("Stop watching")
    live.see("#watch", "Watch")


def test_a_namespace_is_a_name(tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="comes with ROS 2, or with the extra 'ros'")
    with pytest.raises(UsageError, match="is no namespace"):
        Live("a b; -p x", tmp_path)


def test_a_node_is_a_name_and_a_value_a_number(tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="comes with ROS 2, or with the extra 'ros'")
    live = Live("cylinder", tmp_path)
    try:
        with pytest.raises(UsageError, match="is not the name of a node"):
            live.set("../simulator", COULOMB, 1.0)
        with pytest.raises(UsageError, match="is not the name of a node"):
            live.set("simulator", COULOMB, float("nan"))
    finally:
        live.close()


def test_the_watcher_ends_with_its_input() -> None:
    pytest.importorskip("rclpy", reason="comes with ROS 2, or with the extra 'ros'")
    import subprocess

    line = [sys.executable, "-m", "pneumo_ros.ros.watcher"]
    done = subprocess.run(line, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
