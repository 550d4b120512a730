"""`pneumo experiment --separate` without a plant."""

import json
from pathlib import Path

import pytest

from pneumo_ros.command import main
from pneumo_ros.experiment.programme_file import read_programme


def pneumo(*arguments: object) -> int:
    """Exit code of `pneumo experiment`."""
    return main.main(["experiment", *map(str, arguments)])


@pytest.mark.check
def test_it_ranks_the_menu_and_writes_the_best(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, data = tmp_path / "best.yaml", tmp_path / "best.json"
    assert pneumo("--separate", "asymmetric_friction", "constant_load", "--write", path, "--json", data) == 0
    text = capsys.readouterr().out
    result = json.loads(data.read_text(encoding="utf-8"))
    told = [one["separation"] for one in result["experiments"]]
    assert told == sorted(told, reverse=True)
    assert len(told) >= 10
    assert all(one["name"] in text for one in result["experiments"])
    assert result["suggested_experiment"] in text
    assert result["effects"] == ["asymmetric_friction", "constant_load"]
    assert read_programme(path).experiment == result["experiments"][0]["experiment"] == result["experiment"]


def test_what_takes_a_hand_is_not_done_without_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert pneumo("vent", "--plan") == 0
    assert "First shut the supply off" in capsys.readouterr().out
    pytest.importorskip("rclpy", reason="without it nothing is driven at all")
    assert pneumo("vent") == 2
    assert "then add --prepared" in capsys.readouterr().err


def test_preparations_stay_in_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "vent.yaml"
    assert pneumo("vent", "--write", path) == 0
    assert read_programme(path).prepare.startswith("shut the supply off")
    assert read_programme(path).trials[0].anywhere
    assert pneumo(path, "--plan") == 0
    path.write_text(path.read_text(encoding="utf-8").replace("anywhere: true", "anywhere: 3"), encoding="utf-8")
    assert pneumo(path, "--plan") == 2
    assert "it takes true or false" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--separate", "constant_laod", "spring_load"], "did you mean constant_load"),
        (["--separate", "spring_load", "spring_load"], "given twice"),
        (["steps", "--separate", "spring_load", "constant_load"], "goes without NAME"),
        (["--separate", "spring_load", "constant_load", "--model", "emps"], "no chambers"),
    ],
)
def test_what_it_refuses(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert pneumo(*arguments, "--plan") == 2
    assert sentence in capsys.readouterr().err
