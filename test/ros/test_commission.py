"""`pneumo commission` with real nodes: the wiring of a live plant, and a whole commissioning."""

import json
import signal
from importlib import import_module
from pathlib import Path

import pytest
from ros.probe import probe
from ros.processes import node, running
from std_msgs.msg import String

from pneumo_ros.axis.commission.job import command_line
from pneumo_ros.axis.commission.settings import SETTINGS
from pneumo_ros.command.main import verb_parser
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import load_model, save_model
from pneumo_ros.ros.qos import LATCHED

WISHES = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
LONG = 300.0  # s: moves of a minute and all fits, beside other tests
NOISE = {"noise_position": 5e-6, "noise_pressure": 300.0, "publish_velocity": False}


def commission(namespace: str, *arguments: str) -> list[str]:
    """Command line of `pneumo commission` in a namespace, patient with a busy machine."""
    return ["-m", "pneumo_ros", "commission", "--namespace", namespace, "--timeout", "5000", *arguments]


@pytest.mark.check
def test_the_wiring_of_a_live_plant_is_found_while_it_is_moved_as_told(tmp_path: Path) -> None:
    """Commands go out as the words say, so that the plant gets them reversed."""
    plant = node("simulator", "-r", "__ns:=/wired", **NOISE)
    line = commission(
        "wired", "--read-as", "reversed-voltage", "--sensors", "absolute-Pa", "--stage", "0", "--out", "mine.yaml",
        "--json", "wiring.json",
    )  # fmt: skip
    with running(*plant, cwd=tmp_path) as simulator, running(*line, cwd=tmp_path) as command:
        assert command.end(None) == 0, command.said
        assert simulator.end(signal.SIGINT) == 0, simulator.said
    found = json.loads((tmp_path / "wiring.json").read_text(encoding="utf-8"))
    assert found["wiring"] == {"read_as": [], "certain": True, "swap": {}}
    assert "read_as:" in (tmp_path / "mine_rig.yaml").read_text(encoding="utf-8")
    assert (tmp_path / "mine_runs" / "00_wiring" / "plumbing").is_dir()


@pytest.mark.check
def test_a_plant_is_commissioned_and_a_second_call_reads_what_was_recorded(tmp_path: Path) -> None:
    sheet = design(WISHES, load_shelf([])).model
    save_model(sheet, tmp_path / "sheet.yaml")
    more = {"lugre_friction.coulomb_friction": 30.0, "lugre_friction.static_friction": 45.0}
    save_model(sheet.with_parameters(more), tmp_path / "truth.yaml")
    plant = node("simulator", "-r", "__ns:=/whole", "--params-file", "truth.yaml", **NOISE)
    line = commission(
        "whole", "--model", "sheet.yaml", "--closed", "0V", "--sensors", "absolute-Pa", "--minutes", "0.1",
        "--evaluations", "3", "--out", "mine.yaml", "--json", "found.json", "--report", "page.html",
    )  # fmt: skip
    with running(*plant, cwd=tmp_path) as simulator, running(*line, cwd=tmp_path) as command:
        assert command.end(None, patience=LONG) == 0, command.said
        assert simulator.end(signal.SIGINT) == 0, simulator.said
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert found["parameters"]["lugre_friction.coulomb_friction"]["value"] == pytest.approx(30.0, rel=0.03)
    assert load_model(tmp_path / "mine.yaml").uncertainty["lugre_friction.coulomb_friction"] < 2.0
    for name in ("mine_cascade.yaml", "mine_rig.yaml", "page.html"):
        assert (tmp_path / name).is_file()
    with running(*line, "--overwrite", cwd=tmp_path) as again:  # no plant runs any more
        assert again.end(None, patience=LONG) == 0, again.said
    assert "recorded before" in again.said


def test_the_node_says_what_to_swap_and_publishes_it(tmp_path: Path) -> None:
    """A simulator that plays a rig with gauge sensors in bar, plugged to the wrong chambers; begun by a service."""
    place = ("-r", "__ns:=/plugged")
    fast = {"real_time_factor": 0.0, "lockstep_timeout": 10.0, "lockstep_wait": 60.0}
    plant = node("simulator", *place, **NOISE, **fast, wired_as="bar,gauge,swapped-chambers")
    given = {"stage": 0, "sensors": "gauge-bar", "auto": False, "output": "mine.yaml", "measurement_timeout": 10.0}
    with running(*plant, cwd=tmp_path) as simulator, running(*node("commission", *place, **given), cwd=tmp_path) as one:
        one.wait_for("call ~/start")
        with probe("plugged") as asks:
            results = asks.hear("commission/result", String, LATCHED)
            assert asks.trigger("commission/start").success
            asks.wait(lambda: results, "a result", 300.0)
            message, values = asks.health("plugged/commission")
            assert "swap the plugs of the two pressure sensors" in message
            assert values["state"] == "waits for plugs to be mended, or for as_wired"
        found = json.loads(results[-1].data)
        assert one.end() == 0, one.said
        assert simulator.end(signal.SIGINT) == 0, simulator.said
    assert found["exit_code"] == 1
    assert set(found["wiring"]["swap"]) == {"swapped-chambers"}
    assert "swapped-chambers: swap the plugs" in one.said


@pytest.mark.parametrize("again", [0, 1])
def test_the_node_calls_the_verb_with_its_parameters(again: int) -> None:
    values = {setting.name: setting.default for setting in SETTINGS}
    line = command_line({**values, "closed_signal": "5V", "as_wired": True, "output": "a/b.yaml"}, "rig", again)
    verb = import_module("pneumo_ros.command.verb.commission")
    options = verb_parser("commission", verb).parse_strictly(line[1:])
    assert (options.closed, options.as_wired, options.out, options.namespace) == ("5V", True, "a/b.yaml", "rig")
    assert options.folder == ("a/b_runs_2" if again else "a/b_runs")
    assert (options.stage, options.rig_file, options.timeout) == (3, None, 200.0)
