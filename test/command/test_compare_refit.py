"""`pneumo compare` with a refit, a report and figures, as a user types it."""

import hashlib
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hiding import environment_without
from identify.making import own

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model, save_model
from pneumo_ros.records import write_recording

COULOMB = "lugre_friction.coulomb_friction"


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two recordings of the default machine, and a machine file with too little friction."""
    folder = tmp_path_factory.mktemp("shelf")
    for kind in ("sweep", "steps"):
        _, _, run = own(kind, seconds=5.0)
        write_recording(folder / kind, time=run.time, position=run.position, pressure_a=run.pressure_a,
                        pressure_b=run.pressure_b, voltage=np.append(run.held, run.held[-1]))  # fmt: skip
    save_model(load_model().with_parameters({COULOMB: 60.0}), folder / "worn.yaml")
    return folder


@pytest.fixture(autouse=True)
def _in_shelf(shelf: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(shelf)


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The error message after a wrong use of compare."""
    assert main(["compare", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    return line


def test_where_it_fails_fits_on_a_screen(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "sweep", "steps", "--model", "worn.yaml", "--quiet"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) < 60
    at = lines.index(next(line for line in lines if line.startswith("  momentum fails: ")))
    assert lines[at - 1].startswith("'worn' against 2 recordings: momentum fails")
    where, follows, worst = (line.strip() for line in lines[at + 1 : at + 4])
    assert where.startswith("where: ")
    assert follows.startswith("follows: ")
    assert worst.startswith("worst: s")


def test_a_refit_takes_segments_of_the_length_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    """Of 5 s of recording, two segments of 2 s; beside a refit only, and of a length that the recording has."""
    words = ["compare", "sweep", "--fit", "sweep", "--model", "worn.yaml", "--quiet", "--json", "-"]
    assert main([*words, "--segment", "2"]) == 0
    found = json.loads(capsys.readouterr().out)["refit"]
    assert found["segments"] == 2
    assert found["parameters"][COULOMB]["value"] == pytest.approx(load_model()[COULOMB], rel=0.05)
    assert "add --refit, or --fit BAG" in refused(capsys, "sweep", "--segment", "2")
    assert "--segment -1 is not a length of time" in refused(capsys, "sweep", "--refit", "--segment", "-1")
    assert main([*words, "--segment", "20"]) == 3
    assert "give a shorter --segment" in capsys.readouterr().err


def test_a_refit_to_two_rates_says_so(shelf: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, _, run = own("sweep", seconds=5.0, sample_time=3e-3)
    write_recording(shelf / "slow", time=run.time, position=run.position, pressure_a=run.pressure_a,
                    pressure_b=run.pressure_b, voltage=np.append(run.held, run.held[-1]))  # fmt: skip
    assert main(["compare", "sweep", "--fit", "steps", "slow", "--json", "-"]) == 0
    out, said = capsys.readouterr()
    assert json.loads(out)["refit"]["runs"] == ["steps", "slow"]
    assert "Rates differ: steps of 1000 Hz count at the 333.3 Hz of the slowest" in said


def test_many_runs_get_a_line_each(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", *["steps"] * 9, "--horizon", "2", "--quiet"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "9 runs, windows of 2 s:"
    assert sum(line.startswith("steps ") for line in lines) == 9


def test_refit_on_some_and_score_others(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out, data = tmp_path / "refitted.yaml", tmp_path / "result.json"
    arguments = ["steps", "--fit", "sweep", "--model", "worn.yaml", "--out", str(out), "--json", str(data), "--quiet"]
    assert main(["compare", *arguments]) == 0
    result = json.loads(data.read_text())
    assert [run["name"] for run in result["runs"]] == ["steps"]
    assert result["refit"]["runs"] == ["sweep"]
    assert COULOMB in result["refit"]["moved"]
    assert load_model(out)[COULOMB] == result["refit"]["parameters"][COULOMB]["value"] == pytest.approx(70.0, rel=0.02)
    assert result["equations"]["momentum"]["ratio_to_noise"] < 5.0  # it is above 100 before
    text = capsys.readouterr().out
    assert text.startswith("Refitted to sweep")
    (moved,) = [line for line in text.splitlines() if line.startswith("The refit moved ")]
    assert COULOMB in moved.partition(" more than 2 standard deviations from what was known before: ")[2]


def test_a_machine_file_needs_a_refit(capsys: pytest.CaptureFixture[str]) -> None:
    assert "--out writes the refitted machine file; add --refit" in refused(capsys, "steps", "--out", "x.yaml")


def test_what_cannot_be_written_is_said_before_any_work(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "there is no folder" in refused(capsys, "steps", "--report", "nowhere/report.html")
    assert "exists" in refused(capsys, "steps", "--figures", str(tmp_path))
    assert "there is no folder" in refused(capsys, "steps", "--refit", "--out", "nowhere/model.yaml")


def test_the_report_is_about_these_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "report.html"
    assert main(["compare", "steps", "--refit", "--model", "worn.yaml", "--report", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert text.startswith("<!doctype html>")
    (recording,) = Path("steps").glob("*.mcap")
    assert str(recording) in text
    assert hashlib.sha256(recording.read_bytes()).hexdigest() in text
    assert "worn.yaml" in text
    assert "Refitted to steps" in text
    assert f"Report written to {page}" in capsys.readouterr().err


@pytest.mark.check
def test_figures_are_written_into_a_new_folder(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="comes with the extra 'figures'")
    assert main(["compare", "steps", "--figures", str(tmp_path / "figures"), "--quiet"]) == 0
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert {"overview.png", "overview.svg", "run-1-position_m.png", "run-1-residuals.svg"} <= names


@pytest.mark.parametrize(("option", "library"), [("--report", "plotly"), ("--figures", "matplotlib")])
def test_a_missing_library_is_one_sentence(option: str, library: str, tmp_path: Path) -> None:
    program = [sys.executable, "-m", "pneumo_ros", "compare", "steps", option, str(tmp_path / "x")]
    environment = environment_without(tmp_path, library)
    done = subprocess.run(program, env=environment, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert f"{library} is not installed" in done.stderr
    assert f"-m pip install {library}" in done.stderr
    assert done.stderr.count("\n") == 1
