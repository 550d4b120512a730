"""`pneumo identify`: bags in, a table, reasons and a machine file out."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from identify.constant import constant_run, truth, write_bag, wrong

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model, save_model

VOLTAGES = (0.83, -0.83, 1.0, -1.0, 7.0, -7.0)


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with six constant-voltage runs, one of a stuck piston, and a recording that cannot be read."""
    folder = tmp_path_factory.mktemp("campaign") / "runs"
    folder.mkdir()
    for number, volts in enumerate(VOLTAGES):
        write_bag(folder / f"run_{number}", constant_run(volts))
    write_bag(folder / "stuck", constant_run(0.5, seconds=3.0))
    (folder / "torn").mkdir()
    (folder / "torn" / "torn.mcap").write_bytes(b"not a recording")
    save_model(wrong(), folder.parent / "wrong.yaml")
    return folder


@pytest.fixture(scope="module")
def done(bags: Path) -> "tuple[subprocess.CompletedProcess[str], dict[str, Any]]":
    """The whole command as a user types it, and its JSON."""
    options = ["--model", "wrong.yaml", "--out", "found.yaml", "--json", "found.json", "--per-direction"]
    line = [sys.executable, "-m", "pneumo_ros", "identify", "runs", *options, "--verbose"]
    found = subprocess.run(line, cwd=bags.parent, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return found, json.loads((bags.parent / "found.json").read_text())


def test_the_machine_file_holds_what_was_found(
    bags: Path, done: "tuple[subprocess.CompletedProcess[str], dict[str, Any]]"
) -> None:
    model, data = load_model(bags.parent / "found.yaml"), done[1]
    for name, one in data["parameters"].items():
        assert model[name] == one["value"], name
    for name in ("lugre_friction.coulomb_friction", "quadratic_drag.coefficient"):
        assert model[name] == pytest.approx(truth()[name], rel=0.01)
    for name in ("lugre_friction.static_friction", "lugre_friction.stribeck_velocity"):
        assert model[name] == pytest.approx(truth()[name], rel=0.10)
    assert data["machine_file"] == "found.yaml"


def test_the_machine_file_is_a_parameter_file_of_ros(
    bags: Path, done: "tuple[subprocess.CompletedProcess[str], dict[str, Any]]"
) -> None:
    """A real node reads it, through the parser of rcl."""
    program = (
        "import json, rclpy\n"
        "rclpy.init(args=['--ros-args', '--params-file', 'found.yaml'])\n"
        "node = rclpy.create_node('reader', automatically_declare_parameters_from_overrides=True)\n"
        "names = [n for n in node._parameters if '.' in n or n == 'effects']\n"
        "print(json.dumps({n: node.get_parameter(n).value for n in names}))\n"
    )
    read = subprocess.run([sys.executable, "-c", program], cwd=bags.parent, capture_output=True, text=True)
    assert read.returncode == 0, read.stderr
    values = json.loads(read.stdout)
    model = load_model(bags.parent / "found.yaml")
    assert values.pop("effects") == list(model.effects)
    assert {name: value for name, value in values.items() if name in model.parameters} == dict(model.parameters)


def test_json(done: "tuple[subprocess.CompletedProcess[str], dict[str, Any]]") -> None:
    data = done[1]
    assert data["schema_version"] == 1
    assert data["undetermined"] == {}
    coulomb = data["parameters"]["lugre_friction.coulomb_friction"]
    assert coulomb["low"] < coulomb["value"] < coulomb["high"]
    assert (coulomb["unit"], coulomb["before"], coulomb["determined"]) == ("N", 77.0, True)
    assert [run["name"] for run in data["runs"]] == [*(f"run_{k}" for k in range(6)), "stuck"]
    assert data["runs"][-1]["refused"] == {"the piston rests or creeps": data["runs"][-1]["windows"]}
    assert len(data["map"]["points"]["force"]) == sum(run["used"] for run in data["runs"])
    assert all(one["detail"].startswith(one["reason"]) for one in data["refused"])
    assert len(data["breakaways"]) == 6
    assert list(data["passed_over"]) == ["runs/torn"]
    assert {one["role"] for one in data["provenance"]["files"]} == {"recording", "machine file"}
    assert data["directions"]["differ"] == []


def test_text(done: "tuple[subprocess.CompletedProcess[str], dict[str, Any]]") -> None:
    out, err = done[0].stdout, done[0].stderr
    rows = {line.split("  ")[0]: " ".join(line.split()) for line in reversed(out.splitlines())}  # the first of a name
    assert rows["lugre_friction.coulomb_friction"].endswith("N steady motion")
    assert rows["lugre_friction.static_friction"].endswith("N motion after 6 breakaways")
    assert rows["stuck"].startswith("stuck 0 of 11 - - 11 the piston rests or creeps")
    assert "windows of 0.25 s in 7 runs are steady; 6 breakaways." in out
    assert "The static map fits" in out
    assert "The directions do not differ beyond their intervals" in out
    assert "refused in run" in out
    assert "Passed over: " in err
    assert "torn" in err
    assert "Machine file written to found.yaml" in err


def test_an_existing_machine_file_is_kept(bags: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    monkeypatch.chdir(bags.parent)
    Path("mine.yaml").write_text("mine")
    assert main(["identify", "runs", "--out", "mine.yaml"]) == 2
    assert "mine.yaml exists; name another file, or add --overwrite" in capsys.readouterr().err
    assert Path("mine.yaml").read_text() == "mine"


def test_overwrite_replaces_it(bags: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(bags.parent)
    Path("old.yaml").write_text("old")
    assert main(["identify", "runs/run_2", "--out", "old.yaml", "--overwrite", "--quiet"]) == 1
    assert load_model("old.yaml").effects == load_model("axis").effects


def test_one_run_says_what_it_does_not_determine(bags: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    monkeypatch.chdir(bags.parent)
    assert main(["identify", "runs/run_2", "--json", "one.json", "--report", "one.html", "--quiet"]) == 1
    out = capsys.readouterr().out
    assert "Not determined: lugre_friction.coulomb_friction, which keeps 70 N: these runs leave it anywhere" in out
    assert "Not determined: quadratic_drag.coefficient, which keeps 4546.7 N s2/m2: needs speeds over a factor" in out
    data = json.loads(Path("one.json").read_text())
    assert set(data["undetermined"]) >= {"lugre_friction.stribeck_velocity", "quadratic_drag.coefficient"}
    for name in data["undetermined"]:
        assert data["parameters"][name]["low"] is None
        assert not data["parameters"][name]["determined"]
    page = Path("one.html").read_text(encoding="utf-8")
    assert 'id="static-map"' in page
    assert "Not determined: " in page


def test_a_stretch_of_a_folder_can_be_named_too(bags: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    """Runs of the same name in different folders are distinguished; a run that is named twice is read once."""
    monkeypatch.chdir(bags.parent)
    shutil.copytree("runs/run_2", "again/run_2", dirs_exist_ok=True)
    assert main(["identify", "runs/run_2", "runs/run_2/", "again/run_2", "--json", "-"]) == 1
    captured = capsys.readouterr()
    assert [run["name"] for run in json.loads(captured.out)["runs"]] == ["runs/run_2", "again/run_2"]
    assert "runs/run_2 is named twice and taken once" in captured.err


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["runs/stuck"], 3, "11 times: the piston rests or creeps"),
        (["runs/torn"], 3, "torn"),
        (["nowhere"], 3, "There is no nowhere"),
        (["runs/run_0", "runs/torn"], 3, "torn"),
        (["runs/run_0", "--overwrite"], 2, "--overwrite goes with --out MODEL"),
        (["runs/run_0", "--out", "no/folder.yaml"], 2, "mkdir -p no"),
        (["runs/run_0", "--model", "bare.yaml"], 2, "add lugre_friction to the effects"),
        ([], 2, "BAG"),
    ],
)
def test_what_is_refused(
    arguments: list[str], code: int, sentence: str, bags: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.chdir(bags.parent)
    bare = truth().with_effects([e for e in truth().effects if e not in ("lugre_friction", "quadratic_drag")])
    save_model(bare, "bare.yaml")
    assert main(["identify", *arguments, "--quiet"]) == code
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1


def test_effects_are_added_and_fitted_or_do_nothing(bags: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    """The machine has no viscous friction, and three runs do not show the exponent: the file says both."""
    monkeypatch.chdir(bags.parent)
    named = [f"runs/run_{k}" for k in (0, 2, 5)]
    options = ["--viscous", "--stribeck-exponent", "--out", "added.yaml", "--quiet"]
    assert main(["identify", *named, "--model", "paper", *options]) == 1
    model = load_model("added.yaml")
    at = model.effects.index("lugre_friction")
    assert model.effects[at + 1 : at + 3] == ("viscous_friction", "stribeck_shape")
    assert 0.0 <= model["viscous_friction.coefficient"] < 6.0
    assert model["stribeck_shape.exponent"] == 2.0
    assert "Not determined: stribeck_shape.exponent, which keeps 2: needs steady points" in capsys.readouterr().out
