"""Dotted parameters of a machine of several axes: what each axis has of them."""

import pytest

from pneumo_ros.axis.sections import flat, nested, of_axis, of_the_machine, settings_of, with_arm
from pneumo_ros.axis.simulator.machine import machine_of_axes
from pneumo_ros.control.machine import ARM
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model

FILE = "config/arm/pruning.yaml"
GIVEN = {
    "axes": ["lift", "reach"], "supply_pressure_droop.time_constant": 0.3, "air.supply_pressure": 6e5,
    "lift.effects": ["dead_zone"], "lift.piston.mass": 16.8, "reach.effects": [""], "reach.piston.mass": 5.8,
    "dead_zone.right_limit": 0.5, "law": "cascade", "lift.cascade.damping": 250.0, "cascade.damping": 300.0,
}  # fmt: skip
OWN = {"law", "cascade.damping", "joint_name"}


def test_sections_and_dotted_names_are_the_same() -> None:
    values = {"a.b.c": 1.0, "a.d": [2.0, 3.0], "e": "text"}
    assert nested(values) == {"a": {"b": {"c": 1.0}, "d": [2.0, 3.0]}, "e": "text"}
    assert flat(nested(values)) == values
    with pytest.raises(UsageError, match=r"lift\.piston\.mass is given, and lift as a value"):
        nested({"lift": 5.0, "lift.piston.mass": 3.0})


def test_a_node_has_what_holds_for_its_axis() -> None:
    lift, reach = (dict(of_axis(GIVEN, f"/arm/{axis}", OWN, "controller")) for axis in ("lift", "reach"))
    assert lift == {
        "joint_name": "lift", "air.supply_pressure": 6e5, "effects": ["dead_zone"], "piston.mass": 16.8,
        "dead_zone.right_limit": 0.5, "law": "cascade", "cascade.damping": 250.0,
    }  # fmt: skip
    assert "dead_zone.right_limit" not in reach  # it lists no such effect
    assert reach["cascade.damping"] == 300.0


def test_a_machine_of_one_axis_is_left_as_it_is() -> None:
    one = {"effects": ["dead_zone"], "piston.mass": 5.0}
    assert of_axis(one, "/anywhere", OWN, "controller") is one


def test_a_namespace_of_no_axis_is_told_what_to_type() -> None:
    with pytest.raises(UsageError, match=r"the axes lift, reach, and a controller moves one.*-r __ns:=/lift"):
        of_axis(GIVEN, "/", OWN, "controller")


def test_settings_and_machine_are_kept_apart() -> None:
    assert settings_of(GIVEN, "lift", OWN) == {"law": "cascade", "cascade.damping": 250.0}
    assert not {"law", "lift.cascade.damping"} & {*of_the_machine(GIVEN, ("lift", "reach"), OWN)}


def test_an_arm_is_taken_from_its_urdf() -> None:
    folder = "config/arm/"
    given = {
        "piston.stroke": 0.25, "effects": ["arm_load"], "arm_load.urdf": f"{folder}lever.urdf",
        "arm_load.joint": "shoulder", "arm_load.between": ["base_pin", "rod_pin"], "arm_load.length": 0.52,
    }  # fmt: skip
    found = with_arm(given)
    expected = load_model(f"{folder}lever.yaml").parameters
    assert found["effects"] == ["arm_load"]
    assert "arm_load.urdf" not in found
    for name in ARM:
        assert found.get(name, 0.0) == pytest.approx(expected[name])
    assert with_arm(GIVEN) is GIVEN


def test_parameters_change_axes_of_a_file() -> None:
    machine = machine_of_axes(FILE, {"reach.piston.mass": 7.0, "supply_pressure_droop.time_constant": 0.5})
    assert machine.axes["reach"]["piston.mass"] == 7.0
    assert machine.axes["lift"]["piston.mass"] == 16.8
    assert machine.supply == {"resistance_supply": 5e6, "time_constant": 0.5}
    with pytest.raises(UsageError, match=r"reach\.piston\.mass"):
        machine_of_axes(FILE, {"reach.piston.mas": 7.0, "reah.piston.mass": 7.0})
