"""A force from outside on a running simulator: `external/force` in, `load_cell` out, in recordings and replays."""

import json
import math
import time
from pathlib import Path

import numpy as np
import pytest
from ros.probe import RELIABLE, probe
from ros.processes import PATIENCE, node, recorded, running
from std_msgs.msg import Float64

from pneumo_ros.axis.simulator.force_input import ForceInput
from pneumo_ros.plant import Library, load_model, model_from_dict
from pneumo_ros.records import read_recording

AXIS = load_model("axis")
PUSH = 160.0  # N; breakaway is 100 N, and the trapped air is a soft spring


def test_a_push_moves_the_rod_and_a_recording_of_it_explains_itself(tmp_path: Path) -> None:
    place = ("-r", "__ns:=/pushed")
    with running(*node("simulator", *place), cwd=tmp_path) as plant, probe("pushed") as one:
        force = one.node.create_publisher(Float64, "external/force", RELIABLE)
        with running(*node("recorder", *place, output=tmp_path / "bag"), cwd=tmp_path) as recorder:
            one.matched(one.command, force)
            deadline = time.monotonic() + PATIENCE
            while recorded(tmp_path / "bag", "/pushed/joint_states") < 100:
                assert time.monotonic() < deadline, recorder.said
                one.send(0.0)
            force.publish(Float64(data=PUSH))
            moved = one.wait(lambda: one.more("joint_states")[-1].position[0] > 0.1, "a moved rod")
            assert moved
            assert float(one.health("pushed/simulator")[1]["external_force_N"]) == PUSH
            force.publish(Float64(data=math.nan))
            one.wait(lambda: one.health("pushed/simulator")[1]["rejected_inputs"] == "1", "a refusal")
            force.publish(Float64(data=0.0))
            one.wait(lambda: float(one.health("pushed/simulator")[1]["external_force_N"]) == 0.0, "its end")
            assert recorder.end() == 0
        assert plant.end() == 0
    recording = read_recording(tmp_path / "bag")
    assert recording.load_cell is not None
    assert recording.load_cell[0] == 0.0
    assert recording.load_cell.max() == PUSH
    assert set(np.round(recording.load_cell[-5:], 9)) == {0.0}
    described = model_from_dict(recording.description["model"], "described", Library())
    assert list(described.effects) == [*AXIS.effects, "measured_load"]
    drive = np.column_stack((recording.voltage, recording.load_cell))[:-1]
    begin = described.state(y=float(recording.position[0]))
    step = float(np.diff(recording.time).mean())
    again = described.simulate(drive, begin, sample_time=step)[:, 0]
    assert np.abs(again - recording.position[1:]).max() < 0.005 * np.ptp(recording.position)
    replayed(tmp_path, float(np.ptp(recording.position)))


def replayed(folder: Path, moved: float) -> None:
    """A new simulator is pushed by what the player sends of the recording, about as far."""
    place = ("-r", "__ns:=/pushed")
    player = node("player", *place, input=folder / "bag", topics=["*external/force"])
    with running(*node("simulator", *place), cwd=folder) as plant, probe("pushed") as one:
        one.more("joint_states")
        with running(*player, cwd=folder) as playing:
            one.wait(lambda: one.heard["joint_states"][-1].position[0] > 0.7 * moved, "the same motion")
            assert playing.end() == 0
        assert plant.end() == 0


@pytest.mark.parametrize(("timeout", "later"), [(0.0, 50.0), (0.5, 0.0)])
def test_a_force_is_held_until_the_next_or_as_long_as_asked(timeout: float, later: float) -> None:
    force = ForceInput()
    force.timeout = timeout
    assert force.at(0.0) == 0.0
    assert force.accept(50.0)
    assert [force.at(1.0), force.at(1.4), force.at(1.6)] == [50.0, 50.0, later]
    assert not force.accept(math.inf)
    assert (force.accepted, force.refused) == (1, 1)
    force.reset()
    assert force.at(0.0) == 0.0


def test_the_description_names_the_load_only_after_a_force(tmp_path: Path) -> None:
    with running(*node("simulator", "-r", "__ns:=/described"), cwd=tmp_path) as plant, probe("described") as one:
        force = one.node.create_publisher(Float64, "external/force", RELIABLE)
        one.matched(force)
        machines = one.heard["description"]
        one.wait(lambda: machines, "a description")
        assert "measured_load" not in json.loads(machines[-1].data)["model"]["effects"]
        force.publish(Float64(data=1.0))
        one.wait(lambda: "measured_load" in json.loads(machines[-1].data)["model"]["effects"], "the load's name")
        assert plant.end() == 0
