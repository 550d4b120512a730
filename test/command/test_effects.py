"""`pneumo effects NAME`: the source of the equations, with everything they use of their own file."""

import json
from pathlib import Path

import pytest

from pneumo_ros.command.main import main

OWN = '''from pneumo_ros.plant.effect import Effect, Parameter, pi, sin

PITCH = 0.04  # m


def wave(y):
    return sin(2.0 * pi / PITCH * y)


class Detent(Effect):
    """Magnets that hold the piston back."""

    strength = Parameter(5.0, "N", "largest force", neutral=0.0)

    def equations(y, strength):
        force = strength * wave(y)
        return force
'''


def test_functions_and_constants_of_an_equation_are_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["effects", "choked_flow", "--json", str(tmp_path / "e.json")]) == 0
    shown = capsys.readouterr().out
    assert "NORMAL_DENSITY = 1.185  # kg/m3 at 100 kPa" in shown
    assert "def edge_flow(" in shown
    assert "def ratio_function(" in shown  # which only edge_flow calls
    (one,) = json.loads((tmp_path / "e.json").read_text())["effects"]
    assert list(one["helpers"])[-3:] == ["edge_flow", "ratio_function", "root"]


def test_what_comes_from_elsewhere_is_not(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "own.py").write_text(OWN)
    assert main(["effects", "detent", "--effects", str(tmp_path / "own.py")]) == 0
    where = capsys.readouterr().out.partition("Where:\n")[2].partition("\n\n")[0]
    assert where.splitlines() == [
        "    PITCH = 0.04  # m", "    def wave(y):", "        return sin(2.0 * pi / PITCH * y)",
    ]  # fmt: skip


def test_an_equation_that_needs_nothing_else_stands_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["effects", "constant_load"]) == 0
    assert "Where:" not in capsys.readouterr().out
