"""The laws know a machine from its file only; an effect that the file does not list is absent."""

from pathlib import Path

import pytest

from pneumo_ros.control import LAWS, Machine
from pneumo_ros.control.control_file import load_control
from pneumo_ros.control.machine import ABSENT, PARAMETERS
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, Model, load_model
from pneumo_ros.plant.library import FRAME


def test_the_default_is_the_machine_axis() -> None:
    axis = load_model("axis")
    assert Machine.of(axis.effects, axis.parameters) == Machine()
    assert {name: axis[name] for name in PARAMETERS if name in axis.parameters}.items() <= PARAMETERS.items()


def test_effects_that_are_not_listed_are_absent() -> None:
    bare = load_model("axis").with_effects(["arctan_flow"])
    machine = Machine.of(bare.effects, bare.parameters)
    assert machine.static_friction == machine.drag == machine.atmosphere == 0.0
    full = bare.with_effects(["arctan_flow", "payload_mass", "viscous_friction"], {"payload_mass.mass_added": 7.0})
    machine = Machine.of(full.effects, full.parameters)
    assert machine.moving_mass == pytest.approx(12.0)
    assert machine.viscous_friction == full["viscous_friction.coefficient"]


@pytest.mark.parametrize("name", PARAMETERS)
def test_every_parameter_is_one_of_the_plant_and_its_absence_is_allowed(name: str) -> None:
    section, _, key = name.partition(".")
    known = (Library.frame(section) if section in FRAME else Library().find(section)).parameters[key]
    assert known.low <= ABSENT[name] <= known.high
    assert known.low <= PARAMETERS[name] <= known.high


OWN_VALVE = """
from pneumo_ros.plant.effect import Effect, Parameter

class OwnValve(Effect):
    \"\"\"Flow in proportion to the opening.\"\"\"
    gain = Parameter(1e-8, "kg/(s Pa V)", "flow per opening and pressure difference", low=0.0, high=1.0)

    def equations(opening, p_a, p_b, p_s, p_atm, gain):
        valve_flow_a = gain * opening * (p_s - p_a if opening > 0.0 else p_a - p_atm)
        valve_flow_b = -gain * opening * (p_b - p_atm if opening > 0.0 else p_s - p_b)
        return valve_flow_a, valve_flow_b
"""


@pytest.mark.parametrize("name", LAWS)
def test_a_valve_that_no_law_knows_is_refused_where_its_flow_is_inverted(name: str, tmp_path: Path) -> None:
    """Laws once used the coefficients of the default valve here."""
    file = tmp_path / "own_valve.py"
    file.write_text(OWN_VALVE, encoding="utf-8")
    own = Model.build(["dead_zone", "own_valve", "lugre_friction"], {}, library=Library([file]), defaults=True)
    if name == "pid":
        assert load_control(name).make(own.effects, own.parameters).machine.filling_coefficient == 0.0
    else:
        listed = "this machine lists dead_zone, own_valve, lugre_friction: take law pid"
        with pytest.raises(UsageError, match=listed):
            load_control(name).make(own.effects, own.parameters)
