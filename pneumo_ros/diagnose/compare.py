"""Model against measurement: prediction errors per run and signal, and residuals per equation."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.noise import run_noise
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.weak import Residual, equation_residuals
from pneumo_ros.identify.windows import free_run, predict
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

SCHEMA_VERSION = 1
_EXPLAINED = 1.2  # times the noise: what estimating the noise from the same recording leaves uncertain, generously
# N: friction along a measured motion is known no better than this, because its velocity is an estimate; measured on
# recordings of the true machine, 0.05 to 0.06 N at 10 um position noise
MOMENTUM_FLOOR = 0.06


@dataclass(frozen=True)
class SignalError:
    """Error of one signal over all windows of a run, in the signal's unit."""

    rms: float
    max: float
    fit_percent: float  # 100 (1 - |error| / |measured - its mean|)
    noise: float

    @property
    def ratio(self) -> float:
        """Error over noise floor: 1 where only noise is left."""
        return self.rms / self.noise


@dataclass(frozen=True)
class RunComparison:
    """What compare says of one run: by signal name, windowed errors and the rms [unit] of one free simulation."""

    name: str
    samples: int
    duration: float
    windows: int
    error: dict[str, SignalError]
    free: dict[str, float]
    residuals: dict[str, Residual] = field(repr=False)


@dataclass(frozen=True)
class EquationVerdict:
    """One equation over all runs."""

    residual_rms: float
    unit: str
    ratio_to_noise: float
    explained_by_noise: bool


@dataclass(frozen=True)
class Comparison:
    """A model against any number of runs."""

    model: str
    horizon: float
    runs: tuple[RunComparison, ...]
    equations: dict[str, EquationVerdict]

    def as_dict(self) -> dict[str, Any]:
        """The JSON of `pneumo compare`; where a simulation left the finite numbers, so do its errors."""
        return {
            "schema_version": SCHEMA_VERSION,
            "model": self.model,
            "horizon_s": self.horizon,
            "runs": [_run_dict(run) for run in self.runs],
            "equations": {
                name: {
                    "explained_by_noise": verdict.explained_by_noise,
                    "residual_rms": verdict.residual_rms,
                    "unit": verdict.unit,
                    "ratio_to_noise": verdict.ratio_to_noise,
                }
                for name, verdict in self.equations.items()
            },
        }


def compare(
    model: Model, runs: Sequence[Run], horizon: float = 1.0, progress: Callable[[float, str], None] | None = None
) -> Comparison:
    """Compare `model` with every run over windows of `horizon` [s] and free, and judge each equation.

    `progress` is called with the share done and the run at hand. Raises UsageError when a run holds no whole window.
    """
    results = []
    for i, run in enumerate(runs):
        if progress:
            progress(i / len(runs), run.name)
        results.append(compare_run(model, run, horizon))
    return Comparison(model.name, horizon, tuple(results), judge_equations([r.residuals for r in results]))


def compare_run(model: Model, run: Run, horizon: float) -> RunComparison:
    """Windowed and free errors and the residuals of one run."""
    noise = run_noise(run)
    windows = predict(model, run, horizon)
    rows = windows.start[:, None] + np.arange(1, windows.states.shape[1] + 1)
    errors = {
        name: _signal_error(error, run.signals[name][rows], noise[name]) for name, error in windows.errors.items()
    }
    free = {name: _rms(error) for name, error in free_run(model, run).errors.items()}
    residuals = equation_residuals(model, run)
    return RunComparison(run.name, len(run), float(run.time[-1]), len(windows.start), errors, free, residuals)


def judge_equations(residuals: Sequence[dict[str, Residual]]) -> dict[str, EquationVerdict]:
    """Pool the residuals of several runs, equation by equation."""
    return {name: _judge(name, [found[name] for found in residuals]) for name in (residuals[0] if residuals else {})}


def _judge(name: str, parts: list[Residual]) -> EquationVerdict:
    value, noise = (np.concatenate([getattr(part, which) for part in parts]) for which in ("value", "noise"))
    floor = MOMENTUM_FLOOR if name == "momentum" else 0.0
    ratio = _rms(value / np.hypot(noise, floor)) if len(value) else math.nan
    return EquationVerdict(_rms(value), parts[0].unit, ratio, bool(ratio <= _EXPLAINED))


def _signal_error(error: Array, measured: Array, noise: float) -> SignalError:
    spread = float(np.std(measured))
    rms = _rms(error)
    fit = 100.0 * (1.0 - rms / spread) if spread > 0.0 else math.nan
    return SignalError(rms, float(np.nanmax(np.abs(error))), fit, noise)


def _rms(values: Array) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.sqrt(np.nanmean(np.square(values)))) if np.size(values) else math.nan


def _run_dict(run: RunComparison) -> dict[str, Any]:
    return {
        "name": run.name,
        "samples": run.samples,
        "duration_s": run.duration,
        "windows": run.windows,
        "error": {
            name: {
                "rms": e.rms, "max": e.max, "fit_percent": e.fit_percent, "noise": e.noise,
            }
            for name, e in run.error.items()
        },
        "free_run": {name: {"rms": rms} for name, rms in run.free.items()},
    }  # fmt: skip
