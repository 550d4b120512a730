"""What the laws know of a machine is what its file says, and an effect that it does not list is not there."""

import pytest

from pneumo_ros.control import Machine
from pneumo_ros.control.machine import ABSENT, PARAMETERS
from pneumo_ros.plant import Library, load_model
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
