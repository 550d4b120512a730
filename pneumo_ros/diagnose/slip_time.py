"""Time from the start of a slip until it is certain, in which the force rises by several newtons."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.equations.slip import SLOWEST
from pneumo_ros.identify.static_map import sliding_friction
from pneumo_ros.plant import Model
from pneumo_ros.runs.rests import REST

UNSURE = 0.1  # relative uncertainty of that time, from mass and friction known to a few per cent
_STEP = 1e-4  # s of the integration


def slip_times(model: Model, breakaways: Sequence[Breakaway]) -> tuple[float, ...]:
    """Time [s] of each breakaway from the start of sliding until it was certain, at most the shortest rest, 0.15 s.

    M v' = F_s + ramp t - F(v) from v = 0, with the friction of steady sliding F(v). The largest bristle deflection,
    F_s / sigma_0, is not sliding and is subtracted from the distance.
    """
    if not breakaways:
        return ()
    speeds = np.concatenate([[1e-7], np.geomspace(1e-4, 10.0, 200)])
    friction = sliding_friction(model, speeds)
    mass = moving_mass(model)
    bent = model["lugre_friction.static_friction"] / model["lugre_friction.bristle_stiffness"]

    def slides(breakaway: Breakaway) -> float:
        rise, v, y, t = max(abs(breakaway.ramp), SLOWEST), 0.0, 0.0, 0.0
        while y < breakaway.slip - bent and t < REST:
            t += _STEP
            v = max(v + _STEP * (friction[0] + rise * t - float(np.interp(v, speeds, friction))) / mass, 0.0)
            y += _STEP * v
        return t

    return tuple(map(slides, breakaways))
