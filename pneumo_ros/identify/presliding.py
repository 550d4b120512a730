"""Bristle stiffness and damping: from presliding motion where the sensor shows it, else by the rules of Eqs. 15-16."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import Breakaway, holding_force
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.units import shown

Array = NDArray[np.float64]

STIFFNESS, DAMPING = "lugre_friction.bristle_stiffness", "lugre_friction.bristle_damping"
_ELASTIC = 0.75  # of the breakaway force: below, the contact is purely elastic
_BLOCK = 0.05  # s
_DEFLECTION = 50e-6  # m, the upper end of the range of 1 to 50 micrometres in Eq. 15


@dataclass(frozen=True)
class Presliding:
    """Values by dotted name, 95 % intervals where measured, and one sentence each on their source."""

    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    remarks: dict[str, str]


def fit_presliding(model: Model, runs: Sequence[Run], breakaways: Sequence[Breakaway]) -> Presliding:
    """Bristle stiffness from the deflection before each breakaway (F = sigma_0 z), else Eq. 15; damping by Eq. 16."""
    slopes = [found for run in runs for found in _compliances(model, run, [b for b in breakaways if b.run == run.name])]
    values, intervals, remarks = {}, {}, {}
    stiffness = _pooled(slopes)
    if stiffness:
        values[STIFFNESS], intervals[STIFFNESS] = stiffness
        remarks[STIFFNESS] = f"presliding before {len(slopes)} breakaway{'s' * (len(slopes) > 1)}"
    else:
        values[STIFFNESS] = model["lugre_friction.coulomb_friction"] / _DEFLECTION
        remarks[STIFFNESS] = (
            "not measured, as no presliding exceeds the noise; F_c / 50 um, the softest bristle that Eq. 15 allows"
        )
    bound = passive_damping(model)
    values[DAMPING] = min(model[DAMPING], bound)
    kept = "kept as it was" if values[DAMPING] == model[DAMPING] else "lowered to the passive limit"
    remarks[DAMPING] = (
        f"not measured, {kept}; passive up to {bound:.0f} {shown('N s/m')} (Eq. 16 corrected for quadratic drag)"
    )
    return Presliding(values, intervals, remarks)


def passive_damping(model: Model) -> float:
    """Largest passive bristle damping [N s/m]: 2 sqrt(C_d F_c) F_s / (F_s - F_c), infinite without a Stribeck rise."""
    static, coulomb = model["lugre_friction.static_friction"], model["lugre_friction.coulomb_friction"]
    drag = model.parameters.get("quadratic_drag.coefficient", 0.0)
    rise = static - coulomb
    return float(2.0 * np.sqrt(drag * coulomb) * static / rise) if rise > 0.0 and drag > 0.0 else float("inf")


def _compliances(model: Model, run: Run, breakaways: Sequence[Breakaway]) -> list[tuple[float, float]]:
    """Compliance [m/N] and its deviation before each breakaway of a run that shows it."""
    if not breakaways:
        return []
    force, noise = holding_force(model, run), run.noise["position_m"]
    found = (_compliance(run, force, noise, breakaway) for breakaway in breakaways)
    return [one for one in found if one]


def _compliance(run: Run, force: Array, noise: float, breakaway: Breakaway) -> tuple[float, float] | None:
    """Compliance [m/N] and its deviation while the force rose from rest; None if it rose too little."""
    begin = breakaway.index - round(breakaway.rest / run.sample_time)
    rows = np.arange(max(begin, 0), breakaway.index)
    rows = rows[np.abs(force[rows]) < _ELASTIC * breakaway.force]
    block = max(round(_BLOCK / run.sample_time), 1)
    count = len(rows) // block
    if count < 6:
        return None
    mean_force, mean_y = (a[rows[: count * block]].reshape(-1, block).mean(axis=1) for a in (force, run.position))
    if np.ptp(mean_force) < 0.3 * breakaway.force:
        return None
    design = np.stack([mean_force, np.ones(count)], axis=1)
    solution, *_ = np.linalg.lstsq(design, mean_y, rcond=None)
    scatter = max(float(np.std(mean_y - design @ solution)), noise / np.sqrt(block))
    return float(solution[0]), scatter / float(np.std(mean_force) * np.sqrt(count))


def _pooled(slopes: Sequence[tuple[float, float]]) -> tuple[float, tuple[float, float]] | None:
    """Weighted mean stiffness [N/m] and interval; None unless the compliance is five deviations above zero."""
    if not slopes:
        return None
    value, deviation = np.array(slopes).T
    weight = 1.0 / deviation**2
    mean = float(np.sum(weight * value) / np.sum(weight))
    spread = float(np.sqrt(1.0 / np.sum(weight)))
    if len(slopes) > 1:
        spread *= max(1.0, float(np.sqrt(np.sum(weight * (value - mean) ** 2) / (len(slopes) - 1))))
    if mean < 5.0 * spread:
        return None
    return 1.0 / mean, (1.0 / (mean + 2.0 * spread), 1.0 / (mean - 2.0 * spread))
