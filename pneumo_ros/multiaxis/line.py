"""The line that several axes share, fitted to its measured pressure.

p = p_0 - d with tau d' = R q - d, as in `supply.py`. The flow q is what the models' valves let pass at the measured
pressures, so it does not depend on the fit. R and tau are fitted as logarithms, p_0 beside them for each recording.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.multiaxis.drawing import MEASURED
from pneumo_ros.multiaxis.supply import Timed, drawn_together, drop_of
from pneumo_ros.plant.axes_section import SUPPLY
from pneumo_ros.runs.run import PARTS

Array = NDArray[np.float64]
NAMES = ("resistance_supply", "time_constant")
PIECES = 8  # of each recording, for the intervals: each is longer than the time constant of a usual line
MOST = 60  # rounds of the fit
DETERMINED = 0.5  # standard deviation of a logarithm from which a parameter counts as not determined


@dataclass(frozen=True)
class Line:
    """Parameters of the shared line and the standard deviations of their logarithms; what the sensor shows besides.

    std: infinite where the recordings say nothing. levels: pressure of the full supply in each recording [Pa].
    """

    values: Mapping[str, float]
    std: Mapping[str, float]
    levels: tuple[float, ...]
    residual: float  # Pa rms

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Parameters that the recordings do not determine."""
        return tuple(name for name in NAMES if self.std[name] > DETERMINED)


@dataclass(frozen=True)
class _Drawn:
    """One recording: flow (n - 1,) [kg/s] and mean supply pressure (n - 1,) [Pa] of its intervals, of `step` [s]."""

    flow: Array
    pressure: Array
    step: float

    def residual(self, logarithms: Array) -> Array:
        """Measured pressure less that of the line (n - 1,) [Pa], about its mean: p_0 is free."""
        drop = drop_of(self.flow, self.step, dict(zip(NAMES, np.exp(logarithms), strict=True)))
        return np.asarray(self.pressure + 0.5 * (drop[1:] + drop[:-1]))


def measured(axes: Mapping[str, Timed]) -> bool:
    """Whether every axis of a recording holds the supply's pressure as a sensor saw it."""
    return bool(axes) and all(MEASURED in one.run.further and MEASURED not in one.run.computed for one in axes.values())


def fit_line(recordings: Sequence[Mapping[str, Timed]], begin: Mapping[str, float]) -> Line:
    """The line from recordings whose supply pressure was measured; the fit begins at the line `begin`."""
    from scipy.optimize import least_squares  # slow to import, and seldom needed

    drawn = [_drawn(axes) for axes in recordings]
    known = next(iter(recordings[0].values())).model.library.find(SUPPLY).parameters
    low, high = (np.log([max(getattr(known[n], side), 1e-3) for n in NAMES]) for side in ("low", "high"))
    first = np.clip(np.log([max(begin[n], 1e-3) for n in NAMES]), low + 0.1, high - 0.1)

    def residuals(logarithms: Array) -> Array:
        found = [one.residual(logarithms) for one in drawn]
        return np.concatenate([one - one.mean() for one in found])

    found = least_squares(residuals, first, bounds=(low, high), x_scale=1.0, max_nfev=MOST)
    values = dict(zip(NAMES, (float(v) for v in np.exp(found.x)), strict=True))
    levels = tuple(float(one.residual(found.x).mean()) for one in drawn)
    std = dict(zip(NAMES, _spread(found.jac, found.fun, [len(one.flow) for one in drawn]), strict=True))
    return Line(values, std, levels, float(np.sqrt(np.mean(found.fun**2))))


def _drawn(axes: Mapping[str, Timed]) -> _Drawn:
    grid = next(iter(axes.values()))
    pressure = grid.run.further[MEASURED].reshape(len(grid.run) - 1, PARTS).mean(axis=1)
    return _Drawn(drawn_together(axes, grid), pressure, grid.run.sample_time)


def _spread(jacobian: Array, residual: Array, lengths: Sequence[int]) -> list[float]:
    """Standard deviations from pieces of the recordings: errors of the flow are alike within a piece."""
    curvature = jacobian.T @ jacobian
    if np.linalg.cond(curvature) > 1e12:
        return [float("inf")] * len(curvature)
    edges = np.cumsum([0, *lengths])
    whole = [np.arange(a, b) for a, b in pairwise(edges)]
    pieces = [piece for one in whole for piece in np.array_split(one, PIECES)]
    pulls = np.array([jacobian[piece].T @ residual[piece] for piece in pieces])
    inverse = np.linalg.inv(curvature)
    covariance = len(pieces) / (len(pieces) - len(curvature)) * inverse @ (pulls.T @ pulls) @ inverse
    return [float(value) for value in np.sqrt(np.diag(covariance))]
