"""Control files: written and read back, the shipped ones, and refusals."""

from importlib.resources import files
from pathlib import Path

import pytest
import yaml

from pneumo_ros.control import LAWS, ValveInverse
from pneumo_ros.control.control_file import Control, load_control
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import load_model


@pytest.mark.parametrize("law", LAWS)
def test_what_is_written_is_read_back(law: str, tmp_path: Path) -> None:
    gains = {name: 0.5 * (gain.low + gain.default) for name, gain in LAWS[law].gains.items()}
    file = tmp_path / "control.yaml"
    file.write_text(Control(law, gains, 0.05).text("two\nlines"), encoding="utf-8")
    assert load_control(file) == Control(law, gains, 0.05)
    assert file.read_text(encoding="utf-8").startswith("# two\n# lines\n/**:")


@pytest.mark.parametrize("law", LAWS)
def test_a_tuned_file_ships_for_every_law_with_every_gain_and_its_unit(law: str) -> None:
    text = (files("pneumo_ros.config") / "control" / f"{law}.yaml").read_text(encoding="utf-8")
    given = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert set(given[law]) == set(LAWS[law].gains)
    assert all(isinstance(value, float) for value in given[law].values())  # an int would be no double for ROS
    for name, gain in LAWS[law].gains.items():
        line = next(line for line in text.splitlines() if line.strip().startswith(f"{name}:"))
        assert f"[{gain.unit}] {gain.meaning}" in line
    assert load_control(law).law == law


def test_a_law_knows_the_machine_it_is_made_for() -> None:
    bare = load_model("axis").with_effects(["arctan_flow"])
    law = load_control("cascade").make(bare.effects, bare.parameters)
    assert law.valve == ValveInverse(right_limit=0.0, left_limit=0.0)
    assert law.machine.static_friction == 0.0
    crooked = load_model("axis").with_parameters({"dead_zone.left_limit": 0.5, "piston.mass": 7.0})
    law = load_control("cascade").make(crooked.effects, crooked.parameters)
    assert (law.valve.left_limit, law.machine.mass) == (0.5, 7.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("law: pid", "ros__parameters"),
        ("/**: {ros__parameters: {law: cascde}}", "did you mean cascade"),
        ("/**: {ros__parameters: {law: pid, pid: {proportionl: 1.0}}}", "did you mean proportional"),
        ("/**: {ros__parameters: {law: pid, pid: {proportional: -1.0}}}", "allowed is 0 to"),
        ("/**: {ros__parameters: {law: [pid]}}", "unknown law '.'pid'.'"),
        ("/**: {ros__parameters: {law: pid, pid: [1.0]}}", "section pid is .1.0.; it takes entries"),
        ("/**: {ros__parameters: {law: pid, pid: {null: 1.0}}}", "section pid is .None"),
        (f"/**: {{ros__parameters: {{law: pid, pid: {{proportional: 1{350 * '0'}}}}}}}", "gain proportional is 1000"),
        ("/**: {ros__parameters: {law: pid, valve: 0.1}}", "section valve is 0.1"),
        ("/**: {ros__parameters: {law: pid, valve: {smoothing: .nan}}}", "valve.smoothing is nan"),
        (f"/**: {{ros__parameters: {{law: pid, valve: {{smoothing: 1{350 * '0'}}}}}}}", "valve.smoothing is 1000"),
    ],
)
def test_what_is_no_control_file_is_refused(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "control.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=said):
        load_control(file)


@pytest.mark.parametrize("name", ["no_such", "/no/such.yaml", "."])
def test_what_cannot_be_read_is_said_with_what_there_is(name: str) -> None:
    with pytest.raises(DataError, match="cascade"):
        load_control(name)
