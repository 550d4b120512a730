"""The friction map of any motion: measured friction force over velocity while the piston slides, and the model's.

Newton's law along the measured signals, F = drive - load - M a, in weak form over windows of 100 ms with the test
function (1 - tau^2)^6: the position is not differentiated, and force and acceleration are weighted alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.along import Along
from pneumo_ros.diagnose.binned import bin_means, clusters
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

_HALF = 0.05  # s
_EDGE = 1e-3  # m from the end of the stroke, where the stop's force is not friction
_BINS = 24  # per direction, evenly in log velocity
_FEWEST = 4  # windows in a bin
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


def friction_map(model: Model, courses: Sequence[Along]) -> dict[str, FrictionPoints]:
    """Both directions of the map from all runs; a direction in which nothing slid long enough is left out."""
    parts = [_windows(model, course) for course in courses]
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
    at = np.geomspace(velocity.min(), np.nextafter(velocity.max(), np.inf), _BINS + 1)
    at[0] = 0.0
    bins = bin_means(velocity, force - claimed, cluster, at, _FEWEST)  # what friction changes within a bin cancels
    model = np.array([claimed[inside].mean() for inside in bins.members])
    force, low, high = (model + column for column in (bins.mean, bins.below, bins.above))
    return FrictionPoints(bins.centre, force, low, high, model, bins.count * _HALF)


def _windows(model: Model, course: Along) -> tuple[Array, Array, Array, Array]:
    """Time, velocity, measured and claimed friction of the windows in which the piston slides one way."""
    run, dt = course.run, course.run.sample_time
    half = min(max(round(_HALF / dt), 4), (len(run) - 1) // 2)
    weight, second = _test_function(half, dt)

    def mean(signal: Array, by: Array = weight) -> Array:
        every = np.lib.stride_tricks.sliding_window_view(signal, len(by))
        return np.asarray(every[::half] @ by)

    force = mean(course.seen["drive"] - course.seen["force"])
    measured = force - model["piston.mass"] * mean(run.position - run.position.mean(), second)
    away = (np.abs(course.velocity) > course.rest_below) & run.measured & (np.abs(run.position) < course.reach - _EDGE)
    one_way = np.abs(mean(np.where(away, np.sign(course.velocity), 0.0), np.full(len(weight), 1.0 / len(weight))))
    sliding = one_way > 1.0 - 1e-9
    return (
        mean(run.time)[sliding],
        mean(course.velocity)[sliding],
        measured[sliding],
        mean(course.seen["friction"])[sliding],
    )


def _test_function(half: int, dt: float) -> tuple[Array, Array]:
    """Weights (2 half + 1,) whose sum over samples is a mean, and those of its second derivative [1/s2]."""
    tau = np.linspace(-1.0, 1.0, 2 * half + 1)
    c = 1.0 - tau**2
    weight = c**6
    second = (-12.0 * c**5 + 120.0 * tau**2 * c**4) / (half * dt) ** 2
    return weight / weight.sum(), second / weight.sum()
