"""The static friction map, force over velocity, and the fit of its parameters (the paper's Fig. 4)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumo_ros.errors import DataError
from pneumo_ros.identify.breakaway import Breakaway
from pneumo_ros.identify.confidence import central_jacobian, half_widths
from pneumo_ros.identify.steady import Window
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

STARTS = 8
F_SCALE = 3.0  # deviations: beyond, residuals count linearly
SLOW = 3.0  # Stribeck velocities: slower points say something of the Stribeck curve
LOOSE = 0.5  # relative half width of an interval beyond which a parameter counts as not determined
_STRIBECK = ("lugre_friction.stribeck_velocity", "stribeck_shape.exponent")


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
    """Fitted parameters by dotted name, 95 % intervals, correlation, residuals [N] of the points, and what is unknown.

    undetermined: parameter -> a plain sentence; such a parameter keeps the value it had, and has no interval.
    """

    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    correlation: Array
    names: tuple[str, ...]  # order of the correlation
    residuals: Array
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
        far = 10.0 * model["lugre_friction.static_friction"] / model["lugre_friction.bristle_stiffness"]
        states[:, z] = np.sign(velocity) * far  # beyond z_max, where z' = v - rate z with the full rate
        rate = (velocity - model.derivatives(states, np.zeros(len(states)))[:, z]) / states[:, z]
        states[:, z] = velocity / rate
    return model.outputs(states)["friction"]


def fit_map(model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: Sequence[str]) -> MapFit:
    """Fit `free` parameters (dotted names) to the map and the breakaway forces by robust least squares.

    Bounds are those of the parameters; the best of 8 starts is taken. Intervals are Student's at 95 %, from the
    Jacobian with the residuals' own spread. What the data cannot determine is left as it was, with a sentence. Raises
    DataError when there are fewer points than parameters to fit.
    """
    unknown = _unseen(model, points, breakaways, free)
    fitted = tuple(name for name in free if name not in unknown)
    if len(points) < len(fitted) + 1:
        raise DataError(
            f"{len(points)} steady stretches for {len(fitted)} friction parameters; record more constant-voltage runs: "
            "pneumo experiment constant-voltage"
        )
    problem = _MapProblem(model, points, breakaways, fitted)
    return problem.result(min(problem.solutions(), key=lambda solution: float(solution.cost)).x, unknown)


def _unseen(
    model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: Sequence[str]
) -> dict[str, str]:
    """Parameters the data do not touch at all, each with a sentence."""
    speeds = np.array([abs(p.velocity) for p in points])
    slow = model["lugre_friction.stribeck_velocity"] * SLOW
    few = int(np.sum(speeds < slow))
    unknown: dict[str, str] = {}
    if few < 3:
        slowest = f"the slowest is at {1e3 * speeds.min():.0f} mm/s" if len(speeds) else "there is none"
        text = f"needs steady points below {1e3 * slow:.0f} mm/s; {slowest}"
        unknown |= {name: text for name in free if name in _STRIBECK}
        if not breakaways:
            unknown["lugre_friction.static_friction"] = f"{text}, and no breakaway from rest was recorded"
    if len(speeds) and speeds.max() < 2.0 * speeds.min():
        text = f"needs speeds over a factor of 2; these span {1e3 * speeds.min():.0f} to {1e3 * speeds.max():.0f} mm/s"
        unknown |= {name: text for name in free if name.endswith(".coefficient")}
    return {name: text for name, text in unknown.items() if name in free}


class _MapProblem:
    """Scaled least squares over the fitted parameters."""

    def __init__(
        self, model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: tuple[str, ...]
    ) -> None:
        self.model, self.free = model, free
        self.velocity = np.array([p.velocity for p in points])
        self.force = np.array([p.force for p in points])
        # noise in velocity acts through the slope of the curve (effective variance, Orear 1982)
        step = 1e-3 * np.abs(self.velocity)
        slope = (sliding_friction(model, self.velocity + step) - sliding_friction(model, self.velocity - step)) / (
            2 * step
        )
        self.spread = np.hypot([p.spread for p in points], slope * [p.velocity_spread for p in points])
        self.groups = [*(p.run for p in points), *(b.run for b in breakaways)]
        self.level = np.array([b.force for b in breakaways])
        self.level_spread = np.array([b.spread for b in breakaways])
        specs = [model.specification(name) for name in free]
        self.scale = np.array([max(abs(model[n]), abs(s.default)) or 1.0 for n, s in zip(free, specs, strict=True)])
        self.low, self.high = (
            np.array([s.low for s in specs]) / self.scale,
            np.array([s.high for s in specs]) / self.scale,
        )

    def _variant(self, x: Array) -> Model:
        return self.model.with_parameters({n: float(v) for n, v in zip(self.free, x * self.scale, strict=True)})

    def residuals(self, x: Array) -> Array:
        """Whitened: the map first, then the breakaways."""
        model = self._variant(x)
        sliding = (sliding_friction(model, self.velocity) - self.force) / self.spread
        return np.concatenate([sliding, (model["lugre_friction.static_friction"] - self.level) / self.level_spread])

    def solutions(self) -> list[Any]:
        """Local solutions from several starts, always the same ones."""
        rng = np.random.default_rng(0)
        first = np.array([self.model[name] for name in self.free]) / self.scale
        spread = np.exp(rng.normal(0.0, 0.4, (STARTS, len(first))))
        spread[0] = 1.0
        starts = np.clip(first * spread, self.low + 1e-9, self.high - 1e-9)
        bounds = (self.low, self.high)
        return [
            least_squares(self.residuals, s, bounds=bounds, loss="soft_l1", f_scale=F_SCALE, x_scale="jac", max_nfev=50)
            for s in starts
        ]

    def result(self, x: Array, unknown: dict[str, str]) -> MapFit:
        """Intervals, correlation and residuals at the solution x."""
        residual = self.residuals(x)
        weight = 1.0 / (1.0 + (residual / F_SCALE) ** 2)
        half, correlation = half_widths(residual, central_jacobian(self.residuals, x), weight, self.groups)
        half *= self.scale
        values = dict(zip(self.free, (x * self.scale).tolist(), strict=True))
        intervals = {}
        for name, h in zip(self.free, half, strict=True):
            if h > LOOSE * abs(values[name]):
                unknown[name] = f"the interval is as wide as +- {h:.3g} about {values[name]:.3g}"
                values[name] = self.model[name]
            else:
                intervals[name] = (values[name] - float(h), values[name] + float(h))
        map_residuals = residual[: len(self.velocity)] * self.spread
        return MapFit(values, intervals, correlation, self.free, map_residuals, unknown)
