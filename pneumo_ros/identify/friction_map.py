"""The fit of friction parameters to the static map and to breakaways."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.errors import DataError
from pneumo_ros.identify.confidence import central_jacobian, half_widths
from pneumo_ros.identify.static_map import MapFit, MapPoint, sliding_friction
from pneumo_ros.plant import Model
from pneumo_ros.shooting.physical import physical
from pneumo_ros.units import shown

Array = NDArray[np.float64]

STARTS = 8
F_SCALE = 3.0  # deviations: beyond, residuals count linearly
SLOW = 3.0  # Stribeck velocities: slower points show the Stribeck curve
LOOSE = 0.2  # relative half width of an interval beyond which a parameter counts as not determined
SPAN = 1.5  # fastest over slowest point, below which Coulomb and speed-dependent friction are not distinguished
_WEAK = 0.5  # relative prior deviation of a parameter that the data do not determine
_STRIBECK = ("lugre_friction.stribeck_velocity", "stribeck_shape.exponent")


def fit_map(model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: Sequence[str]) -> MapFit:
    """Fit `free` parameters (dotted names) to the map and the breakaway forces by robust least squares.

    Bounds are those of the parameters; the best of 8 starts is taken. Static friction below Coulomb's is no solution:
    it is then Coulomb's, as in `shooting.physical`. Intervals are Student's at 95 %, from the Jacobian with the
    residuals' own spread. An undetermined parameter keeps its value, with a sentence; its uncertainty widens the
    intervals of the others. Raises DataError when there are fewer points than parameters to fit.
    """
    unknown = _unseen(model, points, breakaways, free)
    seen = tuple(name for name in free if name not in unknown)
    if len(points) < len(seen) + 1:
        raise DataError(
            f"{len(points)} steady stretches are too few for {len(seen)} friction parameters; record more "
            + (
                "runs at constant velocity, or fit friction to any motion: pneumo compare BAG --refit --out MODEL"
                if model.force_driven
                else "constant-voltage runs: pneumo experiment constant-voltage"
            )
        )
    problem = _MapProblem(model, points, breakaways, seen, tuple(unknown))
    best = min(problem.solutions(), key=lambda solution: float(solution.cost)).x
    if not problem.is_physical(best):
        problem.tied = True
        best = min(problem.solutions(), key=lambda solution: float(solution.cost)).x
    return problem.result(best, unknown)


def _unseen(
    model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: Sequence[str]
) -> dict[str, str]:
    """Parameters that the data cannot determine at all, each with a sentence."""
    speeds = np.array([abs(p.velocity) for p in points])
    slow = model["lugre_friction.stribeck_velocity"] * SLOW
    few = int(np.sum(speeds < slow))
    unknown: dict[str, str] = {}
    if few < 3:
        slowest = f"the slowest is at {1e3 * speeds.min():.0f} {shown('mm/s')}" if len(speeds) else "there is none"
        text = f"needs steady points below {1e3 * slow:.0f} {shown('mm/s')}, or several breakaways; {slowest}"
        unknown |= {name: text for name in free if name in _STRIBECK}
        if not breakaways:
            unknown["lugre_friction.static_friction"] = f"{text}, and no breakaway from rest was recorded"
    if len(speeds) and speeds.max() < SPAN * speeds.min():
        span = f"{1e3 * speeds.min():.0f} to {1e3 * speeds.max():.0f} {shown('mm/s')}"
        text = f"needs speeds over a factor of {SPAN:g}; the speeds here span {span}"
        unknown |= {name: text for name in free if name.endswith((".coefficient", ".difference"))}
    return {name: text for name, text in unknown.items() if name in free}


class _MapProblem:
    """Scaled least squares over `free`; `held` keep their values, known to `_WEAK` of their size."""

    def __init__(
        self, model: Model, points: Sequence[MapPoint], breakaways: Sequence[Breakaway], free: tuple[str, ...],
        held: tuple[str, ...],
    ) -> None:  # fmt: skip
        self.model, self.free, self.names = model, free, (*free, *held)
        self.tied = False  # whether static friction is raised to Coulomb's where it is lower
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
        specs = [model.specification(name) for name in self.names]
        self.scale = np.array(
            [max(abs(model[n]), abs(s.default)) or 1.0 for n, s in zip(self.names, specs, strict=True)]
        )
        self.first = np.array([model[name] for name in self.names]) / self.scale
        self.low, self.high = (
            np.array(side) / self.scale for side in ([s.low for s in specs], [s.high for s in specs])
        )

    def _full(self, x: Array) -> Array:
        """Scaled values of all names, those held included."""
        return np.concatenate([x, self.first[len(x) :]])

    def _values(self, x: Array) -> Array:
        """Values of all names, in their units."""
        values = self._full(x) * self.scale
        return physical(self.model, self.names, values) if self.tied else values

    def is_physical(self, x: Array) -> bool:
        """Whether static friction is not below Coulomb's."""
        values = self._full(x) * self.scale
        return bool(np.allclose(physical(self.model, self.names, values), values, rtol=1e-6))

    def residuals(self, x: Array) -> Array:
        """Whitened residuals for scaled values of the free or of all parameters: the map, then the breakaways."""
        model = self.model.with_parameters(dict(zip(self.names, self._values(x).tolist(), strict=True)))
        sliding = (sliding_friction(model, self.velocity) - self.force) / self.spread
        breaking = (model["lugre_friction.static_friction"] - self.level) / self.level_spread
        return np.concatenate([sliding, breaking])

    def solutions(self) -> list[Any]:
        """Local solutions from several starts, the same in every call."""
        rng = np.random.default_rng(0)
        first, low, high = (every[: len(self.free)] for every in (self.first, self.low, self.high))
        spread = np.exp(rng.normal(0.0, 0.4, (STARTS, len(first))))
        around = np.where(first == 0.0, 1.0, first)  # for an added effect: its usual size
        starts = np.clip(np.vstack([first, around * spread[1:]]), low + 1e-9, high - 1e-9)
        return [
            least_squares(
                self.residuals, s, bounds=(low, high), loss="soft_l1", f_scale=F_SCALE, x_scale="jac", max_nfev=50
            )
            for s in starts
        ]

    def result(self, x: Array, unknown: dict[str, str]) -> MapFit:
        """Intervals, correlation and residuals at the solution x."""
        residual = self.residuals(x)
        half, correlation = self._confidence(x, residual)
        x = np.where(x - self.low[: len(x)] < 1e-9, self.low[: len(x)], x)  # exactly on its bound
        x = self._values(x)[: len(x)] / self.scale[: len(x)]
        values = {name: self.model[name] for name in self.names}
        intervals = {}
        for name, value, h in zip(self.free, (x * self.scale[: len(x)]).tolist(), half.tolist(), strict=True):
            least, most = self.model.specification(name).low, self.model.specification(name).high
            if h > LOOSE * max(abs(value), self._least(name)):
                unknown[name] = _loose(value, h, self.model.specification(name).unit)
            else:
                values[name], intervals[name] = value, (max(value - h, least), min(value + h, most))
        if self.tied:
            kept = physical(self.model, self.names, np.array([values[name] for name in self.names]))
            values = dict(zip(self.names, kept.tolist(), strict=True))
        whitened = residual[: len(self.velocity)]
        ratio = float(np.sqrt(np.mean(whitened**2)))
        return MapFit(values, intervals, correlation, self.free, whitened * self.spread, self.spread, ratio, unknown)

    def _least(self, name: str) -> float:
        """Size below which an added effect's parameter counts as small, as it may be zero."""
        return (
            0.0 if name.startswith(("lugre_friction.", "quadratic_drag.")) else self.model.specification(name).default
        )

    def _confidence(self, x: Array, residual: Array) -> tuple[Array, Array]:
        """Half widths (free,) and correlation, including errors of the held parameters (Schmidt 1966)."""
        full = self._full(x)
        room = 2e-5 * np.maximum(np.abs(full), 1e-3)  # for the differences at a bound
        jacobian = central_jacobian(self.residuals, np.clip(full, self.low + room, self.high - room))
        weight = 1.0 / (1.0 + (residual / F_SCALE) ** 2)
        mine, others = jacobian[:, : len(x)], jacobian[:, len(x) :]
        half, correlation = half_widths(residual, mine, weight, self.groups)
        carried = np.linalg.pinv(np.sqrt(weight)[:, None] * mine) @ (np.sqrt(weight)[:, None] * others)
        half = np.hypot(half, 1.96 * _WEAK * np.sqrt(np.sum(carried**2, axis=1)))
        return half * self.scale[: len(x)], correlation


def _loose(value: float, half: float, unit: str) -> str:
    if not np.isfinite(half):
        return "these runs show only its sum with others"
    return f"these runs leave it anywhere between {value - half:.3g} and {value + half:.3g} {unit}"
