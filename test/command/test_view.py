"""`pneumo view`: a quick look at recordings in the terminal."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command.lacking import record

import pneumo_ros as pn
from pneumo_ros.command.main import main
from pneumo_ros.command.verb.view import BLOCKS, GAP, sparkline


def test_every_signal_has_its_range_and_its_course(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record(tmp_path / "sweep", "sweep")
    assert main(["view", str(tmp_path / "sweep"), "--json", str(tmp_path / "view.json")]) == 0
    out = capsys.readouterr().out
    assert "sweep: 6.0 s, 6000 samples at 1000 Hz" in out
    (told,) = json.loads((tmp_path / "view.json").read_text())["recordings"]
    for words, field, factor in (("position", "position", 1e3), ("pressure a", "pressure_a", 1e-5)):
        row = next(line for line in out.splitlines() if words in line)
        assert f"{factor * told['signals'][field]['low']:.4g}" in row
        assert sum(letter in BLOCKS[1:] for letter in row) >= 10
    assert max(map(len, out.splitlines())) <= 80


def test_a_machine_that_turns_is_shown_in_its_units(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The recording of a simulation says so by its machine, that of a table by its units."""
    one = pn.simulate("vane", "sine:3,1", seconds=1)
    for name, told in (("machine", one.description), ("table", {"units": {"position": "rad"}})):
        pn.save(replace(one, description=told), tmp_path / name)
        assert main(["view", str(tmp_path / name)]) == 0
        out = capsys.readouterr().out
        assert " mrad " in out
        assert " rad/s " in out
        assert max(map(len, out.splitlines())) <= 80


def test_what_cannot_be_read_is_passed_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record(tmp_path / "good", "steps")
    (tmp_path / "bad.mcap").write_bytes(b"nothing")
    assert main(["view", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert "good: 6.0 s" in out
    assert "Passed over: " in err
    assert "bad.mcap" in err
    assert main(["view", str(tmp_path / "bad.mcap"), "--quiet"]) == 3


def test_a_sparkline_rises_with_its_values() -> None:
    time = np.linspace(0.0, 8.0, 8001)
    assert sparkline(time, time, 8) == BLOCKS[1:]
    assert sparkline(time, 0.0 * time, 3) == BLOCKS[5] * 3
    assert sparkline(time, np.where(time < 4.0, np.nan, time), 4) == f"{GAP * 2}{BLOCKS[1]}{BLOCKS[8]}"


def test_pressures_in_bar_are_named_with_what_to_type(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record(tmp_path / "steps", "steps")
    right = pn.read(tmp_path / "steps")
    assert right.pressure_a is not None
    assert right.pressure_b is not None
    pn.save(replace(right, pressure_a=1e-5 * right.pressure_a, pressure_b=1e-5 * right.pressure_b), tmp_path / "in_bar")
    assert main(["view", str(tmp_path / "in_bar"), "--json", str(tmp_path / "view.json")]) == 1
    assert "Not fit for other verbs: in_bar: chamber_a/pressure" in capsys.readouterr().out
    (told,) = json.loads((tmp_path / "view.json").read_text())["recordings"]
    assert "type --read-as bar" in told["unfit"]
    assert main(["view", str(tmp_path / "in_bar"), "--read-as", "bar"]) == 0
