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


def test_a_chamber_keeps_volume_at_its_end() -> None:
    name = "chambers.volume_b"
    swept = 0.5 * AXIS["piston.stroke"] * AXIS["piston.area_b"]
    (left,) = physical(AXIS, (name,), np.array([1e-8]))
    assert swept < left < 1.01 * swept
    AXIS.with_parameters({name: left}).state()  # a machine that can be
    assert physical(AXIS, (name,), np.array([1e-3])).tolist() == [1e-3]
