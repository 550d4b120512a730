"""How well a model predicts recordings over a second, in one number for each signal.

It is the geometric mean over windows. A single breakaway predicted slightly too early, by 0.1 % of static friction,
costs thousands of noise deviations in its window, which is no measure of the model.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.verdicts import window_sizes
from pneumo_ros.diagnose.measures import NOISE_SHARE
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.segments import side_by_side
from pneumo_ros.shooting.windows import HORIZON, predict

Array = NDArray[np.float64]

BETTER, WORSE = 0.95, 1.1  # of a signal's prediction error
THREADS = 2  # runs predicted side by side


def window_logs(model: Model, runs: Sequence[Run], horizon: float = HORIZON) -> dict[str, Array]:
    """By signal, the logarithm of the error over noise (windows,) in every window of `horizon` [s]."""
    logs: dict[str, list[Array]] = {}
    with ThreadPoolExecutor(THREADS) as pool:
        predictions = list(pool.map(lambda run: predict(model, run, horizon), runs))
    for run, prediction in zip(runs, predictions, strict=True):
        noise = run.noise
        for name, error in prediction.errors.items():
            logs.setdefault(name, []).append(np.log(window_sizes(error, noise[name])))
    return {name: np.concatenate(parts) for name, parts in logs.items()}


def recordings(runs: Sequence[Run], horizon: float = HORIZON) -> NDArray[np.int64]:
    """The number (windows,) of the run of each window of `window_logs`."""
    counts = [len(side_by_side(run, round(min(len(run), horizon / run.sample_time)))) for run in runs]
    return np.repeat(np.arange(len(runs)), counts)


def usual_errors(logs: Mapping[str, Array]) -> dict[str, float]:
    """By signal, the usual error over noise: the geometric mean of the windows' rms."""
    return {name: float(np.exp(np.mean(values))) for name, values in logs.items()}


def windowed(model: Model, runs: Sequence[Run], horizon: float = HORIZON) -> dict[str, float]:
    """By signal, the usual error over noise in windows of `horizon` [s]."""
    return usual_errors(window_logs(model, runs, horizon))


def pays(before: Mapping[str, float], after: Mapping[str, float]) -> bool:
    """Whether predictions of some signal got better by a twentieth and none worse by a tenth."""
    return any(after[n] <= BETTER * before[n] for n in before) and harmless(before, after)


def removed(before: Mapping[str, float], after: Mapping[str, float]) -> float:
    """Share that is removed of the mean square error of predictions beyond noise, the mean over signals."""
    first, second = (typical_error(errors) ** 2 - 1.0 for errors in (before, after))
    return (first - second) / max(first, NOISE_SHARE)


def harmless(before: Mapping[str, float], after: Mapping[str, float]) -> bool:
    """Whether predictions of no signal got worse by a tenth."""
    return all(after[n] <= WORSE * before[n] for n in before)


def no_worse(before: Mapping[str, float], after: Mapping[str, float]) -> bool:
    """Whether predictions of no signal got worse at all."""
    return all(after[n] <= before[n] for n in before)


def typical_error(errors: Mapping[str, float]) -> float:
    """Root mean square over signals of the errors by `windowed`: 1 where only noise is left."""
    return float(np.sqrt(np.mean(np.square(list(errors.values())))))
