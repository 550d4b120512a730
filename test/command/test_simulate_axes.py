"""`pneumo simulate` of a machine of several axes: one recording, each axis under its prefix."""

import json
from pathlib import Path

import numpy as np
import pytest
from multiaxis.machines import LINE, two

from pneumo_ros.command.main import main
from pneumo_ros.errors import DataError
from pneumo_ros.multiaxis import machine_text
from pneumo_ros.records import read_recording, read_topics

pytestmark = pytest.mark.usefixtures("_in_folder")
MOVES = ["--input", "shoulder=step:4@0.1", "--input", "elbow=sine:3,1"]


@pytest.fixture
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("two.yaml").write_text(machine_text(two(LINE)), encoding="utf-8")


def simulated(*arguments: str) -> int:
    return main(["simulate", *arguments, "--model", "two.yaml", "--quiet"])


def test_the_recording_is_what_the_machine_does() -> None:
    assert simulated(*MOVES, "--seconds", "0.8", "--out", "both") == 0
    machine = two(LINE)
    time = np.arange(800) * 1e-3
    volts = np.column_stack([np.where(time >= 0.1, 4.0, 0.0), 3.0 * np.sin(2.0 * np.pi * time)])
    states = np.vstack([machine.state(), machine.simulate(volts, machine.state())])
    for axis, own in machine.split(states).items():
        recording = read_recording("both", axis)
        np.testing.assert_array_equal(recording.position, own[:, 0])
        np.testing.assert_array_equal(recording.pressure_b, own[:, 3])
        np.testing.assert_array_equal(recording.supply_pressure, 7e5 - states[:, -1])
        assert recording.joint_name == axis
        assert recording.description["model"] == machine.axes[axis].as_dict()
    topics = set(read_topics("both"))
    assert {"/supply/pressure", "/description", "/shoulder/joint_states", "/elbow/valve/command"} <= topics


def test_a_replay_repeats_all_axes(capsys: pytest.CaptureFixture[str]) -> None:
    assert simulated(*MOVES, "--seconds", "0.5", "--out", "first") == 0
    capsys.readouterr()
    assert simulated("--input", "first", "--out", "second", "--json", "-") == 0
    assert set(json.loads(capsys.readouterr().out)["axes"]) == {"shoulder", "elbow"}
    for axis in two().axes:
        first, second = read_recording("first", axis), read_recording("second", f"/{axis}")
        np.testing.assert_allclose(second.position, first.position, atol=1e-5)  # m; the start is estimated
        np.testing.assert_array_equal(second.command, first.command)


def test_an_axis_without_an_input_keeps_its_valve_closed() -> None:
    assert simulated("--input", "elbow=constant:3", "--seconds", "0.3", "--out", "one") == 0
    assert np.ptp(read_recording("one", "shoulder").voltage) == 0.0
    with pytest.raises(DataError, match="holds 2 axes"):
        read_recording("one")


def test_every_axis_has_noise_of_its_own() -> None:
    assert simulated(*MOVES, "--seconds", "0.8", "--out", "clean") == 0
    assert simulated(*MOVES, "--seconds", "0.8", "--out", "noisy", "--noise", "position=5e-6", "--seed", "4") == 0
    drawn = [read_recording("noisy", axis).position - read_recording("clean", axis).position for axis in two().axes]
    for one in drawn:
        assert np.std(one) == pytest.approx(5e-6, rel=0.2)
    assert abs(np.corrcoef(drawn)[0, 1]) < 0.2  # 801 samples: 0.035 is its standard deviation
    assert read_recording("noisy", "elbow").velocity is None


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--input", "step:1@1"], "Type --input shoulder=step:1@1"),
        (["--input", "sholder=step:1@1"], "did you mean shoulder"),
        (["--input", "elbow=step:1@1", "--input", "elbow=step:2@1"], "given twice for elbow"),
        (["--input", "elbow=stp:1@1"], "did you mean step"),
    ],
)
def test_wrong_inputs_say_what_to_type(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulated(*arguments, "--out", "none") == 2
    assert sentence in capsys.readouterr().err
    assert not Path("none").exists()


def test_one_axis_takes_one_input(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["simulate", "--input", "constant:1", "--input", "constant:2", "--out", "none", "--quiet"]
    assert main(arguments) == 2
    assert "has one axis; give --input once" in capsys.readouterr().err
