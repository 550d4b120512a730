"""Units as exponents of base units."""

import pytest
from plant.catalogue import EFFECTS

from pneumo_ros.export.si_units import exponents


@pytest.mark.parametrize(
    ("unit", "base"),
    [
        ("1", {}),
        ("m/s", {"m": 1, "s": -1}),
        ("N s2/m2", {"kg": 1, "m": -1}),
        ("kg/(s Pa)", {"m": 1, "s": 1}),
        ("J/(kg K)", {"m": 2, "s": -2, "K": -1}),
        ("m3/(s Pa)", {"kg": -1, "m": 4, "s": 1}),
        ("V/V", {}),
        ("1/V", {"kg": -1, "m": -2, "s": 3, "A": 1}),
        ("kg/(s*sqrt(Pa))", None),
        ("bar", None),
        ("m^2", None),
    ],
)
def test_exponents(unit: str, base: dict[str, int] | None) -> None:
    assert exponents(unit) == base


def test_every_unit_of_the_catalogue_is_known_or_has_a_root() -> None:
    units = {p.unit for effect in EFFECTS.values() for p in (*effect.parameters.values(), *effect.states.values())}
    assert {unit for unit in units if exponents(unit) is None and "sqrt" not in unit} == set()
