"""Positions in another unit than metres, or radians: those outside the stroke of the machine."""

import math
from dataclasses import replace

import numpy as np

from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError, PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.records.corrections import ANGLE_UNITS, LENGTH_UNITS
from pneumo_ros.runs.run import Run, check_position
from pneumo_ros.units import LINE, shown

_INSIDE = 1.05  # of half the stroke: an end stop yields a little
_MOVES = 0.02  # of half the stroke: a unit in which the piston moves less is not named


def check_length(model: Model, run: Run) -> None:
    """Raises DataError for positions outside the stroke of `model`, with the unit in which its equations fit best."""
    reach = 0.5 * model["piston.stroke"]
    if np.abs(run.position).max() <= _INSIDE * reach:
        return
    sizes = {}
    for unit, factor in (LENGTH_UNITS if model.coordinate == LINE else ANGLE_UNITS).items():
        position = factor * run.position
        if np.abs(position).max() <= _INSIDE * reach and np.abs(position).max() > _MOVES * reach:
            sizes[unit] = _residual(model, replace(run, position=position, further=_scaled(run, factor)))
    if len(sizes) < 2:  # the general sentence names mm, or none
        check_position(model, run)
    unit = min(sizes, key=lambda name: sizes[name])
    farthest = int(np.argmax(np.abs(run.position)))
    raise DataError(
        f"{run.name}: the position is {run.position[farthest]:.4g} {shown('m')} at "
        f"{run.time[farthest]:.3f} s, outside the stroke "
        f"of {model.name}, {-reach:g} to {reach:g} {shown('m')}; if it is in {unit}, type --read-as {unit}: of "
        f"{' and '.join(sizes)} it fits the equations best; positions are in {shown('m')} from mid stroke"
    )


def _scaled(run: Run, factor: float) -> dict[str, np.ndarray]:
    return {name: factor * held if name == "imposed_velocity" else held for name, held in run.further.items()}


def _residual(model: Model, run: Run) -> float:
    """Geometric mean of the residuals; infinite where nothing can be judged."""
    try:
        found = [one.rms for one in equation_residuals(model, run).values() if math.isfinite(one.rms) and one.rms > 0.0]
    except PneumoError:
        return math.inf
    return math.exp(sum(map(math.log, found)) / len(found)) if found else math.inf
