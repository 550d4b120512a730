"""Only effects that change something which recordings show are tried on a machine."""

import pytest

from pneumo_ros.diagnose.hypothesis import missing
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, load_model, model_from_dict


def test_no_effect_of_a_supply_is_tried_without_a_valve() -> None:
    found = missing(load_model("emps"), ("U",))
    assert "asymmetric_viscous_friction" in found
    assert "supply_pressure_droop" not in found


def test_a_machine_with_a_valve_is_asked_for_its_supply() -> None:
    assert "supply_pressure_droop" in missing(load_model("axis"), ("U",))


def test_the_inertia_of_a_small_servo_is_allowed_where_it_turns() -> None:
    given = load_model("emps").as_dict() | {"coordinate": "rotation"}
    small = model_from_dict(given, "servo", Library()).with_parameters({"piston.mass": 6e-5})  # kg m2
    assert small["piston.mass"] == 6e-5
    with pytest.raises(UsageError, match=r"piston.mass is 6e-05 kg; allowed is 0.001 to 10000"):
        load_model("emps").with_parameters({"piston.mass": 6e-5})
