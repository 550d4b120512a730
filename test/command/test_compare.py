"""`pneumo compare` as a user types it: tables, JSON, exit codes, and messages for unsuitable input."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from identify.making import own, rig
from rig import bags

from pneumo_ros.command.main import main
from pneumo_ros.plant import save_model
from pneumo_ros.records import write_recording
from pneumo_ros.runs.run import Run

EPOCH = 1_700_000_000 * 10**9


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of the rig, its true machine file, and faulty recordings."""
    folder = tmp_path_factory.mktemp("shelf")
    for name in ("constant_p1100", "constant_m0830"):
        model, recorded, _ = rig(name)
        bags.write(folder / name, recorded, EPOCH)
    save_model(model, folder / "true.yaml")
    _, _, run = own("steps", seconds=3.0)
    write(folder / "left", run, namespace="left")
    write(folder / "short", run, slice(0, 400))
    write(folder / "still", run, slice(0, 2000), position=np.full(2000, 0.1), voltage=np.zeros(2000))
    write(folder / "lost", run, position=np.where(np.arange(3000) % 700 == 5, np.nan, run.position))
    write(folder / "in_mm", run, position=1e3 * run.position)
    write(folder / "in_bar", run, pressure_a=1e-5 * run.pressure_a)
    write(folder / "no_pressure", run, pressure_a=None, pressure_b=None)
    write(folder / "ten_hertz", run, slice(0, 3000), time=0.1 * np.arange(3000))
    shutil.copytree(folder / "left", folder / "truncated")
    (part,) = (folder / "truncated").glob("*.mcap")
    part.write_bytes(part.read_bytes()[:600])
    return folder


def write(path: Path, run: Run, part: slice = slice(None), **changes: object) -> None:
    """A run as a bag."""
    signals = {"time": run.time, "position": run.position, "pressure_a": run.pressure_a, "pressure_b": run.pressure_b}
    signals["voltage"] = np.append(run.held, run.held[-1])
    write_recording(path, **({name: signal[part] for name, signal in signals.items()} | changes))


@pytest.fixture(autouse=True)
def _in_shelf(shelf: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(shelf)


def test_a_person_reads_errors_against_noise(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "constant_p1100", "--model", "true.yaml"]) == 0
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert lines[0] == "constant_p1100: 8.0 s, 8000 samples, 7 windows"
    assert lines[1].split() == [
        "rms",
        "over",
        "1",
        "s",
        "largest",
        "noise",
        "rms",
        "/",
        "noise",
        "fit",
        "free",
        "run",
        "rms",
    ]
    position, pressure = (line.split() for line in lines[2:4])
    assert position[0] == "position"
    assert position[2] == position[4] == position[6] == "mm"
    assert 0.004 < float(position[1]) < 0.008
    assert float(position[7]) < 1.4
    assert pressure[:2] == ["pressure", "a"]
    assert pressure[3] == "kPa"
    assert 0.25 < float(pressure[2]) < 0.35
    assert "Equations of 'true', residual along the measured signals:" in out
    assert out.count("explained by noise") >= 3
    assert "FAILS" not in out
    assert max(map(len, lines)) <= 120


def test_it_says_what_fails(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "constant_p1100"]) == 0
    out = capsys.readouterr().out
    assert "FAILS" in out
    assert "momentum" in out


def test_several_bags_and_another_horizon(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "constant_p1100", "constant_m0830", "--model", "true.yaml", "--horizon", "0.5"]) == 0
    out = capsys.readouterr().out
    assert "constant_p1100: 8.0 s, 8000 samples, 15 windows" in out
    assert "constant_m0830: 15.0 s, 15000 samples, 29 windows" in out
    assert "rms over 0.5 s" in out
    assert out.count("Equations of") == 1


def test_json_alone_is_on_stdout() -> None:
    """In a process of its own, with nothing but JSON on stdout and messages on stderr."""
    command = [sys.executable, "-m", "pneumo_ros", "compare", "lost", "--json", "-"]
    done = subprocess.run(command, capture_output=True, text=True, env=_environment())
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["schema_version"] == 1
    assert result["runs"][0]["name"] == "lost"
    assert result["runs"][0]["error"]["pressure_a_pa"]["noise"] == pytest.approx(300.0, rel=0.1)
    assert "not finite" in done.stderr


