"""Experiments with real nodes: a campaign on the simulator, and every way in which a plant can fail."""

import json
import math
import signal
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from ros.probe import probe
from ros.processes import Running, node, running
from ros.scripted_plant import ScriptedPlant, scripted_plant, until

from pneumo_ros.equations.breakaway import find_breakaways
from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.programme_file import programme_text
from pneumo_ros.experiment.voltages import Constant
from pneumo_ros.plant import load_model
from pneumo_ros.records import Recording, read_recording, read_topics
from pneumo_ros.runs.run import make_run

AXIS = load_model("axis")
TRIALS = tuple(Trial(name, Constant(volts), 20.0, 20.0, 0.5) for name, volts in (("right", 1.0), ("left", -1.0)))
PROGRAMME = Programme("test", "scripted", -0.4, 0.4, 0.5, 2.0, 2.0, TRIALS, 0.3)


def pneumo(*arguments: str) -> list[str]:
    """Command line of `pneumo experiment`."""
    return ["-m", "pneumo_ros", "experiment", *arguments]


def experiment(folder: Path, namespace: str, rounds: int = 1, **parameters: object) -> list[str]:
    """Command of the node, with the programme of two trials that a scripted plant runs in seconds, `rounds` times."""
    trials = tuple(
        replace(trial, name=f"{trial.name}_{k}" if k else trial.name) for k in range(rounds) for trial in TRIALS
    )
    (folder / "programme.yaml").write_text(programme_text(replace(PROGRAMME, trials=trials)), encoding="utf-8")
    given = {"programme": folder / "programme.yaml", "output": folder / "out", "measurement_timeout": 1.0, **parameters}
    return node("experiment", "-r", f"__ns:=/{namespace}", **given)


def summary(folder: Path) -> dict:
    """The JSON file that the node wrote beside the recordings."""
    return json.loads((folder / "out" / "experiment.json").read_text(encoding="utf-8"))


# --- on the simulator ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict, str]:
    """Two voltages both ways on a simulator in lockstep: folder, JSON result, and the output."""
    folder = tmp_path_factory.mktemp("campaign")
    plant = node(
        "simulator", "-r", "__ns:=/campaign", real_time_factor=0.0, publish_rate=500.0, publish_velocity=False,
        noise_position=5e-6, noise_pressure=300.0, lockstep_timeout=10.0, lockstep_wait=60.0,
    )  # fmt: skip
    line = pneumo(
        "constant-voltage", "--voltages", "2", "0.9", "--seconds", "1.5", "--namespace", "campaign",
        "--out", "out", "--json", "result.json", "--timeout", "10000",
    )  # fmt: skip
    with running(*plant, cwd=folder) as simulator, running(*line, cwd=folder) as command:
        assert command.end(None) == 0, command.said
        assert simulator.end(signal.SIGINT) == 0, simulator.said
    return folder / "out", json.loads((folder / "result.json").read_text(encoding="utf-8")), command.said


NAMES = ["constant_p0900", "constant_m0900", "constant_p2000", "constant_m2000"]


def recordings(folder: Path) -> list[Recording]:
    """The campaign's recordings in the order of the programme."""
    return [read_recording(folder / name) for name in NAMES]


def test_the_campaign_is_complete_slowest_first(campaign: tuple[Path, dict, str]) -> None:
    folder, result, said = campaign
    assert result["complete"] is True
    assert result["exit_code"] == 0
    assert [trial["name"] for trial in result["trials"]] == NAMES
    assert {path.name for path in folder.iterdir()} == {*NAMES, "programme.yaml", "experiment.json"}
    starts = [recording.start_ns for recording in recordings(folder)]
    assert starts == sorted(starts)
    assert "pneumo identify out" in said


def test_recordings_are_whole_and_timed_by_the_simulated_clock(campaign: tuple[Path, dict, str]) -> None:
    for recording in recordings(campaign[0]):
        assert recording.warnings == ()
        assert recording.namespace == "campaign"
        assert np.diff(recording.time).max() == pytest.approx(0.002, rel=1e-6)
        assert recording.description is not None
        assert recording.description["model"]["piston"]["mass"] == AXIS["piston.mass"]


