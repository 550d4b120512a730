"""A fit of every candidate effect by simulation, ranked by BIC: what a textbook of identification would do.

Each effect of the catalogue that the model lacks is added by itself, and the model's free parameters and those of the
effect are fitted by multiple shooting to the same segments. BIC = n ln(RSS / n) + k ln n takes the whitened errors of
all n samples as independent. Starts of segments are left out of the k parameters, as they are common to all candidates.
The effect of lowest BIC is named if it is lower than that of the model without an effect.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from pneumo_ros.diagnose.coordinates import Coordinate, starts
from pneumo_ros.diagnose.hypothesis import missing
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Model
from pneumo_ros.shooting.refit import Refit, default_free, refit_segments
from pneumo_ros.shooting.segments import Segments, cut, side_by_side

Effect = tuple[Coordinate, ...]

SEGMENT = 0.2  # s: over 0.5 s a wrong effect mistimes a breakaway, and its fit takes four times as long
BEGIN = 0.2  # usual sizes: an effect starts small, from where a fit finds either sign


def named(model: Model, runs: Sequence[Any], segments: int) -> list[str]:
    """The effect of lowest BIC, if that is lower than without effect."""
    found = {"": fitted_bic(model, (), runs, segments)}
    for name, effect in missing(model).items():
        found[name] = fitted_bic(with_effect(model, name, effect), effect, runs, segments)
    best = min(found, key=lambda name: found[name])
    return [best] if best else []


def fitted_bic(model: Model, effect: Effect, runs: Sequence[Any], count: int) -> float:
    """BIC of a model that holds the effect, or none; infinite if its fit finds no finite prediction."""
    segments = drawn(model, runs, count)
    try:
        found = refit_segments(model, segments, default_free(model), wide(effect), threads=1)
    except NumericalError:
        return float("inf")
    return bic(found, segments)


def drawn(model: Model, runs: Sequence[Any], count: int) -> Segments:
    """Segments side by side, `count` of them spread evenly over all runs."""
    samples = max(round(SEGMENT / runs[0].sample_time), 2)
    every = sum(len(side_by_side(run, samples)) for run in runs)
    rows = np.unique(np.linspace(0, every - 1, min(count, every)).round().astype(np.int64))
    return cut(model, runs, SEGMENT, rows)


def with_effect(model: Model, name: str, effect: Effect) -> Model:
    """The model with a small size of one effect."""
    begin = {c.name: _small(c, float(u)) for c, u in zip(effect, starts(effect)[0], strict=True)}
    return model.with_effects([*model.effects, name], begin)


def _small(c: Coordinate, u: float) -> float:
    """The start of a parameter: a shape's usual value, a fifth of a usual size."""
    return c.grown(c.value(u), BEGIN) if c.is_size else c.value(u)


def wide(effect: Effect) -> dict[str, float]:
    """Prior deviations of an effect's parameters, so wide that they only keep a fit from running away."""
    return {c.name: abs(c.typical if c.logarithmic else c.scale) * c.prior for c in effect}


def bic(found: Refit, segments: Segments) -> float:
    """Bayesian information criterion of a fit (Schwarz 1978)."""
    errors = segments.residuals(found.model, found.starts)[0]
    n = int(np.sum(segments.weight > 0.0))
    return float(n * np.log(np.sum(errors**2) / n) + len(found.estimates) * np.log(n))
