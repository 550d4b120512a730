"""Residual of an equation against variables it may depend on: binned means with band and coverage, over all runs."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.along import Along
from pneumo_ros.compare.binned import Bins, bin_means, clusters, edges, explained
from pneumo_ros.compare.shares import window_share
from pneumo_ros.equations.weak import Residual

Array = NDArray[np.float64]

BINS = 40  # a detent of short pitch shows in 40 and hides in 8
_FEWEST = 8  # windows in a bin: as they overlap, equal to two independent windows
UNITS = {
    "velocity": "m/s", "position": "m", "voltage": "V", "force": "N", "pressure_a": "Pa", "pressure_b": "Pa",
    "pressure_difference": "Pa", "time": "s",
}  # fmt: skip


@dataclass(frozen=True)
class Dependence:
    """Residual over bins of one variable: means with 95 % intervals, noise, seconds of coverage."""

    variable: str
    bins: Bins
    noise: Array  # (bins,) rms of the noise of single windows, in the residual's unit
    seconds: Array  # (bins,)
    constant_share: float  # of the squared residual: explained by one constant
    explained_share: float  # explained by this variable beyond the constant, predicted for windows left out

    def as_dict(self) -> dict[str, Any]:
        """For JSON: columns over the bins, in SI units."""
        return {
            "constant_share": self.constant_share,
            "explained_share": self.explained_share,
            "from": self.bins.low, "to": self.bins.high, "at": self.bins.centre, "mean": self.bins.mean,
            "low": self.bins.below, "high": self.bins.above, "noise": self.noise, "seconds": self.seconds,
        }  # fmt: skip


def dependences(residuals: Sequence[Residual], motions: Sequence[Along], width: float) -> dict[str, Dependence]:
    """One equation's residuals of several runs, over windows of `width` [s], against every variable in all runs."""
    parts = [_variables(residual, motion, width) for residual, motion in zip(residuals, motions, strict=True)]
    names = [name for name in UNITS if all(name in part for part in parts)]
    value, noise, time = (
        np.concatenate([getattr(r, which) for r in residuals]) for which in ("value", "noise", "time")
    )
    if len(value) < 2 * _FEWEST:
        return {}
    run = np.repeat(np.arange(len(residuals)), [len(r.value) for r in residuals])
    cluster, hop = clusters(time, run), _hop(residuals)
    return {
        name: _against(name, np.concatenate([part[name] for part in parts]), value, noise, cluster, hop)
        for name in names
    }


def _against(
    name: str, variable: Array, value: Array, noise: Array, cluster: NDArray[np.int64], hop: float
) -> Dependence:
    at = edges(variable, BINS)
    fitting = min(max(len(value) // (2 * _FEWEST), 1), BINS)  # 40 bins of a short recording hold too few windows each
    bins = bin_means(variable, value, cluster, edges(variable, fitting), _FEWEST)
    level = np.array([np.sqrt(np.mean(np.square(noise[inside]))) for inside in bins.members])
    constant, beyond = explained(variable, value, cluster, at)
    return Dependence(name, bins, level, bins.count * hop, constant, beyond)


def _hop(residuals: Sequence[Residual]) -> float:
    """Time from one window to the next [s]."""
    steps = [np.min(np.diff(r.time)) for r in residuals if len(r.time) > 1]
    return float(np.median(steps)) if steps else 0.0


def _variables(residual: Residual, motion: Along, width: float) -> dict[str, Array]:
    """Means of each variable over the residual's windows."""
    run = motion.run
    signals = {"velocity": motion.velocity, "position": run.position}
    if not (run.force_driven and run.imposed):  # there the force is what is predicted, and all follows from it
        signals["force" if run.force_driven else "voltage"] = motion.input
    if run.force_driven and not run.by_pressures:
        pressed = {"pressure_a": run.pressure_a, "pressure_b": run.pressure_b}
        signals |= {name: pressure for name, pressure in pressed.items() if pressure is not None}
    if not run.force_driven:
        signals |= {chamber.field: run.signals[chamber.signal] for chamber in motion.chambers}
    if not run.force_driven and len(motion.chambers) > 1:
        signals["pressure_difference"] = np.subtract(*run.pressures(motion.chambers).T)
    means = {name: window_share(s, run.sample_time, residual.time, width) for name, s in signals.items()}
    return means | {"time": residual.time}
