"""The friction map of any motion: measured friction force over velocity while the piston slides, and the model's.

Newton's law along the measured signals, F = drive - load - M a, in weak form over windows of 100 ms with the test
function (1 - tau^2)^6: the position is not differentiated, and force and acceleration have the same weights.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.along import Along
from pneumo_ros.compare.binned import bin_means, clusters, edges
from pneumo_ros.equations.bump import Bump
from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

MAP_WINDOW = 0.1  # s
_EDGE = 1e-3  # m from the end of the stroke, where the stop's force is not friction
_BINS = 24  # per direction, over log velocity
_FEWEST = 8  # windows in a bin: as they overlap, equal to two independent windows
DIRECTIONS = {"extending": 1.0, "retracting": -1.0}


@dataclass(frozen=True)
class FrictionPoints:
    """One direction of the map; arrays (points,). Velocity [m/s] and forces [N] are positive in both directions."""

    velocity: Array
    force: Array
    low: Array  # 95 % interval of the mean force at this velocity
    high: Array
    model: Array  # the model's friction along the same windows
    seconds: Array

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return dict(vars(self))


def friction_map(model: Model, motions: Sequence[Along]) -> dict[str, FrictionPoints]:
    """Both directions of the map from all runs; a direction without long enough sliding is left out."""
    parts = [_windows(model, motion) for motion in motions]
    run = np.repeat(np.arange(len(parts)), [len(part[0]) for part in parts])
    time, velocity, force, claimed = (np.concatenate([part[i] for part in parts]) for i in range(4))
    result = {}
    for name, sign in DIRECTIONS.items():
        there = np.sign(velocity) == sign
        if there.sum() >= 2 * _FEWEST:
            groups = clusters(time[there], run[there])
            result[name] = _direction(abs(velocity[there]), sign * force[there], sign * claimed[there], groups)
    return {name: points for name, points in result.items() if len(points.velocity)}


def _direction(velocity: Array, force: Array, claimed: Array, cluster: NDArray[np.int64]) -> FrictionPoints:
    count = min(_BINS, max(len(velocity) // (2 * _FEWEST), 1))
    at = np.exp(edges(np.log(velocity), count))
    at[0], at[-1] = 0.0, np.inf
    bins = bin_means(velocity, force - claimed, cluster, at, _FEWEST)  # changes of friction within a bin cancel
    model = np.array([claimed[inside].mean() for inside in bins.members])
    force, low, high = (model + column for column in (bins.mean, bins.below, bins.above))
    return FrictionPoints(bins.centre, force, low, high, model, 0.25 * MAP_WINDOW * bins.count)


def _windows(model: Model, motion: Along) -> tuple[Array, Array, Array, Array]:
    """Time, velocity, measured and claimed friction of the windows in which the piston slides one way."""
    run = motion.run
    bump = Bump.of(MAP_WINDOW, run.sample_time)

    def mean(signal: Array) -> Array:
        return bump.apply(bump.phi, signal)

    force = mean(motion.seen["drive"] - motion.seen["force"])
    measured = force - moving_mass(model) * bump.apply(bump.second, run.position)
    away = (np.abs(motion.velocity) > motion.rest_below) & run.measured & (np.abs(run.position) < motion.reach - _EDGE)
    direction = bump.apply(np.ones(bump.width), np.where(away, np.sign(motion.velocity), 0.0))
    sliding = np.abs(direction) > bump.width - 0.5
    return (
        run.time[bump.centres(len(run))][sliding],
        mean(motion.velocity)[sliding],
        measured[sliding],
        mean(motion.seen["friction"])[sliding],
    )
