"""The page of a commissioning, with a real node in the role of the rig: wrong plugs are named; the verb is the same."""

import signal
from pathlib import Path

import pytest
from ros.processes import node, running
from workbench.conftest import Served
from workbench.tab import Tab

from pneumo_ros.command.main import _verb, verb_parser
from pneumo_ros.workbench.commission_panel import command
from pneumo_ros.workbench.desk import Desk, Given

FAST = {"real_time_factor": 0.0, "lockstep_timeout": 10.0, "lockstep_wait": 60.0, "publish_velocity": False}


def test_the_page_calls_the_verb_with_its_fields(tmp_path: Path) -> None:
    given = {"place": "/rig", "closed": "5V", "sensors": "", "minutes": "2", "timeout": ""}
    line = command(Desk(tmp_path, Given()), given, True)
    options = verb_parser("commission", _verb("commission")).parse_strictly(line[1:])
    assert (options.namespace, options.closed, options.minutes, options.as_wired) == ("rig", "5V", 2.0, True)
    assert (options.model, options.out, options.folder) == ("axis", "commissioned_1.yaml", "commissioned_1_runs")


@pytest.mark.check
def test_wrong_plugs_are_named_on_the_page(browser: object, tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="comes with ROS 2, or with the extra 'ros'")
    plant = node("simulator", "-r", "__ns:=/paged", **FAST, wired_as="bar,gauge,swapped-chambers", noise_pressure=300.0)
    with running(*plant, cwd=tmp_path) as simulator:
        served = Served(tmp_path)
        tab = Tab(browser, served.address)
        tab.view("Commission")
        for label, value in (("Namespace", "paged"), ("Pressure sensors", "gauge-bar"), ("Silence", "20000")):
            tab.page.locator("#panel-commission").get_by_label(label).fill(value)
        tab.page.keyboard.press("Tab")
        tab.press("Commission")
        tab.see("#commission-content", "swap the plugs of the two pressure sensors")
        assert tab.complaints == []
        tab.close()
        assert served.close() == 0
        assert simulator.end(signal.SIGINT) == 0, simulator.said
