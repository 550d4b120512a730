"""A rotary vane actuator as a user meets it: rad and N m in every text, its hidden effect found, metres refused."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from command.turning import VANE, record

import pneumo_ros as pn
from pneumo_ros.axis.controller.settings import of_a_machine_file
from pneumo_ros.axis.simulator.machine import machine_from_parameters
from pneumo_ros.command.main import main
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.records import read_recording, write_recording
from pneumo_ros.records.corrections import corrected, parse_words

OF_A_LINE = re.compile(r"[0-9] (mm|m|m/s|mm/s|N(?! m)|kg|N s/m|N/m)(?=[\s,.;:)]|$)", re.MULTILINE)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of the vane as it is, and one with a viscous friction of 0.5 N m s/rad."""
    folder = tmp_path_factory.mktemp("vane")
    record(folder / "plain", 1, 4.0)
    record(folder / "hidden", 1, 4.0, viscous_out=0.5, viscous_in=0.5)
    return folder


def judged(bag: Path, capsys: pytest.CaptureFixture[str], *words: str) -> dict:
    assert main(["compare", str(bag), "--model", "vane", "--json", "-", *words]) == 0
    return json.loads(capsys.readouterr().out)


def test_noise_explains_the_vane_as_it_is(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = judged(folder / "plain" / "run_1", capsys)
    assert all(one["explained_by_noise"] for one in found["equations"].values())
    assert found["typical_error"] < 3.0


def test_its_json_keeps_the_names_and_says_the_units(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = judged(folder / "hidden" / "run_1", capsys)
    assert found["coordinate"] == "rotation"
    assert not found["equations"]["momentum"]["explained_by_noise"]
    assert found["equations"]["momentum"]["unit"] == "N m"
    assert found["equations"]["chamber_a"]["unit"] == "kg/s"
    assert found["equations"]["momentum"]["against"]["velocity"]["unit"] == "rad/s"
    assert found["friction_map"]["velocity_unit"] == "rad/s"
    assert set(found["runs"][0]["error"]) == {"position_m", "pressure_a_pa", "pressure_b_pa"}


def test_no_text_has_a_unit_of_a_line(folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert main(["compare", str(folder / "hidden" / "run_1"), "--model", "vane", "--report", str(page)]) == 0
    out, err = capsys.readouterr()
    assert "mrad" in out
    assert "N m" in out
    assert not OF_A_LINE.findall(out + err)
    body = page.read_text(encoding="utf-8").partition("<script")[0]
    assert "mrad" in body
    text = re.sub(r"<[^>]*>", " ", body.partition("<body")[2])
    assert not OF_A_LINE.findall(text)
    assert main(["compare", str(folder / "hidden" / "run_1"), "--model", "axis", "--json", "-"]) in (0, 3)
    assert "mrad" not in "".join(capsys.readouterr())


def test_results_in_python_have_its_units(folder: Path) -> None:
    found = pn.compare(folder / "hidden" / "run_1", "vane")
    assert "mrad" in str(found)
    assert any("rad" in panel.title for chart in found.charts.values() for panel in getattr(chart, "panels", ()))


def test_the_map_of_friction_is_in_newton_metres(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["effects", "viscous_friction", "--model", "vane"]) == 0
    assert "N m s/rad" in capsys.readouterr().out


@pytest.mark.parametrize(("word", "factor"), [("deg", 57.29577951308232), ("mrad", 1e3)])
def test_angles_in_other_units_are_read(folder: Path, word: str, factor: float) -> None:
    one = read_recording(folder / "plain" / "run_1")
    read = corrected(replace(one, position=factor * one.position), parse_words(word), 1e5)
    assert read.position == pytest.approx(one.position, abs=1e-9)


def test_angles_in_degrees_are_named(folder: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    one = read_recording(folder / "plain" / "run_1")
    signals = {"time": one.time, "pressure_a": one.pressure_a, "pressure_b": one.pressure_b, "voltage": one.voltage}
    write_recording(tmp_path / "degrees", **signals, position=57.29577951308232 * one.position)
    assert main(["compare", str(tmp_path / "degrees"), "--model", "vane"]) == 3
    said = " ".join(capsys.readouterr().err.split())
    assert "outside the stroke of vane, -2.355 to 2.355 rad" in said
    assert "type --read-as deg" in said


@pytest.mark.parametrize(
    ("words", "who"),
    [
        (["tune", "--out", "tuned.yaml"], "a law of control"),
        (["commission", "--out", "found.yaml"], "commissioning"),
        (["experiment", "steps", "--plan"], "an experiment"),
        (["export", "mjcf", "vane", "--out", "vane.xml"], "mjcf"),
    ],
)
def test_what_plans_in_metres_says_what_to_give(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], who: str
) -> None:
    monkeypatch.chdir(tmp_path)
    named = [] if words[0] == "export" else ["--model", "vane"]
    assert main([*words, *named]) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert f"{who} plans in m and N; vane turns, in rad and N m ('coordinate: rotation'). Give a machine that" in said


def test_the_simulator_takes_its_file_as_parameters_and_the_controller_refuses_it() -> None:
    given = {"effects": list(VANE.effects), "coordinate": "rotation", **VANE.parameters}
    assert machine_from_parameters("axis", given).coordinate == "rotation"
    with pytest.raises(UsageError, match=r"laws of control plan in m and N; the machine file says 'coordinate: rot"):
        of_a_machine_file(given)


def diagnosed(folder: Path, capsys: pytest.CaptureFixture[str], **hidden: float) -> dict:
    bags = [str(record(folder, number, **hidden)) for number in range(4)]
    out = str(folder / "found.yaml")
    words = [*bags[:3], "--holdout", bags[3], "--model", "vane", "--out", out, "--json", "-"]
    assert main(["diagnose", *words]) == 0
    assert load_model(out).coordinate == "rotation"
    found: dict = json.loads(capsys.readouterr().out)
    return found


@pytest.mark.check
def test_a_hidden_viscous_friction_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = diagnosed(tmp_path, capsys, viscous_out=0.5, viscous_in=0.5)
    assert [one["effect"] for one in found["added"]] == ["viscous_friction"]
    size = found["added"][0]["parameters"]["coefficient"]
    assert size["unit"] == "N m s/rad"
    assert size["value"] == pytest.approx(0.5, rel=0.02)
    assert found["added"][0]["holdout_error_after"] < 0.02 * found["added"][0]["holdout_error_before"]


@pytest.mark.check
def test_a_hidden_leak_across_the_vane_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = diagnosed(tmp_path, capsys, cross=4e-11)
    assert [one["effect"] for one in found["added"]] == ["cross_piston_leakage"]
    assert found["added"][0]["parameters"]["conductance"]["value"] == pytest.approx(4e-11, rel=0.1)
