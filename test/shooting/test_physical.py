"""Static friction stays above Coulomb friction in every fit."""

import numpy as np
import pytest

from pneumo_ros.plant import load_model
from pneumo_ros.shooting.physical import COULOMB, STATIC, physical

AXIS = load_model("axis")


@pytest.mark.parametrize(
    ("names", "given", "found"),
    [
        ((STATIC, COULOMB), [2e-3, 65.0], [65.0, 65.0]),
        ((COULOMB, STATIC), [65.0, 90.0], [65.0, 90.0]),
        ((STATIC,), [50.0], [AXIS[COULOMB]]),
        ((COULOMB,), [150.0], [150.0]),
        (("quadratic_drag.coefficient",), [1.0], [1.0]),
    ],
)
def test_static_friction_is_raised_to_coulomb_friction(names: tuple[str, ...], given: list, found: list) -> None:
    assert physical(AXIS, names, np.array(given)).tolist() == found
