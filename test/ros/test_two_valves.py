"""A valve for each chamber: the controller sends both commands, the simulator takes both, a recording holds both."""

from pathlib import Path

import numpy as np
from ros.axis_probe import AxisProbe
from ros.processes import node, running

from pneumo_ros.plant import load_model, save_model
from pneumo_ros.records import read_recording

PLACE = "two_valves"


def test_a_controller_moves_two_valves_and_the_recording_holds_both_commands(tmp_path: Path) -> None:
    axis = load_model("axis")
    limits = {"second_valve.fill_limit": 0.78, "second_valve.empty_limit": 0.78, "second_valve.offset": -5.0}
    machine = save_model(axis.with_effects(["second_valve", *axis.effects], limits), tmp_path / "two.yaml")
    place = ("-r", f"__ns:=/{PLACE}")
    with running(*node("simulator", *place, model=str(machine), publish_rate=200.0), cwd=tmp_path) as simulator:
        probe = AxisProbe(PLACE)
        probe.wait(lambda: probe.heard["joint_states"], "a joint state", 30.0)
        with running(*node("recorder", *place, output="run"), cwd=tmp_path) as recorder:
            recorder.wait_for("recording to")
            with running(*node("controller", "--params-file", str(machine), *place), cwd=tmp_path) as controller:
                probe.wait(lambda: probe.heard["valve/command"], "a command")
                probe.aim(0.05)
                probe.arrives(0.05)
                assert controller.end() == 0
            assert recorder.end() == 0
        probe.close()
        assert simulator.end() == 0
    recording = read_recording(tmp_path / "run")
    assert recording.command is not None
    assert recording.command_b is not None
    assert recording.command_b[-1] == 5.0, "the valve of chamber b is closed at last"
    assert np.ptp(recording.command) > 1.0
    against = 5.0 - recording.command_b  # each command of chamber b moves against one of chamber a
    assert {*np.round(against, 9)} <= {*np.round(recording.command, 9)}
