"""Machines that the simulator takes: with chambers, and without effects of what only a recording has."""

from pathlib import Path

import pytest

from pneumo_ros.axis.simulator.machine import changed, check_live, machine_from_parameters
from pneumo_ros.axis.simulator.settings import EFFECTS
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

OWN = '''
from pneumo_ros.plant.effect import Effect, Parameter


class Gasping(Effect):
    """A load that follows the supply."""

    share = Parameter(1e-5, "N/Pa", "load per supply pressure", neutral=0.0)

    def equations(measured_supply, share):
        force = share * measured_supply
        return force
'''


@pytest.fixture
def files(tmp_path: Path) -> tuple[str]:
    """A file with an effect that reads a measured signal."""
    (tmp_path / "own.py").write_text(OWN)
    return (str(tmp_path / "own.py"),)


def test_the_machine_of_a_file_is_taken(files: tuple[str]) -> None:
    assert machine_from_parameters("axis", {"piston.mass": 4.0}, files)["piston.mass"] == 4.0


REFUSED = r"effects of axis read what only a recording has \(measured_supply\); the simulator takes a machine file"
EFFECTS_GIVEN = {EFFECTS: [*load_model("axis").effects, "gasping"]}


def test_what_only_a_recording_has_is_refused_at_the_start(files: tuple[str]) -> None:
    with pytest.raises(UsageError, match=REFUSED):
        machine_from_parameters("axis", EFFECTS_GIVEN, files)


def test_what_only_a_recording_has_is_refused_while_it_runs(files: tuple[str]) -> None:
    model = machine_from_parameters("axis", {}, files)
    with pytest.raises(UsageError, match=REFUSED):
        changed(model, EFFECTS_GIVEN)


def test_a_machine_without_chambers_is_refused() -> None:
    with pytest.raises(UsageError, match="emps has no chambers; the simulator takes a machine file with a section"):
        machine_from_parameters("emps", {})


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"lugre_friction.static_friction": 50.0}, "static friction 50 N is below Coulomb friction 70 N"),
        ({"air.supply_pressure": 9e4}, "the supply pressure, 90000 Pa, is absolute"),
        ({"piston.stroke": 0.5}, "the piston is at 0.6 m, outside of a stroke of 0.5 m; move it inside first"),
        ({"chambers.volume_a": 1e-5}, "chamber"),
    ],
)
def test_what_cannot_run_is_refused_while_it_runs(values: dict[str, float], words: str) -> None:
    model = machine_from_parameters("axis", {}, ())
    check_live(model, model, 0.6)
    with pytest.raises(UsageError, match=words):
        check_live(changed(model, values), model, 0.6)


def test_a_piston_that_was_thrown_out_does_not_block_the_mending_of_its_model() -> None:
    model = machine_from_parameters("axis", {}, ())
    check_live(changed(model, {"quadratic_drag.coefficient": 5000.0}), model, -23.0)
    with pytest.raises(UsageError, match=r"the piston is at -23 m, outside of a stroke of 1\.5 m"):
        check_live(changed(model, {"piston.stroke": 1.5}), model, -23.0)
