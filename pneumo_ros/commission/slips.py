"""How sure the force of a breakaway is that of static friction, on machines that are hardly known yet.

A light piston on soft bristles breaks away below the static friction. It rings on its bristles, at 60 Hz and with
little damping, and so does it as the force rises; friction holds only the level of the Stribeck curve at the velocity
of that ringing. And after a step of the command the force rises by 20 N and more while the slip grows: when the slip
began is computed with mass and friction of the data sheet, and the rise before it. A force that rises at all finds a
bristle that begins to slide before its largest deflection, and so no piston holds static friction itself.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.evidence import Evidence, RunEvidence
from pneumo_ros.equations.breakaway import Breakaway, holding_force
from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

HALF = 0.5  # of the rise of the force during the slip, and of `letting_go`: their deviations
RINGS = 0.1  # of static above Coulomb friction: where ringing takes more off the level, a breakaway does not count
_JUST = 0.02  # s before the slip, in which its ramp is looked for
_SHARES = 400  # of the largest deflection, at which the force that a bristle holds is looked for


def surely_static(evidence: Evidence, model: Model) -> Evidence:
    """The evidence with breakaways as sure as their recordings show; those of a piston that rings do not count.

    `model`: the machine as known, for the force on its piston, its mass and its friction. The errors have one sign:
    n breakaways together are no surer than the usual one of them, so each has sqrt(n) times its own.
    """
    shared = [_shared(part, model) for part in evidence.by_run]
    count = max(sum(int(np.isfinite(one).sum()) for one in shared), 1)
    own = [part.families[-1].noise for part in evidence.by_run]
    noise = [np.sqrt(n**2 + count * s**2) for n, s in zip(own, shared, strict=True)]
    return evidence.with_breakaways(noise)


def _shared(part: RunEvidence, model: Model) -> Array:
    """Error (breakaways,) [N] of one sign of the force at each breakaway of a run; infinite where the piston rang."""
    error = np.full(len(part.breakaways), np.inf)
    if not part.breakaways:
        return error
    run, force = part.run, holding_force(model, part.run)
    above = model["lugre_friction.static_friction"] - model["lugre_friction.coulomb_friction"]
    just = max(round(_JUST / run.sample_time), 1)
    for k, (one, rows, inner) in enumerate(zip(part.breakaways, part.spans, part.inner, strict=True)):
        begun = min(int(rows[0]) + inner.stop - 1, one.index)
        held = one.direction * force[max(begun - just, 0) : one.index + 1]
        before = min(just, begun)
        rise = float(held[before:].max() - held[before])
        ramp = (held[before] - held[0]) / (max(before, 1) * run.sample_time)
        ramp = max(float(ramp), rise / max((one.index - begun) * run.sample_time, 1e-3))
        share = ringing(model, one, ramp)
        if share < RINGS:
            error[k] = np.linalg.norm([HALF * rise, HALF * letting_go(model, ramp), share * above])
    return error


def letting_go(model: Model, ramp: float) -> float:
    """How far below static friction [N] a bristle lets go as the force rises by `ramp` [N/s].

    From breakaway_ratio on, a bristle slides in part (Dupont et al. 2000, Eqs. 4-8): sigma_0 z = s g(v) and
    z' = v (1 - alpha(s) s), so the velocity is v = ramp / (sigma_0 (1 - alpha(s) s)), and the force held at most is the
    largest of s g(v) over s up to 1.
    """
    static, coulomb = model["lugre_friction.static_friction"], model["lugre_friction.coulomb_friction"]
    ratio, stiffness = model["lugre_friction.breakaway_ratio"], model["lugre_friction.bristle_stiffness"]
    share = np.linspace(ratio, 1.0, _SHARES, endpoint=False)
    alpha = 0.5 + 0.5 * np.sin(np.pi / (1.0 - ratio) * (share - 0.5 * (1.0 + ratio)))
    velocity = max(ramp, 0.0) / (stiffness * (1.0 - alpha * share))
    level = coulomb + (static - coulomb) * np.exp(-((velocity / model["lugre_friction.stribeck_velocity"]) ** 2))
    return float(static - np.max(share * level))


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
