"""Parameters that a refit moved, and those it could not determine."""

import pytest
from identify.making import own

from pneumo_ros.compare.moved import refit_dict
from pneumo_ros.shooting.refit import refit

FREE = ["lugre_friction.coulomb_friction", "quadratic_drag.coefficient", "arctan_flow.filling_coefficient"]


@pytest.fixture(scope="module")
def found() -> dict[str, object]:
    """A refit from Coulomb friction 14 % too low, of parameters known to 5 %."""
    model, _, run = own("sweep", seconds=6.0)
    wrong = model.with_parameters({"lugre_friction.coulomb_friction": 60.0})
    return refit_dict(refit(wrong, [run], free=FREE), ["sweep"])


def test_a_parameter_far_from_what_was_known_is_named(found: dict[str, object]) -> None:
    assert found["moved"] == ["lugre_friction.coulomb_friction"]
    coulomb = found["parameters"]["lugre_friction.coulomb_friction"]
    assert coulomb["before"] == 60.0
    assert coulomb["value"] == pytest.approx(70.0, rel=0.01)
    assert coulomb["low"] < coulomb["value"] < coulomb["high"]
    assert coulomb["priors_moved"] == pytest.approx(10.0 / (0.05 * 70.0), rel=0.05)  # known to 5 % of its default
    assert coulomb["unit"] == "N"
    assert coulomb["determined"] is True


def test_the_others_stay_and_are_listed(found: dict[str, object]) -> None:
    assert list(found["parameters"]) == FREE
    assert found["undetermined"] == []
    assert found["runs"] == ["sweep"]
    assert abs(found["parameters"]["quadratic_drag.coefficient"]["priors_moved"]) < 0.5
