"""How long a slip takes until it is certain: meanwhile the force goes on rising, by several newtons."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.equations.breakaway import REST, Breakaway
from pneumo_ros.identify.static_map import sliding_friction
from pneumo_ros.plant import Model

UNSURE = 0.1  # of that time: by a mass and a friction known to a few per cent
_STEP, _SLOWEST = 1e-4, 1.0  # s of the integration; N/s: under a slower rise it makes no difference


def slip_times(model: Model, breakaways: Sequence[Breakaway]) -> tuple[float, ...]:
    """Time [s] of each from the begin of sliding until it was certain, at most the rest before that counts, 0.15 s.

    M v' = F_s + ramp t - F(v) from v = 0, with the friction of steady sliding F(v). The bristle has by then bent to its
    largest deflection, F_s / sigma_0, which is no sliding.
    """
    if not breakaways:
        return ()
    speeds = np.concatenate([[1e-7], np.geomspace(1e-4, 10.0, 200)])
    friction = sliding_friction(model, speeds)
    mass = model["piston.mass"] + float(model.outputs(model.state()[None])["added_mass"][0])
    bent = model["lugre_friction.static_friction"] / model["lugre_friction.bristle_stiffness"]

    def slides(breakaway: Breakaway) -> float:
        rise, v, y, t = max(abs(breakaway.ramp), _SLOWEST), 0.0, 0.0, 0.0
        while y < breakaway.slip - bent and t < REST:
            t += _STEP
            v = max(v + _STEP * (friction[0] + rise * t - float(np.interp(v, speeds, friction))) / mass, 0.0)
            y += _STEP * v
        return t

    return tuple(map(slides, breakaways))
