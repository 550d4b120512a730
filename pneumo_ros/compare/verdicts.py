"""Verdicts: whether the sensor noise alone explains an error."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.weak import Residual

Array = NDArray[np.float64]

# times the noise: uncertainty of a noise estimated from the same recording, and scatter of a mean square over
# overlapping windows, which falls with the root of their number
_EXPLAINED, _SCATTER = 1.1, 3.0
SIGNAL_EXPLAINED = 1.3  # the same for predictions, whose start is an estimate too
FARTHEST = 1e6  # noise deviations: larger errors are limited to this


@dataclass(frozen=True)
class SignalError:
    """Error of one signal over all windows of a run, in the signal's unit."""

    rms: float
    max: float
    fit_percent: float  # 100 (1 - |error| / |measured - its mean|)
    noise: float
    typical: float = math.nan  # geometric mean over windows of their rms over noise, insensitive to one bad window

    @property
    def ratio(self) -> float:
        """Error over noise floor: 1 where only noise is left."""
        return self.rms / self.noise

    @property
    def explained_by_noise(self) -> bool:
        """Whether noise alone explains the error."""
        return bool(self.ratio <= SIGNAL_EXPLAINED)


@dataclass(frozen=True)
class EquationVerdict:
    """One equation over all runs; where nothing could be judged, numbers are NaN and the verdict is None."""

    residual_rms: float
    unit: str
    ratio_to_noise: float
    explained_by_noise: bool | None


def judge_equations(residuals: Sequence[dict[str, Residual]]) -> dict[str, EquationVerdict]:
    """Pool the residuals of several runs, equation by equation."""
    return {name: _judge([found[name] for found in residuals]) for name in (residuals[0] if residuals else {})}


def _judge(parts: list[Residual]) -> EquationVerdict:
    value, noise = (np.concatenate(found) for found in ([p.value for p in parts], [p.noise for p in parts]))
    if not len(value):
        return EquationVerdict(math.nan, parts[0].unit, math.nan, None)
    ratio = root_mean_square(value / noise)
    explained = bool(ratio <= _EXPLAINED + _SCATTER / math.sqrt(len(value)))
    return EquationVerdict(root_mean_square(value), parts[0].unit, ratio, explained)


def judge_signal(error: Array, measured: Array, noise: float) -> SignalError:
    """Judge prediction errors (windows, samples) with the measured values at the same samples, both in one unit."""
    spread = float(np.std(measured))
    rms = root_mean_square(error)
    fit = 100.0 * (1.0 - rms / spread) if spread > 0.0 else math.nan
    typical = float(np.exp(np.mean(np.log(window_sizes(error, noise)))))
    return SignalError(rms, float(np.nanmax(np.abs(error))), fit, noise, typical)


def window_sizes(error: Array, noise: float) -> Array:
    """Rms over noise (windows,) of prediction errors (windows, samples), both in one unit; never zero."""
    size = np.sqrt(np.nanmean(np.minimum(np.abs(error / noise), FARTHEST) ** 2, axis=1))
    return np.asarray(np.maximum(size, 1e-3))


def root_mean_square(values: Array) -> float:
    """Root mean square of the values that are not NaN; NaN when there are none."""
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.sqrt(np.nanmean(np.square(values)))) if np.size(values) else math.nan
