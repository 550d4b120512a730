"""The state at given instants of a recording: estimated with the model from the measurements around them.

A prediction started from smoothed signals alone is off by many times the noise even with the true parameters: what
decides when a stuck piston breaks away is the bristle's deflection, which no sensor shows. Here a short simulation is
fitted to the measurements before and after each instant, with its initial state free (Gauss-Newton with
Levenberg-Marquardt damping); where the measurements say nothing, the balance of forces does.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.run import Run
from pneumo_ros.identify.segments import PROBE, Segments, cut_at
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]

BEFORE, AFTER = 0.3, 0.1  # s, fitted before and after each instant: most of what the state follows from is its past
_ITERATIONS = 6


def start_states(model: Model, run: Run, at: Index) -> Array:
    """States (len(at), states) of `model` at the grid points `at` of a run, fitted to the measurements around them."""
    before = round(BEFORE / run.sample_time)
    samples = min(before + round(AFTER / run.sample_time), len(run) - 1)
    begin = np.clip(at - before, 0, len(run) - 1 - samples)
    segments = cut_at(model, [run], [begin], samples)
    found = fit_starts(model, segments)
    trajectory = segments.simulate(model, found)
    ahead = at - begin
    moved = ahead > 0
    result: Array = found.copy()
    result[moved] = trajectory[moved, ahead[moved] - 1]
    return result


def fit_starts(model: Model, segments: Segments) -> Array:
    """Initial states (segments, states) of least whitened squares about their guesses, each segment by itself."""
    windows, n = segments.guess.shape
    x: Array = segments.guess.copy()
    damping = np.full(windows, 1e-3)
    residual = _residuals(model, segments, x)[0]
    for _ in range(_ITERATIONS):
        shifted = _residuals(model, segments, segments.probes(x))
        jacobian = np.moveaxis((shifted - residual) / PROBE, 0, 2)  # (windows, residuals, states)
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian
        gradient = np.einsum("wrs,wr->ws", jacobian, residual)
        diagonal = np.einsum("wss->ws", normal)
        damped = normal + damping[:, None, None] * np.eye(n) * diagonal[:, None, :]
        candidate = x - np.linalg.solve(damped, gradient[:, :, None])[:, :, 0] * segments.scale
        tried = _residuals(model, segments, candidate)[0]
        better = np.sum(tried**2, axis=1) < np.sum(residual**2, axis=1)
        x[better], residual[better] = candidate[better], tried[better]
        damping = np.where(better, damping * 0.2, damping * 10.0)
    return x


def _residuals(model: Model, segments: Segments, states: Array) -> Array:
    """(copies, windows, samples * signals + states): whitened errors and distances from the guess."""
    return np.concatenate([segments.residuals(model, states), segments.from_guess(states)], axis=2)
