"""Where the errors of one run occur: prediction errors of its signals and residuals of its equations, by regime."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.regimes import Mask
from pneumo_ros.compare.shares import Errors, Interval, Share, by_regime, window_share, worst
from pneumo_ros.equations.weak import CHAMBER_WINDOW, MOMENTUM_WINDOW, Residual
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.windows import Prediction

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Located:
    """One error of one run: its parts by regime, and its worst intervals, worst first."""

    errors: Errors = field(repr=False)
    regimes: dict[str, Share]
    worst: list[Interval]


def locate(errors: Errors) -> Located:
    """Split an error by regime and find where it is worst."""
    return Located(errors, by_regime(errors), worst(errors))


def on_grid(prediction: Prediction, samples: int) -> dict[str, Array]:
    """Errors of a prediction on the run's grid (n,), by signal; NaN where nothing was predicted or measured."""
    rows = prediction.start[:, None] + np.arange(1, prediction.states.shape[1] + 1)
    result = {}
    for name, error in prediction.errors.items():
        whole = np.full(samples, np.nan)
        whole[rows] = error
        result[name] = whole
    return result


def signal_errors(
    run: Run, errors: Mapping[str, Array], noise: Mapping[str, float], masks: Mapping[str, Mask]
) -> dict[str, Errors]:
    """Prediction errors (n,) by signal, with the regimes of their samples."""
    weights = {name: mask.astype(float) for name, mask in masks.items()}
    return {name: Errors.of(run.time, e, noise[name], run.sample_time, weights) for name, e in errors.items()}


def equation_errors(residuals: Mapping[str, Residual], run: Run, masks: Mapping[str, Mask]) -> dict[str, Errors]:
    """Residuals by equation, with the share of each window that lies in each regime."""
    result = {}
    for name, residual in residuals.items():
        weights = {
            regime: window_share(mask.astype(float), run.sample_time, residual.time, window_of(name))
            for regime, mask in masks.items()
        }
        steps = np.diff(residual.time)
        hop = float(steps.min()) if len(steps) else 0.25 * window_of(name)
        result[name] = Errors.of(residual.time, residual.value, residual.noise, hop, weights)
    return result


def window_of(equation: str) -> float:
    """Length of the windows [s] in which an equation is judged."""
    return MOMENTUM_WINDOW if equation == "momentum" else CHAMBER_WINDOW
