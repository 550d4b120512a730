"""What holds between parameters, whatever recordings say.

Static friction is not below Coulomb friction, and a chamber has some volume left at its end.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber

Array = NDArray[np.float64]

STATIC, COULOMB = "lugre_friction.static_friction", "lugre_friction.coulomb_friction"
LEFT = 1.001  # times the swept volume: the least that a chamber has at mid stroke


def physical(model: Model, names: Sequence[str], theta: Array) -> Array:
    """Values theta (names,) of free parameters, with static friction and volumes raised where they are too small.

    What is not among `names` has the value of `model`. A static friction that is not free stays as it is.
    """
    least = {chamber.volume: _swept(model, chamber) for chamber in model.chambers if chamber.volume in names}
    if STATIC in names:
        least[STATIC] = theta[names.index(COULOMB)] if COULOMB in names else model[COULOMB]
    if not least:
        return theta
    raised: Array = theta.copy()
    for name, bound in least.items():
        raised[names.index(name)] = max(raised[names.index(name)], bound)
    return raised


def _swept(model: Model, chamber: Chamber) -> float:
    return LEFT * 0.5 * float(model["piston.stroke"]) * float(model[chamber.area])
