"""`pneumo demo`: real nodes, a real bag, and the numbers a person is shown."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from pneumo_ros.command.main import main
from pneumo_ros.records import read_recording


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, dict[str, object]]:
    """Folder, text and JSON of one short demo, compared with a simulated recording."""
    folder = tmp_path_factory.mktemp("demo")
    other = ["simulate", "--input", "sine:3,0.5", "--seconds", "3", "--out", str(folder / "other"), "--quiet"]
    assert main(other) == 0
    command = ["demo", "--seconds", "8", "--out", str(folder / "out"), "--recording", str(folder / "other")]
    done = subprocess.run(
        [sys.executable, "-m", "pneumo_ros", *command, "--json", str(folder / "demo.json")],
        cwd=folder, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "out", done.stdout, json.loads((folder / "demo.json").read_text())


def test_all_nodes_ended_well(shown: tuple[Path, str, dict[str, object]]) -> None:
    assert shown[2]["exit_codes"] == {"recorder": 0, "simulator": 0, "controller": 0}
    assert "Exit codes: recorder 0, simulator 0, controller 0" in shown[1]


def test_the_bag_holds_what_the_contract_names(shown: tuple[Path, str, dict[str, object]]) -> None:
    recording = read_recording(shown[0] / "bag")
    assert recording.namespace == "demo"
    assert recording.duration > 7.5
    assert recording.pressure_a is not None
    assert recording.command is not None
    assert recording.description is not None
    assert recording.description["model"]["piston"]["mass"] == 5.0
    for topic in ("joint_states", "chamber_a/pressure", "chamber_b/pressure", "valve/command"):
        assert f"/demo/{topic} " in shown[1]


def test_the_piston_went_where_it_was_sent(shown: tuple[Path, str, dict[str, object]]) -> None:
    position = read_recording(shown[0] / "bag").position
    assert position.max() > 0.08
    assert position.min() < -0.03
    assert "Distance from the reference at the end of each step:" in shown[1]


def test_both_comparisons_are_reported(shown: tuple[Path, str, dict[str, object]]) -> None:
    data = shown[2]
    for key in ("own", "other"):
        comparison = data[key]
        assert isinstance(comparison, dict)
        assert set(comparison["equations"]) == {"momentum", "chamber_a", "chamber_b"}
        assert comparison["runs"][0]["error"]["position_m"]["rms"] > 0.0
    assert "4. The model against a recording it did not make" in shown[1]


def test_what_cannot_be_compared_is_said_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["demo", "--recording", str(tmp_path / "none"), "--out", str(tmp_path / "out")]) == 3
    assert not (tmp_path / "out").exists()
    assert main(["demo", "--seconds", "1"]) == 2
    assert "at least 4" in capsys.readouterr().err