def test_each_run_holds_its_voltage_after_a_rest_and_slides(campaign: tuple[Path, dict, str]) -> None:
    folder, result, _ = campaign
    for recording, trial in zip(recordings(folder), result["trials"], strict=True):
        volts = float(trial["voltage"].split()[0])
        assert recording.voltage is not None
        opened = int(np.argmax(recording.voltage != 0.0))
        assert recording.time[opened] == pytest.approx(0.6, abs=0.005)
        assert set(recording.voltage[opened:]) == {volts}
        assert np.ptp(recording.position[:opened]) < 1e-3
        assert trial["speed_m_s"] * volts > 0.0
        (breakaway,) = find_breakaways(AXIS, make_run(recording))
        assert breakaway.direction == np.sign(volts)
        assert breakaway.time > recording.time[opened]


def test_the_piston_stays_inside_the_limits(campaign: tuple[Path, dict, str]) -> None:
    assert max(np.abs(recording.position).max() for recording in recordings(campaign[0])) < 0.95


def test_commands_are_recorded_as_they_acted(campaign: tuple[Path, dict, str]) -> None:
    """In lockstep everything repeats: the model, driven by the recorded voltage, moves as the simulator did."""
    recording = recordings(campaign[0])[2]
    run = make_run(recording)
    assert recording.pressure_a is not None
    assert recording.pressure_b is not None
    start = AXIS.state(
        y=float(recording.position[:50].mean()),
        p_a=float(recording.pressure_a[:50].mean()),
        p_b=float(recording.pressure_b[:50].mean()),
    )
    predicted = AXIS.simulate(run.held, start, sample_time=run.sample_time)[:, 0]
    assert np.abs(predicted - recording.position[1:]).max() < 2e-3


# --- the end of an experiment ---------------------------------------------------------------------------------------


def in_trial(plant: ScriptedPlant, process: Running, name: str = "right") -> None:
    """Until the trial has opened the valve."""
    process.wait_for(f": {name}")
    until(lambda: plant.commands and abs(plant.commands[-1]) == 1.0, "the trial's voltage")
    time.sleep(0.2)


def ended(plant: ScriptedPlant, process: Running, code: int, said: str) -> None:
    """The process ends with `code` and the text `said`, and the valve is closed."""
    assert process.end(None) == code, process.said
    assert said in process.said
    until(lambda: plant.commands[-1] == 0.0, "a closed valve")


def test_all_trials_of_a_scripted_plant(tmp_path: Path) -> None:
    with scripted_plant("whole") as plant, running(*experiment(tmp_path, "whole"), cwd=tmp_path) as process:
        ended(plant, process, 0, "all trials are done; 2 of 2 recorded")
    assert [trial["ended"] for trial in summary(tmp_path)["trials"]] == ["travel", "travel"]
    assert (tmp_path / "out" / "programme.yaml").read_text(encoding="utf-8") == programme_text(PROGRAMME)
    for name, volts in (("right", 1.0), ("left", -1.0)):
        recording = read_recording(tmp_path / "out" / name)
        assert recording.voltage is not None
        assert sorted(set(recording.voltage)) == sorted({0.0, volts})
        for topic in ("joint_states", "chamber_a/pressure", "chamber_b/pressure"):  # everything sent, in between
            stamps = read_topics(tmp_path / "out" / name)[f"/whole/{topic}"].stamp.tolist()
            first = plant.stamps.index(stamps[0])
            assert stamps == plant.stamps[first : first + len(stamps)]


FAILURES: dict[str, tuple[Callable[[ScriptedPlant], object], int, str]] = {
    "end_stop": (lambda plant: setattr(plant, "position", 0.995), 1, "has reached the end stop"),
    "nan": (lambda plant: setattr(plant, "position", math.nan), 1, "the position is nan"),
    "nan_pressure": (lambda plant: setattr(plant, "pressure", math.nan), 3, "chamber_a/pressure is nan"),
    "no_position": (lambda plant: plant.silent.add("joint_states"), 1, "no new joint_states for 1 s"),
    "no_pressure": (lambda plant: plant.silent.add("chamber_b/pressure"), 1, "no chamber_b/pressure for 1 s"),
    "wrong_way": (lambda plant: setattr(plant, "reverse", True), 1, "the wrong way"),
}


