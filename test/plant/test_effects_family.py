"""Every effect: documented, consistent in its units, finite, true to the balance of mass.

All are found automatically: a new file in the catalogue is tested without further work.
"""

import pytest
from plant import checks
from plant.catalogue import CATALOGUE, EFFECTS, machine, meaning, neutral_values
from plant.units import AWARE, quantity, unit

from pneumo_ros.plant.signals import SIGNALS

every_effect = pytest.mark.parametrize("name", EFFECTS)
every_listed_effect = pytest.mark.parametrize("name", [effect.name for effect in CATALOGUE])


def test_the_base_machine_is_in_the_catalogue() -> None:
    assert {"dead_zone", "arctan_flow", "lugre_friction", "quadratic_drag", "end_stop"} <= set(EFFECTS)


@every_effect
def test_documented(name: str) -> None:
    checks.check_documentation(EFFECTS[name])


@every_effect
def test_units_are_consistent(name: str) -> None:
    checks.check_units(EFFECTS[name])


@pytest.mark.parametrize("name", [name for name, row in SIGNALS.items() if not row.default[0].isdigit()])
def test_units_of_default_signals(name: str) -> None:
    row, frame = SIGNALS[name], EFFECTS["piston"]
    tree = compile(row.default, name, "eval")
    given = {a: unit(meaning(a, frame)[0]) for a in set(tree.co_names) - {"exp"}}
    if name == "drive":
        given["U"] = unit("N")  # the default of `drive` is for machines without gas, whose input is a force
    assert quantity(eval(tree, {**AWARE, **given})).fits(unit(row.unit))


@every_effect
def test_equations_are_finite_in_their_whole_range(name: str) -> None:
    checks.check_equations_are_finite(EFFECTS[name])


@every_listed_effect
def test_machine_is_finite_for_any_parameters(name: str) -> None:
    checks.check_machine_is_finite(machine(name), EFFECTS[name])


@every_listed_effect
def test_gas_flows_from_high_to_low_pressure(name: str) -> None:
    checks.check_gas_flows_downhill(machine(name))


@every_listed_effect
def test_leak_between_chambers_loses_nothing(name: str) -> None:
    checks.check_leak_is_closed(EFFECTS[name])


def test_what_may_be_missing_in_a_machine_has_a_neutral_value() -> None:
    """All except those that every machine has, and those without a parameter that switches them off."""
    without = {effect.name for effect in CATALOGUE if not neutral_values(effect)}
    assert without == {"arm_load", "arctan_flow", "end_stop", "lugre_friction", "rod_atmospheric_force"}


@every_listed_effect
def test_what_is_switched_on_without_values_is_felt(name: str) -> None:
    values = neutral_values(EFFECTS[name])
    assert not values or any(machine(name).parameters[key] != value for key, value in values.items())
