"""What holds between parameters, whatever recordings say: static friction is not below Coulomb friction."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model

Array = NDArray[np.float64]

STATIC, COULOMB = "lugre_friction.static_friction", "lugre_friction.coulomb_friction"


def physical(model: Model, names: Sequence[str], theta: Array) -> Array:
    """Values theta (names,) of free parameters, with static friction raised to Coulomb friction where it is below.

    What is not among `names` has the value of `model`. A static friction that is not free stays as it is.
    """
    if STATIC not in names:
        return theta
    coulomb = theta[names.index(COULOMB)] if COULOMB in names else model[COULOMB]
    raised: Array = theta.copy()
    raised[names.index(STATIC)] = max(raised[names.index(STATIC)], coulomb)
    return raised
