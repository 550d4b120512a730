"""Machines that hide an effect: drawn by a seed, worn, recorded without naming the effect."""

import json
from random import Random

import pytest

from pneumo_ros.command.console import Console
from pneumo_ros.command.demo.hidden_machine import HIDEABLE, WEAR, hiding_model, record_machine
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import load_model
from pneumo_ros.records import read_recording

BASE = load_model()
SEEDS = range(80)


def test_seeds_hide_every_effect_there_is():
    assert {hiding_model(Random(seed))[1]["effect"] for seed in SEEDS} == set(HIDEABLE)


@pytest.mark.parametrize("seed", SEEDS[:20])
def test_a_machine_is_worn_and_hides_one_effect_of_full_strength(seed):
    machine, truth = hiding_model(Random(seed))
    assert [*machine.effects] == [*BASE.effects, truth["effect"]]
    key, low, high = HIDEABLE[truth["effect"]]
    assert low <= truth["size"] <= high
    assert machine[f"{truth['effect']}.{key}"] == truth["size"]
    changes = [abs(machine[name] / value - 1.0) for name, value in BASE.parameters.items() if value]
    assert 0.0 < max(changes) <= WEAR
    assert machine["piston.mass"] == BASE["piston.mass"]


def test_the_plant_records_what_may_be_fitted_and_what_may_judge(tmp_path):
    truth = tmp_path / "truth.json"
    (tmp_path / "machine").mkdir()
    record_machine(tmp_path / "machine", truth, 3, None, Console(quiet=True))
    hidden = hiding_model(Random(3))[1]
    assert json.loads(truth.read_text())["effects"] == [hidden]
    assert {path.name for path in (tmp_path / "machine").iterdir()} == {"train", "holdout"}
    for part in ("train", "holdout"):
        recordings = [read_recording(path) for path in (tmp_path / "machine" / part).iterdir()]
        assert len(recordings) == 3
        for recording in recordings:
            assert recording.description is None
            assert recording.duration > 10.0
            assert 0.02 < recording.position.max() - recording.position.min() < 1.9
            assert abs(recording.position * 1e5 - (recording.position * 1e5).round()).max() < 1e-6  # steps of 10 um
    told = (path for path in (tmp_path / "machine").rglob("*") if path.is_file())
    assert not any(hidden["effect"].encode() in path.read_bytes() for path in told)


def test_a_simulator_that_fails_is_quoted(tmp_path):
    rig = tmp_path / "rig"
    rig.mkdir()
    (rig / "__main__.py").write_text("raise SystemExit('no compressed air today')\n")
    with pytest.raises(PneumoError, match="no compressed air today"):
        record_machine(tmp_path, tmp_path / "truth.json", 3, rig, Console(quiet=True))
