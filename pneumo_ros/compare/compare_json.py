"""The JSON of `pneumo compare`: the contract's keys, and keys for where the errors occur."""

import math
from typing import TYPE_CHECKING, Any

from pneumo_ros.compare.dependence import UNITS
from pneumo_ros.compare.regimes import MEANING
from pneumo_ros.compare.shares import Share
from pneumo_ros.units import unit_along

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison, RunComparison

SCHEMA_VERSION = 1


def comparison_dict(comparison: "Comparison") -> dict[str, Any]:
    """Numbers, texts and arrays by the keys programs rely on; keys may be added, never removed."""
    total = {name: _total([run.located[name] for run in comparison.runs]) for name in comparison.regimes}
    occurring = {name for run in comparison.runs for name in run.masks}
    return {
        "schema_version": SCHEMA_VERSION,
        "model": comparison.model,
        "coordinate": comparison.coordinate,
        "horizon_s": comparison.horizon,
        "runs": [_run(run, total) for run in comparison.runs],
        "equations": {name: _equation(comparison, name) for name in comparison.equations},
        "signals": {name: _signal(comparison, name) for name in comparison.regimes if name not in comparison.equations},
        "regimes": {name: meaning for name, meaning in MEANING.items() if name in occurring},
        "friction_map": {
            "velocity_unit": unit_along("m/s", comparison.coordinate),
            "force_unit": unit_along("N", comparison.coordinate),
            "directions": {name: points.as_dict() for name, points in comparison.friction.items()},
        },
    }


def _run(run: "RunComparison", total: dict[str, float]) -> dict[str, Any]:
    return {
        "name": run.name,
        "samples": run.samples,
        "duration_s": run.duration,
        "sample_time_s": run.motion.run.sample_time,
        "windows": run.windows,
        "error": {
            name: {
                "rms": e.rms, "max": e.max, "fit_percent": e.fit_percent, "noise": e.noise,
                "ratio_to_noise": e.ratio, "typical_ratio_to_noise": e.typical,
                "explained_by_noise": e.explained_by_noise, **_located(run, name, total),
            }
            for name, e in run.error.items()
        },
        "free_run": {name: {"rms": rms} for name, rms in run.free.items()},
        "equations": {name: vars(v) | _located(run, name, total) for name, v in run.equations.items()},
        "regimes": {name: float(mask.mean()) for name, mask in run.masks.items()},
    }  # fmt: skip


def _located(run: "RunComparison", name: str, total: dict[str, float]) -> dict[str, Any]:
    located = run.located[name]
    return {
        "share": _total([located]) / total[name] if total[name] > 0.0 else 0.0,
        "regimes": _shares(located.regimes),
        "worst": [interval.as_dict() for interval in located.worst],
    }


def _equation(comparison: "Comparison", name: str) -> dict[str, Any]:
    return {
        **vars(comparison.equations[name]),
        "regimes": _shares(comparison.regimes[name]),
        "against": {
            key: found.as_dict() | {"unit": unit_along(UNITS[key], comparison.coordinate)}
            for key, found in comparison.dependences[name].items()
        },
    }


def _signal(comparison: "Comparison", name: str) -> dict[str, Any]:
    counts = [len(run.located[name].errors.value) for run in comparison.runs]
    errors = [run.error[name] for run in comparison.runs]
    rms, ratio = (_pooled(counts, found) for found in ([e.rms for e in errors], [e.ratio for e in errors]))
    return {
        "rms": rms,
        "ratio_to_noise": ratio,
        "explained_by_noise": all(run.error[name].explained_by_noise for run in comparison.runs),
        "regimes": _shares(comparison.regimes[name]),
    }


def _shares(shares: dict[str, Share]) -> dict[str, Any]:
    return {name: share.as_dict() for name, share in shares.items()}


def _total(located: list[Any]) -> float:
    """Sum of squares in noise deviations."""
    return sum(float(((one.errors.value / one.errors.noise) ** 2).sum()) for one in located)


def _pooled(counts: list[int], values: list[float]) -> float:
    """Root of the mean square over runs of different lengths."""
    total = sum(n * value * value for n, value in zip(counts, values, strict=True))
    return math.sqrt(total / max(sum(counts), 1))
