"""The force at which a resting piston has slipped: its bristles let go, and it takes time to move.

No piston holds static friction itself. From the breakaway deflection on a bristle slides in part, at the velocity of a
force that still rises; friction then has the level of the Stribeck curve at that velocity; and a mass that begins to
slide needs time, in which the force rises by several newtons. All of that depends on the law of friction: a Stribeck
curve of exponent 0.8 lets go 4 N earlier than one of exponent 2, of 100 N.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant.jit import entry

Array = NDArray[np.float64]

SPEEDS = np.geomspace(1e-6, 1.0, 49)  # m/s, at which a level of friction is asked for
SLOWEST = 1.0  # N/s: a force that rises more slowly makes no difference
_STEP, _TURN = 3e-4, 0.15  # s, and radians of the oscillation on the bristles, of a step at most
_STEPS = 20_000  # at most
_PLASTIC = 0.2  # share of the motion that is plastic where it begins


def force_at_slip(
    ramp: Array, slip: Array, mass: Array, stiffness: float, damping: float, ratio: float, level: Array
) -> Array:
    """Force (slips,) [N] at which each piston has slipped.

    M v' = f - sigma_0 z - sigma_1 z' and z' = v (1 - alpha(s) s) with s = sigma_0 z / g(v) (Dupont et al. 2000,
    Eqs. 4-8), under a steadily rising force f, until the piston is `slip` [m] from where its bristles were straight.

    ramp: rise of the force [N/s]; mass [kg]; stiffness [N/m], damping [N s/m] and ratio: sigma_0, sigma_1 and the
    breakaway deflection over the largest one; level (slips, speeds): friction g [N] at each of `SPEEDS`.
    """
    force = np.empty(len(ramp))
    begin = _begin(ratio)
    _until(np.maximum(ramp, SLOWEST), slip, mass, stiffness, damping, ratio, begin, np.log(SPEEDS), level, force)
    return force


@lru_cache
def _begin(ratio: float) -> float:
    """The share of the largest deflection at which `_PLASTIC` of the motion is plastic."""
    share = np.linspace(ratio, 1.0, 200)
    return float(np.interp(_PLASTIC, [_sliding(float(s), ratio) * s for s in share], share))


@entry
def _sliding(share: float, ratio: float) -> float:
    """alpha(s): how much a bristle slides at a share of its largest deflection."""
    if share <= ratio:
        return 0.0
    if share >= 1.0:
        return 1.0
    return float(0.5 + 0.5 * np.sin(np.pi / (1.0 - ratio) * (share - 0.5 * (1.0 + ratio))))


@entry
def _until(
    ramp: Array, slip: Array, mass: Array, stiffness: float, damping: float, ratio: float, begin: float,
    speeds: Array, level: Array, force: Array,
) -> None:  # fmt: skip
    """`force` (slips,) of `force_at_slip`: velocity and bristle in turn, what makes a bristle slide implicit.

    It begins where the motion is still so slow that the force alone decides it.
    """
    last, gap = len(speeds) - 1, speeds[1] - speeds[0]
    for k in range(len(ramp)):
        h = min(_STEP, _TURN * np.sqrt(mass[k] / stiffness))
        v = ramp[k] / ((1.0 - _PLASTIC) * stiffness)
        z, y, f = -1.0, 0.0, 0.0
        for _step in range(_STEPS):
            at = min(max((np.log(max(v, 1e-12)) - speeds[0]) / gap, 0.0), last - 1e-9)
            i = int(at)
            g = max(level[k, i] + (at - i) * (level[k, i + 1] - level[k, i]), 1e-9)
            if z < 0.0:
                z = y = begin * g / stiffness
                f = begin * g
            rate = _sliding(stiffness * z / g, ratio) * stiffness * v / g
            z, y = (z + h * v) / (1.0 + h * rate), y + h * v
            f += h * ramp[k]
            if y >= slip[k]:
                f -= ramp[k] * min((y - slip[k]) / v, h)
                break
            v = max(v + h * (f - stiffness * z - damping * (v - rate * z)) / mass[k], 0.0)
        force[k] = f
