"""The state at given instants of a recording: estimated with the model from the measurements around them.

A prediction started from smoothed signals alone is off by many times the noise even with the true parameters: the
bristle's deflection, which no sensor shows, decides when a stuck piston breaks away. Here a short simulation is fitted
to the measurements before and after each instant, with its initial state free (Gauss-Newton with Levenberg-Marquardt
damping); where the measurements do not determine the state, the balance of forces does.
"""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.segments import Segments, cut_at
from pneumo_ros.shooting.slopes import start_slopes

Array = NDArray[np.float64]
Index = NDArray[np.int64]

BEFORE, AFTER = 0.3, 0.1  # s, fitted before and after each instant: the state depends mostly on the past
SHORTER = (0.15, 0.1), (0.08, 0.05), (0.04, 0.04)  # s, the same where the first is not explained
_EXPLAINED = 1.5  # mean squared error over the noise: with noise alone, 400 samples of three signals stay below it
_ITERATIONS = 20  # at most; four on average, ten and more where a breakaway lies between guess and true state
_ENOUGH, _STUCK = 1e-3, 1e5  # a start is found when a step gains less than this share, or when damping is beyond this


def start_states(model: Model, run: Run, at: Index) -> Array:
    """States (len(at), states) of `model` at the grid points `at` of a run, fitted to the measurements around them.

    Pulses of on/off valves may break the piston away many times in the time before: where noise does not explain such a
    fit, it has ended in a neighbouring minimum, and less of the past is fitted.
    """
    found, misfit = _around(model, run, at, BEFORE, AFTER)
    for before, after in SHORTER if model.composition.jumping else ():
        poor = np.flatnonzero(misfit > _EXPLAINED)
        if not len(poor):
            break
        others, theirs = _around(model, run, at[poor], before, after)
        better = theirs < misfit[poor]
        found[poor[better]], misfit[poor[better]] = others[better], theirs[better]
    return found


def _around(model: Model, run: Run, at: Index, time_before: float, time_after: float) -> tuple[Array, Array]:
    """States from a fit to some time [s] before and after each instant, and its mean squared error over the noise."""
    before = round(time_before / run.sample_time)
    samples = min(before + round(time_after / run.sample_time), len(run) - 1)
    begin = np.clip(at - before, 0, len(run) - 1 - samples)
    segments = cut_at(model, [run], [begin], samples)
    found = fit_starts(model, segments)
    trajectory = segments.simulate(model, found)
    ahead = at - begin
    moved = ahead > 0
    result: Array = found.copy()
    result[moved] = trajectory[moved, ahead[moved] - 1]
    return result, np.mean(segments.residuals(model, found)[0] ** 2, axis=1)


def fit_starts(
    model: Model, segments: Segments, begin: Array | None = None, iterations: int = _ITERATIONS, threads: int = 1,
    parameters: Array | None = None,
) -> Array:  # fmt: skip
    """Initial states (segments, states) by whitened least squares, with priors at their guesses, for each segment.

    `begin` (segments, states): start of the search, by default the guesses. parameters (segments, parameters): those of
    each segment, by default the model's own.
    """
    x = segments.seated(model) if begin is None else begin.copy()
    coarse, damping = segments.coarser(), np.full(len(x), 1e-3)
    q = np.tile(model.values, (len(x), 1)) if parameters is None else parameters
    residual = _residuals(model, segments, x, threads, q)[0]
    active = np.arange(len(x))
    for _ in range(iterations):
        some, own = coarse.pick(active), q[active]
        candidate = x[active] + _move(model, some, x[active], residual[active], damping[active], threads, own)
        tried = _residuals(model, segments.pick(active), candidate, threads, own)[0]
        cost, less = np.sum(residual[active] ** 2, axis=1), np.sum(tried**2, axis=1)
        better = less < cost
        x[active[better]], residual[active[better]] = candidate[better], tried[better]
        damping[active] *= np.where(better, 0.2, 10.0)
        active = active[np.where(better, cost - less > _ENOUGH * cost, damping[active] < _STUCK)]
        if not len(active):
            break
    return segments.completed(model, x, q)


def _move(
    model: Model, segments: Segments, x: Array, residual: Array, damping: Array, threads: int, parameters: Array
) -> Array:
    """Levenberg-Marquardt step (segments, states) from states x with residuals (segments, residuals)."""
    _, slopes = start_slopes(
        model, segments, x, lambda part, rows, states: _residuals(model, part, states, threads, parameters[rows])
    )
    jacobian = np.swapaxes(slopes, 1, 2)
    normal = np.swapaxes(jacobian, 1, 2) @ jacobian
    gradient = np.einsum("wrs,wr->ws", jacobian, residual)
    size = np.sqrt(np.einsum("wss->ws", normal))  # at least 1, by the prior
    damped = normal / (size[:, :, None] * size[:, None, :]) + damping[:, None, None] * np.eye(x.shape[1])
    return np.asarray(-np.linalg.solve(damped, (gradient / size)[:, :, None])[:, :, 0] / size * segments.scale)


def _residuals(model: Model, segments: Segments, states: Array, threads: int, parameters: Array) -> Array:
    """(copies, windows, samples * signals + states): whitened errors and distances from the guess.

    states (copies * windows, states), parameters (windows, parameters).
    """
    q = np.tile(parameters, (len(states) // max(len(segments), 1), 1))
    errors = segments.residuals(model, states, q, threads)
    return np.concatenate([errors, segments.from_guess(model, states, q)], axis=2)
