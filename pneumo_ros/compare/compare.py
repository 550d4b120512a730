"""Model against measurement: prediction errors per run and signal, residuals per equation, and where they occur."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.along import Along, along
from pneumo_ros.compare.dependence import Dependence, dependences
from pneumo_ros.compare.locate import Located, equation_errors, locate, on_grid, signal_errors, window_of
from pneumo_ros.compare.regimes import Mask, regimes
from pneumo_ros.compare.shares import Share, by_regime, pooled
from pneumo_ros.compare.sliding import FrictionPoints, friction_map
from pneumo_ros.compare.verdicts import EquationVerdict, SignalError, judge_equations, judge_signal, root_mean_square
from pneumo_ros.equations.weak import Residual, equation_residuals
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.windows import HORIZON, fitting_horizon, free_run, predict
from pneumo_ros.units import LINE

__all__ = ["Comparison", "EquationVerdict", "RunComparison", "SignalError", "compare", "compare_run", "judge_equations"]

Array = NDArray[np.float64]

THREADS = 2  # runs compared side by side


@dataclass(frozen=True)
class RunComparison:
    """Comparison with one run: by signal name, windowed errors and the rms [unit] of one free simulation.

    located: by signal and equation name, the parts of the error by regime and its worst intervals. predicted and
    free_errors: model minus measurement on the run's grid (n,), NaN where there is none, in single precision.
    """

    name: str
    samples: int
    duration: float
    windows: int
    error: dict[str, SignalError]
    free: dict[str, float]
    residuals: dict[str, Residual] = field(repr=False)
    motion: Along = field(repr=False)
    masks: dict[str, Mask] = field(repr=False)
    located: dict[str, Located] = field(repr=False)
    predicted: dict[str, NDArray[np.float32]] = field(repr=False)
    free_errors: dict[str, NDArray[np.float32]] = field(repr=False)

    @cached_property
    def equations(self) -> dict[str, EquationVerdict]:
        """The equations in this run alone."""
        return judge_equations([self.residuals])


@dataclass(frozen=True)
class Comparison:
    """A model against any number of runs.

    regimes: by signal and equation name, the parts of the error over all runs; dependences: by equation and variable.
    """

    model: str
    horizon: float
    runs: tuple[RunComparison, ...]
    equations: dict[str, EquationVerdict]
    regimes: dict[str, dict[str, Share]]
    dependences: dict[str, dict[str, Dependence]]
    friction: dict[str, FrictionPoints]
    coordinate: str = LINE  # of the machine: in whose units the numbers are

    def as_dict(self) -> dict[str, Any]:
        """The JSON of `pneumo compare`; errors of a simulation that diverged are not finite."""
        from pneumo_ros.compare.compare_json import comparison_dict

        return comparison_dict(self)


def compare(
    model: Model,
    runs: Sequence[Run],
    horizon: float | None = None,
    progress: Callable[[float, str], None] | None = None,
) -> Comparison:
    """Compare `model` with every run over windows of `horizon` [s] and free, and judge each equation.

    By default, windows are of 1 s, or less where a run is shorter.

    `progress` is called with the share done and the run's name. Raises UsageError when a run holds no whole window.
    """
    results = []
    horizon = (fitting_horizon(runs) if runs else HORIZON) if horizon is None else horizon
    with ThreadPoolExecutor(THREADS) as pool:
        made = pool.map(lambda run: compare_run(model, run, horizon), runs)
        for i, run in enumerate(runs):
            if progress:
                progress(i / len(runs), run.name)
            results.append(next(made))
    names = results[0].located if results else {}
    motions = [r.motion for r in results]
    return Comparison(
        model=model.name,
        horizon=horizon,
        runs=tuple(results),
        equations=judge_equations([r.residuals for r in results]),
        regimes={name: by_regime(pooled([r.located[name].errors for r in results])) for name in names},
        dependences={
            name: dependences([r.residuals[name] for r in results], motions, window_of(name))
            for name in (results[0].residuals if results else {})
        },
        friction=friction_map(model, motions) if results and not model.imposed else {},
        coordinate=model.coordinate,
    )


def compare_run(model: Model, run: Run, horizon: float) -> RunComparison:
    """Windowed and free errors and the residuals of one run, and where they occur."""
    noise = run.noise
    windows, free = predict(model, run, horizon), free_run(model, run)
    rows = windows.start[:, None] + np.arange(1, windows.states.shape[1] + 1)
    predicted, motion = on_grid(windows, len(run)), along(model, run)
    masks, residuals = regimes(motion), equation_residuals(model, run)
    errors = signal_errors(run, predicted, noise, masks) | equation_errors(residuals, run, masks)
    return RunComparison(
        name=run.name,
        samples=len(run),
        duration=float(run.time[-1]),
        windows=len(windows.start),
        error={name: judge_signal(e, run.judged[name][rows], noise[name]) for name, e in windows.errors.items()},
        free={name: root_mean_square(error) for name, error in free.errors.items()},
        residuals=residuals,
        motion=motion,
        masks=masks,
        located={name: locate(found) for name, found in errors.items()},
        predicted=_single(predicted),
        free_errors=_single(on_grid(free, len(run))),
    )


def _single(errors: dict[str, Array]) -> dict[str, NDArray[np.float32]]:
    with np.errstate(over="ignore"):
        return {name: error.astype(np.float32) for name, error in errors.items()}
