"""The parts of an identification together: later parts use the values of earlier ones."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import Breakaway
from pneumo_ros.identify.flow import LIMITS, coefficients, fit_flow
from pneumo_ros.identify.friction_map import fit_map
from pneumo_ros.identify.motion import MotionFit, fit_motion
from pneumo_ros.identify.presliding import fit_presliding
from pneumo_ros.identify.static_map import MapFit, MapPoint
from pneumo_ros.identify.steady import Window
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

STATIC, COULOMB = "lugre_friction.static_friction", "lugre_friction.coulomb_friction"
STRIBECK, DRAG = "lugre_friction.stribeck_velocity", "quadratic_drag.coefficient"
ADDED = (  # friction parameters of optional effects that steady motion shows
    "viscous_friction.coefficient",
    "stribeck_shape.exponent",
    "asymmetric_friction.ratio",
    "asymmetric_viscous_friction.coefficient_extension",
    "asymmetric_viscous_friction.coefficient_retraction",
)
_UNKNOWN = 0.3  # relative prior deviation of friction parameters that the map leaves open


@dataclass(frozen=True)
class Found:
    """One parameter: value, 95 % interval (None where not determined), unit, and a sentence on its source."""

    value: float
    interval: tuple[float, float] | None
    unit: str
    before: float
    remark: str


class Assembly:
    """Collects values, intervals, remarks and correlations step by step."""

    def __init__(self, model: Model, wanted: Sequence[str], fit: MapFit) -> None:
        self.start, self.model, self.wanted = model, model, tuple(wanted)
        self.found, self.unknown = dict[str, Found](), dict[str, str]()
        self.correlations: dict[tuple[str, str], float] = {}
        self.map_fit = fit
        for name in wanted:
            self._from_map(name)
        self._correlate(fit.names, fit.correlation)

    def _from_map(self, name: str) -> None:
        fit = self.map_fit
        if name in fit.intervals:
            source = "steady motion"
            self.note(name, fit.values[name], fit.intervals[name], "force at breakaway" if name == STATIC else source)
        else:
            self.leave(name, fit.undetermined[name])

    def note(self, name: str, value: float, interval: tuple[float, float] | None, remark: str) -> None:
        """Take over one value."""
        self.model = self.model.with_parameters({name: value})
        self.found[name] = Found(value, interval, self.model.specification(name).unit, self.start[name], remark)
        self.unknown.pop(name, None)

    def leave(self, name: str, why: str) -> None:
        """Keep the old value of a parameter."""
        self.note(name, self.start[name], None, f"not determined: {why}")
        self.unknown[name] = why

    def _correlate(self, names: Sequence[str], matrix: NDArray[np.float64]) -> None:
        """Keep the correlations among determined parameters; they replace those of earlier fits."""
        good = [name for name in names if self.found.get(name) and self.found[name].interval]
        self.correlations = {pair: r for pair, r in self.correlations.items() if not set(pair) & set(good)}
        place = {name: names.index(name) for name in good}
        pairs = [(a, b) for k, a in enumerate(good) for b in good[k + 1 :]]
        self.correlations |= {(a, b): float(matrix[place[a], place[b]]) for a, b in pairs}

    def flow(self, windows: Sequence[Window]) -> None:
        """Valve parameters from the mass balance of steady stretches."""
        fit = fit_flow(self.model, windows)
        for name in (*coefficients(self.model), *LIMITS):
            if name in fit.values:
                self.note(name, fit.values[name], fit.intervals[name], "steady flow, q = p A v / (R T)")
            elif name in fit.undetermined:
                self.leave(name, fit.undetermined[name])
        self._correlate(fit.names, fit.correlation)

    def presliding(self, runs: Sequence[Run], breakaways: Sequence[Breakaway]) -> None:
        """Bristle stiffness and damping."""
        fit = fit_presliding(self.model, runs, breakaways)
        for name, value in fit.values.items():
            if name not in self.start.exact:
                self.note(name, value, fit.intervals.get(name), fit.remarks[name])

    def motion(
        self, runs: Sequence[Run], breakaways: Sequence[Breakaway], progress: Callable[[float, str], None]
    ) -> None:
        """Static friction, Stribeck velocity and undetermined map parameters from the motion after breakaways."""
        sure = [name for name, found in self.found.items() if found.interval]
        fit = fit_motion(self.model, runs, breakaways, self._open(), sure, progress)
        if fit is None:
            return
        for name, estimate in fit.estimates.items():
            self.note(name, estimate.value, (estimate.low, estimate.high), f"motion after {fit.breakaways} breakaways")
        self._correlate_motion(fit)

    def _correlate_motion(self, fit: MotionFit) -> None:
        keep = [k for k, name in enumerate(fit.names) if name in fit.estimates]
        self._correlate([fit.names[k] for k in keep], fit.correlation[np.ix_(keep, keep)])

    def _open(self) -> dict[str, float]:
        """Prior deviations of the parameters that the motion has to determine."""
        free = {}
        for name in self.wanted:
            size = max(abs(self.model[name]), abs(self.model.specification(name).default))
            interval = self.found[name].interval
            if name == STATIC and interval:
                free[name] = max(interval[1] - interval[0], 0.2)
            elif name in (STATIC, STRIBECK):
                free[name] = 0.5 * size
            elif not interval:
                free[name] = _UNKNOWN * size
        return free

    def map_again(self, points: Sequence[MapPoint], breakaways: Sequence[Breakaway]) -> None:
        """Fit the map again if it did not determine the Stribeck velocity and the motion did."""
        if STRIBECK not in self.map_fit.undetermined or STRIBECK in self.unknown:
            return
        by_motion = {name for name in self.wanted if self.found[name].remark.startswith("motion")}
        self.map_fit = fit_map(self.model, points, breakaways, self.wanted)
        for name in self.wanted:
            if name not in by_motion:
                self._from_map(name)
        keep = [k for k, name in enumerate(self.map_fit.names) if name not in by_motion]
        self._correlate([self.map_fit.names[k] for k in keep], self.map_fit.correlation[np.ix_(keep, keep)])
