"""`pneumo experiment` without a plant: the list, plans, programme files, and refusals."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hiding import environment_without

from pneumo_ros.command import main
from pneumo_ros.experiment.catalogue import EXPERIMENTS
from pneumo_ros.experiment.programme_file import read_programme
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import save_model

SHORT = ["constant-voltage", "--voltages", "1.5", "--seconds", "1"]


def pneumo(*arguments: object) -> int:
    """Exit code of `pneumo experiment`."""
    return main.main(["experiment", *map(str, arguments)])


def test_alone_it_lists_the_experiments(capsys: pytest.CaptureFixture[str]) -> None:
    assert pneumo() == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[: len(EXPERIMENTS)]] == list(EXPERIMENTS)
    assert pneumo("--json", "-") == 0
    listed = json.loads(capsys.readouterr().out)["experiments"]
    assert {one["name"] for one in listed} >= {"constant-voltage"}


def test_the_plan_shows_duration_and_way_of_every_trial(capsys: pytest.CaptureFixture[str]) -> None:
    assert pneumo(*SHORT, "--plan") == 0
    text = capsys.readouterr().out
    assert "2 trials" in text
    assert "constant_p1500  +1.500 V" in text
    assert "Room: -0.8 to 0.8 m" in text
    assert pneumo(*SHORT, "--plan", "--json", "-") == 0
    plan = json.loads(capsys.readouterr().out)
    assert [trial["name"] for trial in plan["trials"]] == ["constant_p1500", "constant_m1500"]
    assert plan["duration_s"] > 2.0
    assert plan["travel_m"] > sum(trial["travel_m"] for trial in plan["trials"])
    assert plan["aborted"] == ""


def test_a_written_programme_is_one_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "short.yaml"
    assert pneumo(*SHORT, "--write", path) == 0
    assert f"pneumo experiment {path}" in capsys.readouterr().err
    assert [trial.name for trial in read_programme(path).trials] == ["constant_p1500", "constant_m1500"]
    path.write_text(path.read_text(encoding="utf-8").replace("constant: 1.5", "constant: 2.5"), encoding="utf-8")
    assert pneumo(path, "--plan") == 0
    assert "+2.500 V" in capsys.readouterr().out


def test_written_voltages_can_be_simulated(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "short.csv"
    assert pneumo(*SHORT, "--write", path, "--json", tmp_path / "plan.json") == 0
    assert f"pneumo simulate --input {path}" in capsys.readouterr().err
    assert main.main(["simulate", "--input", str(path), "--out", str(tmp_path / "bag"), "--rate", "250"]) == 0
    text = capsys.readouterr().out
    duration = json.loads((tmp_path / "plan.json").read_text(encoding="utf-8"))["duration_s"]
    simulated = float(text.split(" s:")[0].split()[-1])
    assert simulated == pytest.approx(duration, abs=1.0)


def test_a_plan_that_would_be_aborted_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "short.yaml"
    assert pneumo(*SHORT, "--write", path) == 0
    text = path.read_text(encoding="utf-8").replace("return_left: 1.08", "return_left: 0.5")
    path.write_text(text, encoding="utf-8")
    assert pneumo(path, "--plan") == 1
    assert "It would be aborted: at -0.50 V the piston stays at" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["constant-votage", "--plan"], 2, "did you mean constant-voltage"),
        (["steps", "--read-as", "reversed-voltge", "--plan"], 2, "did you mean reversed-voltage"),
        (["steps", "--voltages", "1", "--plan"], 2, "voltages are for constant-voltage"),
        (["constant-voltage", "--voltages", "-1", "--plan"], 2, "allowed is more than 0 to 10 V"),
        (["constant-voltage", "--seconds", "0", "--plan"], 2, "it takes a time above 0"),
        (["constant-voltage", "--model", "emps", "--plan"], 2, "no chambers"),
        (["constant-voltage", "--write", "programme.txt"], 2, "ends in .yaml, .yml, .csv"),
        (["constant-voltage", "--write", "no/such/folder/a.yaml"], 2, "mkdir -p no/such/folder"),
        (["no_such.yaml", "--plan"], 3, "cannot read the programme no_such.yaml"),
        (["constant-voltage", "--timeout", "0"], 2, "--timeout is 0 ms"),
    ],
)
def test_what_it_refuses(arguments: list[str], code: int, sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert pneumo(*arguments) == code
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.err.count("pneumo: error: ") == 1


def test_a_programme_file_keeps_its_voltages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "short.yaml"
    assert pneumo(*SHORT, "--write", path) == 0
    assert pneumo(path, "--voltages", "2", "--plan") == 2
    assert f"change them in {path}" in capsys.readouterr().err


def test_without_ros_plans_are_made_and_plants_are_not_driven(tmp_path: Path) -> None:
    environment = environment_without(tmp_path, "rclpy")
    command = [sys.executable, "-m", "pneumo_ros", "experiment", *SHORT]
    planned = subprocess.run([*command, "--plan"], env=environment, capture_output=True, text=True)
    assert planned.returncode == 0, planned.stderr
    driven = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert driven.returncode == 2
    assert driven.stderr.startswith("pneumo: error: rclpy")
    assert driven.stderr.count("\n") == 1


@pytest.mark.parametrize("name", ["constant-voltage", "sweep"])
def test_a_short_fast_cylinder_gets_trials_that_it_has_room_for(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    wishes = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
    save_model(design(wishes, load_shelf([])).model, "short.yaml")
    assert main.main(["experiment", name, "--model", "short.yaml", "--plan", "--json", "plan.json"]) == 0
    plan = json.loads(Path("plan.json").read_text())
    assert plan["aborted"] == ""
    assert plan["trials"]
    if name == "constant-voltage":
        assert "Left out, as the model would reach an end stop: +" in capsys.readouterr().err
