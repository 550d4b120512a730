"""Recordings of both pressures without a valve command: friction and load are judged, as a user meets it."""

import json
from pathlib import Path

import numpy as np
import pytest
from identify.making import POSITION_NOISE, PRESSURE_NOISE, voltage

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model
from pneumo_ros.records import write_recording

N, DT = 8000, 1e-3
LOAD = 12.0  # N


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two motions of a machine with a constant load, the first also with its valve command."""
    folder, random = tmp_path_factory.mktemp("pressures"), np.random.default_rng(8)
    time = np.arange(N) * DT
    axis = load_model("axis")
    model = axis.with_effects([*axis.effects, "constant_load"], {"constant_load.load": LOAD})
    begin = model.state(p_a=3e5, p_b=3.9e5)
    for name, kind in (("steps", "steps"), ("pushes", "pushes")):
        volts = voltage(kind, time)
        states = np.vstack([begin, model.simulate(volts[:-1], begin)])
        y = states[:, 0] + random.normal(0.0, POSITION_NOISE, N)
        p_a, p_b = (p + random.normal(0.0, PRESSURE_NOISE, N) for p in (states[:, 2], states[:, 3]))
        write_recording(folder / name, time=time, position=y, pressure_a=p_a, pressure_b=p_b)
        write_recording(folder / f"{name}_valve", time=time, position=y, pressure_a=p_a, pressure_b=p_b, voltage=volts)
    return folder


def test_compare_judges_the_momentum_alone(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["compare", str(folder / "steps"), "--json", "-"])
    shown = capsys.readouterr()
    assert "friction and load are judged, driven by the measured pressures" in shown.err
    assert list(json.loads(shown.out)["equations"]) == ["momentum"]


def test_recordings_of_two_kinds_are_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(folder / "steps"), str(folder / "pushes_valve")]) != 0
    assert "steps has no valve command, pushes_valve has one" in capsys.readouterr().err


@pytest.mark.check
def test_an_effect_found_so_goes_into_the_whole_machine(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "better.yaml"
    bags = [str(folder / "steps"), "--holdout", str(folder / "pushes")]
    assert main(["add", "constant_load", *bags, "--out", str(out)]) == 0
    better = load_model(out)
    assert not better.force_driven
    assert better["constant_load.load"] == pytest.approx(LOAD, rel=0.1)


def test_a_verb_that_needs_the_valve_says_so(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", str(folder / "steps")]) != 0
    assert "valve" in capsys.readouterr().err
