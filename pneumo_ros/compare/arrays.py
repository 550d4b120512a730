"""The results of `compare`, sample by sample, as named arrays: for your own plots and analyses."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison, RunComparison


def comparison_arrays(comparison: "Comparison") -> dict[str, NDArray[Any]]:
    """Arrays of every run k, counted from 1, under `k/...` in SI units; (n,) on the run's grid unless stated otherwise.

    name () text; time; velocity, smoothed; input, V or N; measured/SIGNAL; error/SIGNAL of the windowed prediction and
    free/SIGNAL of the free run, model minus measured, NaN where there is none; regime/NAME, whether a sample is in it;
    residual/EQUATION/time, value and noise (m,).
    """
    return {f"{k}/{key}": array for k, run in enumerate(comparison.runs, 1) for key, array in _run(run).items()}


def _run(run: "RunComparison") -> dict[str, NDArray[Any]]:
    grid = run.motion.run
    found: dict[str, NDArray[Any]] = {
        "name": np.array(run.name), "time": grid.time, "velocity": run.motion.velocity, "input": run.motion.input,
    }  # fmt: skip
    every = grid.signals | grid.judged
    found |= {f"measured/{name}": np.where(grid.measured, s, np.nan) for name, s in every.items()}
    found |= {f"error/{name}": error for name, error in run.predicted.items()}
    found |= {f"free/{name}": error for name, error in run.free_errors.items()}
    found |= {f"regime/{name}": mask for name, mask in run.masks.items()}
    for name, residual in run.residuals.items():
        found |= {f"residual/{name}/{key}": getattr(residual, key) for key in ("time", "value", "noise")}
    return found
