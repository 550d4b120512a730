"""`pneumo demo`: real nodes, a real bag, a machine of another simulator, and the printed text."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from pneumo_ros.command.console import Console
from pneumo_ros.command.demo.hidden_machine import second_simulator
from pneumo_ros.command.demo.machine import _reveal
from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model
from pneumo_ros.records import read_recording

SEED, HIDDEN = 32, "viscous_friction"  # drawn by that seed


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, dict[str, Any]]:
    """Folder, text and JSON of one demo, also compared with a simulated recording; the axis runs briefly."""
    folder = tmp_path_factory.mktemp("demo")
    other = ["simulate", "--input", "sine:3,0.5", "--seconds", "3", "--out", str(folder / "other"), "--quiet"]
    assert main(other) == 0
    command = ["demo", "--seconds", "8", "--out", str(folder / "out"), "--recording", str(folder / "other")]
    command += ["--seed", str(SEED)]
    done = subprocess.run(
        [sys.executable, "-m", "pneumo_ros", *command, "--json", str(folder / "demo.json")],
        cwd=folder, capture_output=True, text=True, timeout=900,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "out", done.stdout, json.loads((folder / "demo.json").read_text())


@pytest.mark.check
def test_all_nodes_ended_well(shown: tuple[Path, str, dict[str, Any]]) -> None:
    assert shown[2]["exit_codes"] == {"recorder": 0, "simulator": 0, "controller": 0}
    assert "Exit codes: recorder 0, simulator 0, controller 0" in shown[1]


@pytest.mark.check
def test_the_bag_holds_what_the_contract_names(shown: tuple[Path, str, dict[str, Any]]) -> None:
    recording = read_recording(shown[0] / "bag")
    assert recording.namespace == "demo"
    assert recording.duration > 7.5
    assert recording.pressure_a is not None
    assert recording.command is not None
    assert recording.description is not None
    assert recording.description["model"]["piston"]["mass"] == 5.0
    for topic in ("joint_states", "chamber_a/pressure", "chamber_b/pressure", "valve/command"):
        assert f"/demo/{topic} " in shown[1]


@pytest.mark.check
def test_the_piston_went_where_it_was_sent(shown: tuple[Path, str, dict[str, Any]]) -> None:
    position = read_recording(shown[0] / "bag").position
    assert position.max() > 0.08
    assert position.min() < -0.03
    assert "Distance from the reference at the end of each step:" in shown[1]


@pytest.mark.check
def test_both_comparisons_are_reported(shown: tuple[Path, str, dict[str, Any]]) -> None:
    data = shown[2]
    for key in ("own", "other"):
        comparison = data[key]
        assert isinstance(comparison, dict)
        assert set(comparison["equations"]) == {"momentum", "chamber_a", "chamber_b"}
        assert comparison["runs"][0]["error"]["position_m"]["rms"] > 0.0
    assert "The model against a recording of another plant" in shown[1]


@pytest.mark.check
def test_what_the_other_simulator_hid_is_found(shown: tuple[Path, str, dict[str, Any]]) -> None:
    data = shown[2]
    assert data["seed"] == SEED
    assert data["rig"] == str(second_simulator())
    truth = json.loads((shown[0] / "truth.json").read_text())
    assert [hidden["effect"] for hidden in truth["effects"]] == [HIDDEN]
    assert [hidden["effect"] for hidden in data["hidden"]] == [HIDDEN]
    assert [added["effect"] for added in data["added"]] == [HIDDEN]
    assert data["right"] is True
    assert HIDDEN in load_model(str(shown[0] / "improved.yaml")).effects
    assert HIDDEN in (shown[0] / "report.html").read_text()


@pytest.mark.check
def test_the_truth_comes_last(shown: tuple[Path, str, dict[str, Any]]) -> None:
    before, verb, after = shown[1].partition("pneumo_ros diagnose ")
    assert verb
    assert HIDDEN not in before
    assert after.index("7. The truth") < after.index("Hidden: " + HIDDEN) < after.index("The diagnosis is right.")
    assert f"--seed {SEED}" in before


def test_what_cannot_be_compared_is_said_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["demo", "--recording", str(tmp_path / "none"), "--out", str(tmp_path / "out")]) == 3
    assert not (tmp_path / "out").exists()
    assert main(["demo", "--seconds", "1"]) == 2
    assert "at least 4" in capsys.readouterr().err
    assert main(["demo", "--seed", "-3"]) == 2
    assert "--seed 3" in capsys.readouterr().err
    assert main(["demo", "--rig", str(tmp_path)]) == 2
    assert "test/rig" in capsys.readouterr().err


def added(effect: str, std: float | None = 2.0) -> dict[str, Any]:
    values = {"coefficient": {"value": 180.0, "std": std, "unit": "N s/m"}}
    return {"effect": effect, "parameters": values, "indistinguishable_from": []}


@pytest.mark.parametrize(
    ("found", "right", "said"),
    [
        ([added("viscous_friction")], True, "viscous_friction (coefficient 180 +- 3.9 N s/m)"),
        ([added("viscous_friction", None)], True, "Found:  viscous_friction\n"),
        ([added("constant_load")], False, "wrong"),
        ([], False, "Found:  nothing"),
    ],
)
def test_it_is_said_honestly_whether_it_was_right(
    found: list[dict[str, Any]], right: bool, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    hidden = {"effect": "viscous_friction", "shape": "viscous_friction", "size": 180.0, "unit": "N s/m"}
    result = _reveal({"effects": [hidden]}, {"added": found}, None, Console())
    text = capsys.readouterr().out
    assert result["right"] is right
    assert said in text
    assert "Hidden: viscous_friction, 180 N s/m" in text