def _environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}


def test_json_beside_the_table(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    target = tmp_path / "result.json"
    assert main(["compare", "left", "--horizon", "0.5", "--json", str(target)]) == 0
    result = json.loads(target.read_text())
    assert result["horizon_s"] == 0.5
    assert result["runs"][0]["error"].keys() == {"position_m", "pressure_a_pa", "pressure_b_pa"}
    assert all(equation["explained_by_noise"] for equation in result["equations"].values())
    assert "left: 3.0 s" in capsys.readouterr().out


def test_quiet_leaves_results_only(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "lost", "--quiet"]) == 0
    quiet = capsys.readouterr()
    assert quiet.err == ""
    assert "Equations of 'axis'" in quiet.out
    assert main(["compare", "lost"]) == 0
    assert "lost: " in capsys.readouterr().err


def test_what_the_machine_file_leaves_unwise_is_noted(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    model, _, _ = own("steps", seconds=3.0)
    save_model(model.with_parameters({"lugre_friction.bristle_damping": 5000.0}), tmp_path / "ringing.yaml")
    assert main(["compare", "left", "--model", str(tmp_path / "ringing.yaml")]) == 0
    assert "Note: " in capsys.readouterr().err


def test_no_motion_is_no_failure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "still", "--json", "still.json"]) == 0
    assert "not judged" in capsys.readouterr().out
    assert json.loads(Path("still.json").read_text())["equations"]["momentum"]["explained_by_noise"] is None


@pytest.mark.parametrize("namespace", ["left", "/left"])
def test_the_namespace_can_be_named(namespace: str) -> None:
    assert main(["compare", "left", "--namespace", namespace, "--quiet"]) == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ([], 2, "BAG"),
        (["left", "--horizon", "0"], 2, "--horizon 0 is not a length of time"),
        (["left", "--horizon", "-1"], 2, "--horizon -1"),
        (["left", "--horizon", "nan"], 2, "--horizon nan"),
        (["left", "--horizon", "inf"], 2, "--horizon"),
        (["left", "--horizon", "soon"], 2, "--horizon"),
        (["left", "--horizon", "30"], 2, "left has no window of 30 s"),
        (["left", "--horizon", "1e-6"], 2, "give a longer --horizon"),
        (["left", "--horizn", "1"], 2, "did you mean --horizon"),
        (["short", "--horizon", "1"], 2, "short has no window of 1 s without a gap in its 0.399 s"),
        (["left", "--json", "no/folder/x.json"], 2, "mkdir -p no/folder"),
        (["lefd"], 3, "left"),
        (["left", "--namespace", "right"], 3, "left"),
        (["left", "--model", "axsi"], 3, "axis"),
        (["true.yaml"], 3, "true.yaml"),
        (["truncated"], 3, "truncated"),
        (["no_pressure"], 3, "chamber_a/pressure"),
        (["in_mm"], 3, "outside the stroke of axis"),
        (["in_bar"], 3, "absolute pressures in Pa are needed"),
        (["ten_hertz"], 3, "ten_hertz is sampled every 100 ms"),
        (["left", "in_mm"], 3, "in_mm"),
    ],
)
def test_what_cannot_be_compared(
    arguments: list[str], code: int, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """One sentence, the exit code, and nothing on stdout."""
    assert main(["compare", *arguments, "--quiet"]) == code
    said = capsys.readouterr()
    assert words in said.err
    assert said.err.startswith("pneumo: error: ")
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_an_axis_driven_by_a_force_is_judged_by_its_mechanics(capsys: pytest.CaptureFixture[str]) -> None:
    time = np.arange(500) * 1e-3
    if not Path("pushed").exists():
        write_recording(Path("pushed"), time=time, position=0.01 * time, effort=np.full(500, 3.0))
    assert main(["compare", "pushed"]) == 0
    said = capsys.readouterr()
    assert "friction and load are judged, driven by the measured force" in said.err
    assert "Judged: momentum. Not judged: chambers and valve (valve/command and both chamber pressures" in said.err
    assert "rms over 0.2 s" in said.out
