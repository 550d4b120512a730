"""The static friction map: points of force over velocity, and the curve of a model (the paper's Fig. 4)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.steady import Window
from pneumo_ros.plant import Model

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MapPoint:
    """One point of the map: velocity [m/s] and friction force [N], the spread of both by noise, and the run."""

    velocity: float
    force: float
    velocity_spread: float
    spread: float
    run: str


@dataclass(frozen=True)
class MapFit:
    """Fitted parameters by dotted name, 95 % intervals, correlation, and residuals [N] of the points.

    undetermined: parameter -> a sentence; an undetermined parameter keeps its old value, and has no interval.
    """

    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    correlation: Array
    names: tuple[str, ...]  # order of the correlation
    residuals: Array
    spread: Array  # [N] of each residual by noise of force and velocity
    ratio: float  # root mean square of the residuals over their spread by noise; 1 when noise explains them
    undetermined: dict[str, str]


def map_points(windows: Sequence[Window]) -> list[MapPoint]:
    """The used windows as points, an empty list when there is none."""
    return [MapPoint(w.velocity, w.friction, w.velocity_noise, w.friction_noise, w.run) for w in windows if w.used]


def sliding_friction(model: Model, velocity: Array) -> Array:
    """Friction force [N] (n,) of sliding at constant `velocity` [m/s] (n,): bristles at the deflection where z' = 0."""
    states = np.tile(model.state(), (len(velocity), 1))
    v = model.states.index("v")
    states[:, v] = velocity
    if "z" in model.states:
        z = model.states.index("z")
        highest = max(model["lugre_friction.static_friction"], model["lugre_friction.coulomb_friction"])
        far = 10.0 * highest / model["lugre_friction.bristle_stiffness"]
        states[:, z] = np.sign(velocity) * far  # beyond z_max, where z' = v - rate z with the full rate
        rate = (velocity - model.derivatives(states, None)[:, z]) / states[:, z]
        states[:, z] = velocity / rate
    return model.outputs(states)["friction"]
