"""How sure the force of a breakaway is, on machines that are hardly known yet.

A light piston on soft bristles breaks away early. It rings on its bristles, at 60 Hz and with little damping, and so
does it as the force rises; friction holds only the level of the Stribeck curve at the velocity of that ringing. And
after a step of the command the force rises by 20 N and more while the slip grows: that is computed with the mass and
the friction of the data sheet.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.evidence import Evidence, RunEvidence
from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

RINGS = 0.3  # of static above Coulomb friction: where ringing takes more off the level, a breakaway does not count


def surely_static(evidence: Evidence, model: Model) -> Evidence:
    """The evidence with breakaways as sure as their recordings show; those of a piston that rings do not count.

    `model`: the machine as known, for its mass and its friction. What ringing takes off the level is an error. So is
    the stated one once more, as mass and friction are the same in all breakaways. These errors have one sign: n
    breakaways together are no surer than the usual one of them, so each has sqrt(n) times its own.
    """
    own = [part.families[-1].noise for part in evidence.by_run]
    shared = [_shared(part, model, noise) for part, noise in zip(evidence.by_run, own, strict=True)]
    count = max(sum(int(np.isfinite(one).sum()) for one in shared), 1)
    noise = [np.sqrt(n**2 + count * s**2) for n, s in zip(own, shared, strict=True)]
    return evidence.with_breakaways(noise)


def _shared(part: RunEvidence, model: Model, noise: Array) -> Array:
    """Error (breakaways,) [N] of one sign of the force at each breakaway of a run; infinite where the piston rang."""
    above = model["lugre_friction.static_friction"] - model["lugre_friction.coulomb_friction"]
    share = np.array([ringing(model, one, one.ramp) for one in part.breakaways])
    return np.where(share < RINGS, np.hypot(noise, share * above), np.inf)


def ringing(model: Model, breakaway: Breakaway, ramp: float) -> float:
    """Share of static above Coulomb friction by which the level is lower where the piston rings, 1 - e^-(v / v_s)^2.

    The velocity v is that of a bristle under a force that rises by `ramp` [N/s], and what is left of that with which
    a piston of mass m stops whose bristles hold Coulomb friction: ramp / sigma_0 + F_c e^(-sigma_1 t / 2 m) /
    sqrt(sigma_0 m), t at rest.
    """
    stiffness, mass = model["lugre_friction.bristle_stiffness"], moving_mass(model)
    left = np.exp(-0.5 * model["lugre_friction.bristle_damping"] * breakaway.rest / mass)
    stopped = model["lugre_friction.coulomb_friction"] / np.sqrt(stiffness * mass)
    velocity = max(ramp, 0.0) / stiffness + stopped * left
    return float(1.0 - np.exp(-((velocity / model["lugre_friction.stribeck_velocity"]) ** 2)))
