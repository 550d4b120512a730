"""A valve of 0 to 10 V, closed at 5 V: nothing moves without a command, and every node closes it at 5 V."""

from pathlib import Path

import pytest
from ros.axis_probe import AxisProbe
from ros.processes import node, running

from pneumo_ros.plant import load_model, save_model

PLACE = "half_range"
CLOSED = 5.0  # V


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """The default machine behind such a valve."""
    axis = load_model("axis")
    made = axis.with_effects(["valve_null_offset", *axis.effects], {"valve_null_offset.offset": -CLOSED})
    return save_model(made, tmp_path / "half_range.yaml")


def test_the_piston_rests_until_it_is_asked_and_the_valve_is_closed_at_its_signal(
    machine: Path, tmp_path: Path
) -> None:
    place = ("-r", f"__ns:=/{PLACE}")
    with running(*node("simulator", *place, model=str(machine), publish_rate=200.0), cwd=tmp_path) as simulator:
        probe = AxisProbe(PLACE)
        probe.wait(lambda: probe.heard["joint_states"], "a joint state", 30.0)
        probe.rests(1.0, 1e-6)  # it slammed to its end with 7 bar in a chamber where closed was 0 V
        with running(*node("controller", "--params-file", str(machine), *place), cwd=tmp_path) as controller:
            controller.wait_for("valve closed at 5 V")
            probe.wait(lambda: probe.heard["valve/command"], "a command")
            assert probe.voltage == CLOSED
            probe.aim(0.1)
            probe.arrives(0.1)
            signals = [message.data for message in probe.heard["valve/command"]]
            assert 0.0 <= min(signals) < CLOSED < max(signals) <= 10.0
            assert controller.end() == 0
        probe.wait(lambda: float(probe.health(f"{PLACE}/simulator")[1]["voltage_V"]) == CLOSED, "a closed valve")
        probe.comes_to_rest()
        probe.close()
        assert simulator.end() == 0


def test_a_controller_moves_a_rig_that_is_wired_otherwise_by_its_rig_file(tmp_path: Path) -> None:
    """Millimetres from one end, gauge bar, both pressure plugs and the command swapped, a valve that closes at 5 V."""
    words, place = "bar,mm,gauge,swapped-chambers,reversed-voltage,zero=1000mm,closed=5V", ("-r", "__ns:=/wired")
    save_model(load_model("axis"), tmp_path / "axis.yaml")
    (tmp_path / "rig.yaml").write_text(f"rig: {{machine: axis.yaml, read_as: '{words}', range: 0V..10V}}")
    plant = node("simulator", *place, wired_as=words, publish_rate=200.0)
    line = node("controller", *place, closed_signal="", rig=str(tmp_path / "rig.yaml"))
    with running(*plant, cwd=tmp_path) as simulator, running(*line, cwd=tmp_path) as controller:
        controller.wait_for("valve closed at 5 V")
        probe = AxisProbe("wired")
        probe.wait(lambda: probe.heard["valve/command"], "a command")
        assert probe.position == pytest.approx(1000.0, abs=1.0)  # mm, as the rig sends it
        probe.aim(0.1)
        probe.wait(lambda: abs(probe.position - 1100.0) < 3.0, "the goal")
        assert min(message.data for message in probe.heard["valve/command"]) < 4.0  # reversed
        probe.close()
        assert controller.end() == 0
        assert simulator.end() == 0
