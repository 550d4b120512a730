"""`pneumo diagnose`: recordings in; missing effects, a table, JSON and a machine file out."""

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from command.lacking import VISCOUS, shelf

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model

Done = tuple["subprocess.CompletedProcess[str]", dict[str, Any]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of a machine with viscous friction."""
    return shelf(tmp_path_factory.mktemp("diagnose"))


@pytest.fixture(scope="module")
def done(folder: Path) -> Done:
    """The whole command as a user types it, and its JSON."""
    options = ["--holdout", "runs/holdout_sweep", "--out", "found.yaml", "--json", "found.json"]
    options += ["--report", "page.html"]
    line = [sys.executable, "-m", "pneumo_ros", "diagnose", "runs", *options]
    found = subprocess.run(line, cwd=folder, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return found, json.loads((folder / "found.json").read_text())


def test_the_missing_effect_is_found_and_written(folder: Path, done: Done) -> None:
    out, data = done[0].stdout, done[1]
    assert out.startswith("'axis' lacks viscous_friction")
    assert data["verdict"] == "effects_found"
    assert data["failing"] == ["momentum"]
    (added,) = data["added"]
    own = added["parameters"]["coefficient"]
    assert added["effect"] == "viscous_friction"
    assert own["value"] == pytest.approx(VISCOUS, rel=0.03)
    assert own["low"] < own["value"] < own["high"]
    model = load_model(folder / "found.yaml")
    assert model.effects[-1] == "viscous_friction"
    assert model["viscous_friction.coefficient"] == own["value"]


def test_the_json_is_as_promised(done: Done) -> None:
    data = done[1]
    assert data["schema_version"] == 1
    signals = {"position_m", "pressure_a_pa", "pressure_b_pa"}
    assert {key: set(values) for key, values in data["holdout"].items()} == {
        "before": signals, "after": signals, "noise": signals,
    }  # fmt: skip
    (added,) = data["added"]
    assert {"effect", "parameters", "indistinguishable_from", "holdout_error_before", "holdout_error_after"} <= set(
        added
    )
    assert {"value", "std", "unit"} <= set(added["parameters"]["coefficient"])
    assert added["parameters"]["coefficient"]["unit"] == "N s/m"
    first = data["candidates"][0]
    assert first["effect"] == "viscous_friction"
    assert first["score"]["nats"] > first["score"]["heldout_nats"] > 8.0
    assert added["score"] == first["score"]
    assert first["holdout_error"] == added["holdout_error_after"]
    assert added["holdout_error_before"] == data["course"][1]["holdout_error"]
    assert data["suggested_experiment"] == ""
    assert data["unexplained"] is None
    assert not data["interrupted"]
    assert not data["deadline"]
    assert (data["train"], data["held_out"]) == (["steps", "sweep"], ["holdout_sweep"])


def test_what_the_recordings_cannot_show_comes_with_an_experiment_that_does(done: Done) -> None:
    """They never reach the ends of the stroke."""
    unseen = {one["effect"]: one for one in done[1]["cannot_say"]}
    assert unseen["cushioning"]["experiment"] == "pneumo experiment full-strokes"
    assert "0.0 nats in these recordings, and 8 are asked" in unseen["cushioning"]["because"]
    assert not unseen.keys() & {one["effect"] for one in done[1]["added"]}
    assert "These recordings cannot show whether there is" in done[0].stdout
    assert "to see it: pneumo experiment full-strokes." in done[0].stdout


def test_the_report_repeats_it(folder: Path, done: Done) -> None:
    page = (folder / "page.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>")
    assert "--holdout runs/holdout_sweep" in page
    assert "Report written to page.html" in done[0].stderr


def test_what_was_refused_comes_with_reasons(done: Done) -> None:
    for one in done[1]["candidates"]:
        assert one["added"] or one["rival_of"] or one["objections"], one["effect"]


def test_people_read_it_on_one_screen(done: Done) -> None:
    out, err = done[0].stdout, done[0].stderr
    assert len(out.splitlines()) < 50
    assert max(map(len, out.splitlines())) < 160
    for part in (
        "FAILS",
        "95 % interval",
        "as given",
        "refitted",
        "+ viscous_friction",
        "Not added",
        "because",
        "N s/m",
    ):
        assert part in out
    assert "runs/holdout_sweep is held out, not fitted" in err
    assert "Diagnosing: " in err
    assert "written to found.yaml" in err


def refused(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 2) -> str:
    """The error message after a wrong use of diagnose."""
    assert main(["diagnose", *arguments, "--quiet"]) == code
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    return line


def test_wrong_use_is_said_before_any_work(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    held = ("--holdout", "runs/holdout_sweep")
    line = "type: pneumo diagnose runs --holdout runs/holdout_sweep"
    assert refused(capsys, "runs").endswith(line)
    assert "pneumo diagnose runs/steps --holdout runs/sweep" in refused(capsys, "runs/steps", "runs/sweep")
    assert "record one more run" in refused(capsys, "runs/steps")
    assert "runs/holdout_sweep is to be fitted and held out" in refused(capsys, "runs/holdout_sweep", *held)
    assert "is to be fitted and held out" in refused(capsys, "runs", "--holdout", "runs")
    assert "there is no folder" in refused(capsys, "runs", *held, "--report", "nowhere/page.html")
    assert "there is no folder" in refused(capsys, "runs", *held, "--out", "nowhere/model.yaml")
    (folder / "mine.yaml").write_text("mine")
    assert "mine.yaml exists; name another file, or add --overwrite" in refused(
        capsys, "runs", *held, "--out", "mine.yaml"
    )
    assert "missing_run" in refused(capsys, "missing_run", *held, code=3)


def test_a_copy_is_not_held_out(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    copy = tmp_path / "another_name"
    subprocess.run(["cp", "-r", str(folder / "runs" / "steps"), str(copy)], check=True)
    line = refused(capsys, str(folder / "runs" / "steps"), "--holdout", str(copy))
    assert "is a copy of steps, which is fitted" in line


def test_a_deadline_ends_the_search_with_the_usual_exit_code(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    written = str(tmp_path / "j.json")
    code = main(["diagnose", "runs", "--holdout", "runs/holdout_sweep", "--within", "1s", "--json", written])
    data = json.loads(Path(written).read_text())
    assert (data["deadline"], data["interrupted"], data["added"]) == (True, False, [])
    assert code == (1 if data["verdict"] == "unknown_effect" else 0)
    assert capsys.readouterr().out.startswith("OUT OF TIME before any effect was tried")
    assert data["refit"]["parameters"]


@pytest.mark.parametrize("given", ["0", "-1", "soon", "nan", "inf", "60m"])
def test_what_is_no_time_is_refused(given: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diagnose", "runs", "--holdout", "held", f"--within={given}"]) == 2
    assert "such as 60 or 60s" in capsys.readouterr().err


@pytest.mark.check
def test_an_interrupt_leaves_what_was_found(folder: Path, tmp_path: Path) -> None:
    options = [
        "--holdout",
        "runs/holdout_sweep",
        "--out",
        str(tmp_path / "part.yaml"),
        "--json",
        str(tmp_path / "j.json"),
    ]
    line = [sys.executable, "-m", "pneumo_ros", "diagnose", "runs", *options]
    with subprocess.Popen(line, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for said in process.stderr:
            if "ranking further" in said:
                process.send_signal(signal.SIGINT)
                break
        out, err = process.communicate()
    assert process.returncode == 130, err
    assert "Interrupted: finishing what was found" in err
    assert out.startswith("INTERRUPTED after 1 round of the search")
    data = json.loads((tmp_path / "j.json").read_text())
    assert data["interrupted"]
    assert [one["effect"] for one in data["added"]] == ["viscous_friction"]
    assert load_model(tmp_path / "part.yaml").effects[-1] == "viscous_friction"