@pytest.mark.parametrize("name", FAILURES)
def test_a_failing_plant_is_stopped_and_what_was_recorded_is_kept(name: str, tmp_path: Path) -> None:
    fail, code, said = FAILURES[name]
    with scripted_plant(name) as plant, running(*experiment(tmp_path, name), cwd=tmp_path) as process:
        in_trial(plant, process)
        fail(plant)
        ended(plant, process, code, said)
    assert summary(tmp_path)["complete"] is False
    assert said in summary(tmp_path)["reason"]
    recording = read_recording(tmp_path / "out" / "right")
    assert recording.voltage is not None
    assert set(recording.voltage) <= {0.0, 1.0}
    assert recording.duration > 0.3


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_closes_the_valve_first(number: signal.Signals, tmp_path: Path) -> None:
    with scripted_plant("halt") as plant, running(*experiment(tmp_path, "halt"), cwd=tmp_path) as process:
        in_trial(plant, process)
        process.process.send_signal(number)
        ended(plant, process, 130, "interrupted during trial 1 of 2")
    assert read_recording(tmp_path / "out" / "right").duration > 0.3


def on_plant(tmp_path: Path, namespace: str) -> list[str]:
    """`pneumo experiment` with the scripted plant's programme."""
    (tmp_path / "two.yaml").write_text(programme_text(PROGRAMME), encoding="utf-8")
    return pneumo("two.yaml", "--closed", "0V", "--namespace", namespace, "--out", "out", "--timeout", "2000")


def test_ctrl_c_at_the_command_closes_the_valve(tmp_path: Path) -> None:
    with scripted_plant("ctrl_c") as plant, running(*on_plant(tmp_path, "ctrl_c"), cwd=tmp_path) as process:
        in_trial(plant, process)
        process.process.send_signal(signal.SIGINT)
        ended(plant, process, 130, "interrupted during trial 1 of 2; the valve is closed")
    assert "Traceback" not in process.said
    assert read_recording(tmp_path / "out" / "right").duration > 0.3


def test_a_killed_command_takes_its_node_along(tmp_path: Path) -> None:
    with scripted_plant("killed") as plant, running(*on_plant(tmp_path, "killed"), cwd=tmp_path) as process:
        in_trial(plant, process)
        process.process.kill()
        until(lambda: plant.commands[-1] == 0.0, "a closed valve")
        until(lambda: (tmp_path / "out" / "experiment.json").exists(), "a summary")
    assert "has ended" in summary(tmp_path)["reason"]


# --- refusals to start ----------------------------------------------------------------------------------------------


def test_without_a_plant_it_says_what_is_missing_and_where_there_is_one(tmp_path: Path) -> None:
    with (
        scripted_plant("elsewhere"),
        running(*experiment(tmp_path, "nowhere", wait=3.0), cwd=tmp_path) as process,
    ):
        assert process.end(None) == 3
    assert "no message on /nowhere/joint_states, but there is an axis in the namespace /elsewhere" in process.said
    assert not (tmp_path / "out").exists()


def test_without_pressures_it_does_not_begin(tmp_path: Path) -> None:
    with scripted_plant("blind") as plant:
        plant.silent.add("chamber_a/pressure")
        with running(*experiment(tmp_path, "blind", wait=3.0), cwd=tmp_path) as process:
            assert process.end(None) == 3
    assert "no message on /blind/chamber_a/pressure" in process.said
    assert not plant.moving()


def test_another_joint_is_named(tmp_path: Path) -> None:
    command = experiment(tmp_path, "joint", wait=3.0, joint_name="slide")
    with scripted_plant("joint"), running(*command, cwd=tmp_path) as process:
        assert process.end(None) == 3
    assert "no position of the joint wanted, but of: piston" in process.said


def test_a_rival_is_named(tmp_path: Path) -> None:
    with scripted_plant("rival") as plant, probe("rival") as other:
        other.matched(other.command)
        with running(*experiment(tmp_path, "rival", wait=4.0), cwd=tmp_path) as process:
            assert process.end(None) == 2
    said = "/rival/probe is already the controller", "/rival/probe sends /rival/valve/command, too"  # discovered late
    assert any(words in process.said for words in said), process.said
    assert not plant.moving()


def test_no_recording_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "out" / "left").mkdir(parents=True)
    with running(*experiment(tmp_path, "again"), cwd=tmp_path) as process:
        assert process.end(None) == 2
    assert "left exists and is not overwritten" in process.said
