"""`pneumo commission` without a plant: refusals before anything moves, and its texts."""

from pathlib import Path

import pytest

from pneumo_ros.command.commissioning_text import outcome_text, parameters_text, wiring_text
from pneumo_ros.command.main import main
from pneumo_ros.command.verb.commission import _roles
from pneumo_ros.commission.wiring import FAULTS, Wired
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import save_model

SHEET = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    """A machine file that does not say which signal closes its valve."""
    path = tmp_path / "sheet.yaml"
    save_model(design(SHEET, load_shelf([])).model, path)
    return path


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ([], "does not say which signal closes the valve"),
        (["--closed", "0V", "--minutes", "0"], "--minutes is 0; it takes a number above 0"),
        (["--closed", "0V", "--evaluations", "-1"], "--evaluations is -1; it takes 0 or more"),
        (["--closed", "0V", "--read-as", "closed=5V"], "--closed and the wiring both say"),
        (["--closed", "0V", "--read-as", "gauge,bar", "--sensors", "gauge-bar"], "--sensors and the wiring both say"),
        (["--closed", "0V", "--sensors", "gauge-bra"], "gauge-bar"),
        (["--closed", "five"], "--closed is 'five'; it takes a number with its unit, such as 5V"),
    ],
)
def test_nothing_moves_while_something_is_undeclared(
    sheet: Path, options: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = sheet.with_name("mine.yaml")
    assert main(["commission", "--model", str(sheet), "--out", str(out), *options]) == 2
    assert sentence in capsys.readouterr().err
    assert sorted(path.name for path in sheet.parent.iterdir()) == ["sheet.yaml"]


def test_what_to_swap_is_said() -> None:
    said = wiring_text(Wired(("gauge", "bar", "reversed-voltage"), True))
    assert said.splitlines()[0] == "Wiring: gauge, bar; something is swapped or reversed."
    assert FAULTS["reversed-voltage"] in said
    assert "not certain" in wiring_text(Wired((), False))


def test_what_was_found_and_what_lacks_is_said() -> None:
    one = {"before": 23.6, "prior": 26.0, "value": 30.02, "std": 0.1, "low": 29.8, "high": 30.2, "unit": "N"}
    result = {
        "parameters": {"lugre_friction.coulomb_friction": {**one, "determined": True},
                       "lugre_friction.static_friction": {**one, "determined": False}},
        "error_over_noise": {"before": 270.0, "after": None}, "seconds": 92.0, "moves": [1, 2], "next_move": "sweep",
        "next_minute": 0.07, "undetermined": ["lugre_friction.static_friction"],
    }  # fmt: skip
    table = parameters_text(result).splitlines()
    assert table[1].split()[2:] == ["30.02", "29.82", "to", "30.22", "N"]
    assert table[2].split()[3] == "-"
    said = outcome_text(result)
    assert "would narrow the intervals by 7 %" in said
    assert "Not determined by these moves: lugre_friction.static_friction." in said
    assert "an unknown multiple of its noise" in said


def test_the_diagnosis_that_is_named_next_keeps_the_last_move_to_judge_by(tmp_path: Path) -> None:
    for name in ("00_wiring/plumbing", "02_dynamic/steps", "02_dynamic/sweep", "03_steps_broken_1/steps"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "metadata.yaml").write_text("")
        (tmp_path / name).with_name("programme.yaml").write_text("")
    held = f"{tmp_path}/02_dynamic/steps {tmp_path}/02_dynamic/sweep"
    assert _roles(tmp_path) == f"{tmp_path}/*/ --holdout {held}"
    (tmp_path / "04_steps").mkdir()  # at which the piston stayed
    (tmp_path / "04_steps" / "programme.yaml").write_text("")
    each = " ".join(str(tmp_path / name) for name in ("00_wiring", "02_dynamic", "03_steps_broken_1"))
    assert _roles(tmp_path) == f"{each} --holdout {held}"
