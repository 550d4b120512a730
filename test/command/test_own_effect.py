"""An effect from a user's file takes part: simulated, found missing, added by name."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from pneumo_ros.plant import load_model, save_model

MINE = '''from pneumo_ros.plant.effect import Effect, Parameter, sin


class MagneticDetent(Effect):
    """Magnets along the barrel that hold the piston back every 40 mm."""

    strength = Parameter(5.0, "N", "largest force", low=-100.0, high=100.0, neutral=0.0)

    def equations(y, strength):
        force = strength * sin(157.0796 * y)
        return force
'''
STRENGTH = 12.0


def pneumo(*arguments: str, folder: Path) -> "subprocess.CompletedProcess[str]":
    """A command as a user types it, with the effects of the file."""
    line = [sys.executable, "-m", "pneumo_ros", *arguments, "--effects", "mine.py"]
    return subprocess.run(line, cwd=folder, capture_output=True, text=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file, and recordings that `pneumo simulate` made with its effect."""
    folder = tmp_path_factory.mktemp("own")
    (folder / "mine.py").write_text(MINE)
    model = load_model("axis", [folder / "mine.py"])
    truth = model.with_effects([*model.effects, "magnetic_detent"], {"magnetic_detent.strength": STRENGTH})
    save_model(truth, folder / "truth.yaml")
    for name, wave in (("fast", "sine:2.5,0.4"), ("far", "sine:3,0.25"), ("holdout", "sine:2,0.3")):
        options = ["--model", "truth.yaml", "--input", wave, "--seconds", "4", "--out", name]
        done = pneumo("simulate", *options, folder=folder)
        assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.check
def test_it_is_found_missing(folder: Path) -> None:
    done = pneumo(
        "diagnose", "fast", "far", "--holdout", "holdout", "--json", "d.json", "--out", "found.yaml", folder=folder
    )
    assert done.returncode == 0, done.stderr
    (added,) = json.loads((folder / "d.json").read_text())["added"]
    assert added["effect"] == "magnetic_detent"
    assert added["parameters"]["strength"]["value"] == pytest.approx(STRENGTH, rel=0.02)
    assert "magnetic_detent" in load_model(folder / "found.yaml", [folder / "mine.py"]).effects


@pytest.mark.check
def test_it_is_added_by_name(folder: Path) -> None:
    done = pneumo("add", "magnetic_detent", "fast", "--out", "more.yaml", "--json", "a.json", folder=folder)
    assert done.returncode == 0, done.stderr
    assert "that were fitted too" in done.stdout
    (added,) = json.loads((folder / "a.json").read_text())["added"]
    assert added["parameters"]["strength"]["value"] == pytest.approx(STRENGTH, rel=0.02)


def test_one_that_cannot_fade_in_is_named(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(MINE.replace(", neutral=0.0", ""))
    bag = str(folder / "fast")
    done = pneumo("add", "magnetic_detent", bag, "--out", "no.yaml", folder=tmp_path)
    assert done.returncode == 2
    assert "magnetic_detent cannot be fitted" in done.stderr
    assert "neutral=0.0" in done.stderr


def test_the_guide_can_be_typed(tmp_path: Path) -> None:
    """The file of docs/own_effect.md, and the machine file that its commands make."""
    guide = (Path(__file__).parents[2] / "docs" / "own_effect.md").read_text()
    blocks = {kind: re.findall(f"```{kind}\n(.*?)```", guide, re.DOTALL) for kind in ("python", "sh")}
    (tmp_path / "my_effects.py").write_text(blocks["python"][0])
    commands = blocks["sh"][0].replace("$(python ", f"$({shlex.quote(sys.executable)} ")
    subprocess.run(["sh", "-ec", commands], cwd=tmp_path, check=True)
    model = load_model(tmp_path / "leaky.yaml", [tmp_path / "my_effects.py"])
    assert model["seal_leak.conductance"] == 1.5e-7
    assert model.effects[-1] == "seal_leak"
