"""Machine files that state how uncertain their values are: read, written, kept, and refused where senseless."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from plant.test_machine_files import NODE

from pneumo_ros.axis.controller.settings import of_a_machine_file
from pneumo_ros.axis.simulator.machine import machine_from_parameters
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, load_model, model_from_dict, save_model
from pneumo_ros.plant.machine_file import machine_text
from pneumo_ros.shooting.refit import default_free, default_prior, unknowns_of

COULOMB, STATIC = "lugre_friction.coulomb_friction", "lugre_friction.static_friction"
VOLUME, GAIN = "chambers.volume_a", "arctan_flow.voltage_gain"
STATED = """    uncertainty:
      lugre_friction: {coulomb_friction: 12.0, static_friction: 40 %}
      chambers: {volume_a: 3e-5}
"""


def stated(folder: Path, text: str = STATED) -> Path:
    """The default machine with a section of uncertainty."""
    path = folder / "stated.yaml"
    path.write_text(machine_text(load_model("axis")) + text)
    return path


def test_deviations_are_numbers_in_the_unit_or_shares_of_the_value(tmp_path: Path) -> None:
    assert dict(load_model(stated(tmp_path)).uncertainty) == {COULOMB: 12.0, STATIC: 40.0, VOLUME: 3e-5}
    assert not load_model("axis").uncertainty


def test_they_are_saved_and_loaded_again(tmp_path: Path) -> None:
    model = load_model(stated(tmp_path))
    again = load_model(save_model(model, tmp_path / "again.yaml"))
    assert dict(again.uncertainty) == dict(model.uncertainty)
    assert dict(model_from_dict(model.as_dict(), "x", Library()).uncertainty) == dict(model.uncertainty)
    assert "uncertainty" not in load_model("axis").as_dict()


def test_other_values_and_effects_keep_them(tmp_path: Path) -> None:
    model = load_model(stated(tmp_path))
    assert model.with_parameters({COULOMB: 5.0}).uncertainty[COULOMB] == 12.0
    assert dict(model.with_effects(["arctan_flow", "dead_zone", "end_stop"]).uncertainty) == {VOLUME: 3e-5}


def test_nodes_take_them(tmp_path: Path) -> None:
    """ROS gives the names of a file with dots."""
    model = load_model(stated(tmp_path))
    given = {"effects": list(model.effects), **model.parameters, f"uncertainty.{COULOMB}": 12.0}
    assert dict(machine_from_parameters("axis", given).uncertainty) == {COULOMB: 12.0}
    assert f"uncertainty.{COULOMB}" in of_a_machine_file(given)


def test_what_is_uncertain_is_free_with_that_prior(tmp_path: Path) -> None:
    model, axis = load_model(stated(tmp_path)), load_model("axis")
    assert set(default_free(model)) - set(default_free(axis)) == {VOLUME}
    assert default_prior(model, COULOMB) == 12.0
    assert default_prior(model, GAIN) == default_prior(axis, GAIN) == 0.05 * axis[GAIN]


def test_what_is_known_exactly_is_not_free_and_stays_so(tmp_path: Path) -> None:
    text = "    uncertainty: {lugre_friction: {coulomb_friction: 0.0, static_friction: 40 %}}\n"
    model = load_model(stated(tmp_path, text))
    assert model.exact == {COULOMB}
    assert set(default_free(load_model("axis"))) - set(default_free(model)) == {COULOMB}
    assert load_model(save_model(model, tmp_path / "again.yaml")).exact == {COULOMB}
    assert dict(model.with_uncertainty({STATIC: 3.0}).uncertainty) == {COULOMB: 0.0, STATIC: 3.0}
    assert not model.with_uncertainty({COULOMB: 3.0}).exact


def test_who_asks_for_a_fit_of_it_is_told_why_not(tmp_path: Path) -> None:
    model = load_model(stated(tmp_path, "    uncertainty: {lugre_friction: {coulomb_friction: 0 %}}\n"))
    with pytest.raises(UsageError, match=r"prior of lugre_friction.coulomb_friction is 0 N;.* to be known exactly"):
        unknowns_of(model, (COULOMB,), {})
    assert unknowns_of(model, (COULOMB,), {COULOMB: 2.0}).prior[0] == 2.0


@pytest.mark.parametrize(
    ("section", "error"),
    [
        ("{lugre_friction: {coulom: 1.0}}", r"unknown parameter 'lugre_friction.coulom'; did you mean"),
        ("{lugre_friction: {coulomb_friction: -1.0}}", r"is -1.0; it takes a standard deviation, .* in N or as a"),
        ("{lugre_friction: {coulomb_friction: -5 %}}", r"coulomb_friction is '-5 %'.*or 0 for a value that is known"),
        ("{lugre_friction: {coulomb_friction: .inf}}", r"coulomb_friction is inf"),
        ("{lugre_friction: {coulomb_friction: [1]}}", r"coulomb_friction is \[1\]"),
        ("{lugre_friction: {coulomb_friction: true}}", r"coulomb_friction is True"),
        ("7", r"section uncertainty is 7; it takes parameters"),
    ],
)
def test_nonsense_is_refused_in_words(tmp_path: Path, section: str, error: str) -> None:
    with pytest.raises(UsageError, match=error):
        load_model(stated(tmp_path, f"    uncertainty: {section}\n"))


def test_a_share_of_nothing_is_refused(tmp_path: Path) -> None:
    path = stated(tmp_path, "    uncertainty: {lugre_friction: {static_friction: 20 %}}\n")
    path.write_text(path.read_text().replace("static_friction: 100.0", "static_friction: 0.0"))
    with pytest.raises(UsageError, match=r"a share of lugre_friction.static_friction = 0 says nothing"):
        load_model(path)


def test_ros_reads_the_section(tmp_path: Path) -> None:
    """Through rclpy's own parser, by dotted names."""
    path = save_model(load_model(stated(tmp_path)), tmp_path / "saved.yaml")
    done = subprocess.run([sys.executable, "-c", NODE, str(path)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert found[f"uncertainty.{COULOMB}"] == ["DOUBLE", 12.0]
    assert found[f"uncertainty.{VOLUME}"] == ["DOUBLE", 3e-5]
