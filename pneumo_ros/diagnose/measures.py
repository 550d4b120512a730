"""The misfit of each equation with and without a candidate, and how certain the difference is."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.hypothesis import FLOOR, robust_scale

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

MOST_BLOCK = 3.0  # largest log likelihood of one block of time, or event: it takes several to decide
ACTS = 0.25  # noise deviations: an effect acts where it changes a residual by more
FORCES = ("momentum", "breakaway")  # equations in newtons
FEWEST_WINDOWS = 30  # windows where an effect acts: a family with fewer is not judged there; windows overlap
FEWEST_OF = {"breakaway": 8}  # the same for families without overlap
MATERIAL_FORCE = 0.007  # of the drive force: a smaller misfit is a texture of friction that no model has
NOISE_SHARE = 0.1  # of the mean square of noise: a smaller misfit beyond noise is none
NOISE = {"breakaway": 0.56}  # mean square of noise alone, where it is not 1: the stated spread is larger


def equation_of(name: str) -> str:
    """The equation of a family: momentum, chamber_a, chamber_b or breakaway."""
    return name.partition(" ")[0]


def force(evidence: Evidence, before: Array, after: Array) -> float:
    """Root mean square of the change of the momentum equation [N]; 0 without that equation."""
    own = np.isin(evidence.family, [k for k, name in enumerate(evidence.names) if equation_of(name) == "momentum"])
    change = (before - after)[own] * evidence.noise[own]
    return float(np.sqrt(np.mean(change**2))) if len(change) else 0.0


def unexplained_force(evidence: Evidence, residual: Array) -> float:
    """Deviation [N] beyond noise of what `residual` leaves of the momentum, in its widest windows; 0 without them."""
    widest = next((k for k, name in enumerate(evidence.names) if equation_of(name) == "momentum"), None)
    own = evidence.family == (-1 if widest is None else widest)
    beyond = (residual[own] ** 2 - 1.0) * evidence.noise[own] ** 2
    return float(np.sqrt(max(np.mean(beyond), 0.0))) if own.any() else 0.0


def mean_squares(evidence: Evidence, residual: Array, rows: Rows | None = None) -> dict[str, float]:
    """Robust mean square of the residual over noise by equation, the mean over its families; at least the noise's.

    Over all windows, or over those in `rows` (residuals,): families with fewer than thirty windows, or eight
    breakaways, are left out.
    """
    found: dict[str, list[float]] = {}
    for k, name in enumerate(evidence.names):
        own = evidence.family == k if rows is None else rows & (evidence.family == k)
        if own.sum() >= (1 if rows is None else FEWEST_OF.get(name, FEWEST_WINDOWS)):
            scale = max(robust_scale(np.abs(residual[own])), FLOOR.get(name, 1.0))
            found.setdefault(equation_of(name), []).append(scale**2)
    return {name: max(float(np.mean(values)), NOISE.get(name, 1.0)) for name, values in found.items()}


def gains(evidence: Evidence, before: Array, after: Array, rows: Rows | None = None) -> dict[str, float]:
    """By equation, the reduction of the mean square residual from `before` to `after`, as a share of `before`."""
    first, second = mean_squares(evidence, before, rows), mean_squares(evidence, after, rows)
    return {name: 1.0 - second[name] / first[name] for name in first}


def explained(
    evidence: Evidence, before: Array, after: Array, rows: Rows | None = None, *, textured: bool = False
) -> float:
    """Largest reduction, over the equations, from `before` to `after`, as a share of the mean square beyond noise.

    0 where it rises in all. `textured`: and beyond a texture of forces; what is less is nothing to remove. In `rows`
    (residuals,); over all breakaways if `rows` holds too few of them, as when each changes a little.
    """
    whole = [{n: v for n, v in mean_squares(evidence, r).items() if n in FEWEST_OF} for r in (before, after)]
    first, second = (w | mean_squares(evidence, r, rows) for w, r in zip(whole, (before, after), strict=True))
    rough = texture(evidence) if textured else {}
    shares = [0.0]
    for name, value in first.items():
        noise = NOISE.get(name, 1.0)
        beyond, left = (max(x - noise - rough.get(name, 0.0), 0.0) for x in (value, second[name]))
        shares.append((beyond - left) / max(beyond, NOISE_SHARE * noise))
    return max(shares)


def texture(evidence: Evidence) -> dict[str, float]:
    """By equation of forces, the mean square over noise of a texture of friction, as large as does not matter."""
    found: dict[str, list[float]] = {}
    for k, name in enumerate(evidence.names):
        if equation_of(name) not in FORCES:
            continue
        noise = evidence.noise[evidence.family == k]
        if noise.size:  # recordings without a breakaway have no row of its force
            found.setdefault(equation_of(name), []).append(
                float(np.median((MATERIAL_FORCE * evidence.drive / noise) ** 2))
            )
    return {name: float(np.mean(values)) for name, values in found.items()}


def acting(before: Array, after: Array) -> Rows:
    """Where an effect acts (residuals,): the leak of a closed valve must not drown in the residuals of the open one."""
    return np.asarray(np.abs(before - after) > ACTS)


def together(saved: Array) -> tuple[float, float]:
    """Sum of the log likelihoods that parts of the data gain, each limited, and that sum over its scatter."""
    parts = np.clip(saved, -MOST_BLOCK, MOST_BLOCK)
    spread = float(np.sqrt(np.sum(parts**2)))
    return float(parts.sum()), float(parts.sum() / spread) if spread > 0.0 else 0.0
