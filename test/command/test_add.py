"""`pneumo add`: effects by name, recordings by path, error before and after."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from command.lacking import VISCOUS, shelf

from pneumo_ros.command.main import main
from pneumo_ros.command.verb.add import separated
from pneumo_ros.plant import load_model


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of a machine with viscous friction."""
    return shelf(tmp_path_factory.mktemp("add"), ["steps"])


@pytest.fixture(autouse=True)
def _inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)


@pytest.mark.check
def test_the_error_falls_to_the_noise_floor(folder: Path) -> None:
    options = ["--holdout", "runs/holdout_sweep", "--out", "more.yaml", "--json", "more.json", "--report", "page.html"]
    line = [sys.executable, "-m", "pneumo_ros", "add", "viscous_friction", "runs", *options]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("Added viscous_friction to 'axis'. On 1 recording held out, ")
    assert "It does NOT help" not in done.stdout
    assert "Machine file written to more.yaml" in done.stderr
    data = json.loads((folder / "more.json").read_text())
    (added,) = data["added"]
    own = added["parameters"]["coefficient"]
    assert data["held_out"]
    assert added["error_after"] < 1.5 < 5.0 < added["error_before"]
    assert own["value"] == pytest.approx(VISCOUS, rel=0.02)
    assert own["low"] < VISCOUS < own["high"]
    assert load_model(folder / "more.yaml")["viscous_friction.coefficient"] == own["value"]
    first = (folder / "page.html").read_text().partition('id="summary"')[2].partition("</section>")[0]
    assert "was not fitted: measured, before and after" in first
    assert "At the machine, for viscous_friction: look at the grease" in first
    assert "with viscous_friction" in first


def test_effects_and_recordings_are_separated() -> None:
    model = load_model()
    assert separated(["runs", "payload_mass", "runs/steps"], model) == (["payload_mass"], ["runs", "runs/steps"])


@pytest.mark.parametrize(
    ("named", "sentence"),
    [
        (
            ["viscous_frction", "runs"],
            "'viscous_frction' is neither an effect nor an existing recording; did you mean",
        ),
        (["zzz", "runs"], "'zzz' is neither an effect nor an existing recording; see: pneumo effects"),
        (["payload_mass", "runs/stepps"], "there is no recording runs/stepps"),
        (["runs"], "name an effect to add"),
        (["payload_mass"], "pneumo add payload_mass BAG... --out MODEL"),
        (["lugre_friction", "runs"], "lugre_friction is in 'axis' already"),
        (["payload_mass", "payload_mass", "runs"], "payload_mass is named twice"),
        (["payload_mass", "runs/steps", "--holdout", "runs/steps"], "runs/steps is to be fitted and held out"),
    ],
)
def test_wrong_use_is_one_sentence(named: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["add", *named, "--out", "x.yaml", "--quiet"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert sentence in err
    assert err.count("\n") == 1
    assert not Path("x.yaml").exists()


def test_what_is_there_is_kept(capsys: pytest.CaptureFixture[str]) -> None:
    Path("kept.yaml").write_text("mine")
    assert main(["add", "payload_mass", "runs", "--out", "kept.yaml"]) == 2
    assert "kept.yaml exists; name another file, or add --overwrite" in capsys.readouterr().err
    assert main(["add", "payload_mass", "runs"]) == 2
    assert "required: --out" in capsys.readouterr().err
