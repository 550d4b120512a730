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
        probe.wait(lambda: probe.voltage == CLOSED, "the closed signal as the last command")
        probe.comes_to_rest()
        probe.close()
        assert simulator.end() == 0
