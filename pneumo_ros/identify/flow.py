"""Flow coefficients of the valve from steady motion: mass flow q = p A v / (R T) into a chamber that grows at A v."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumo_ros.identify.confidence import central_jacobian, half_widths
from pneumo_ros.identify.steady import Window
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.shooting.lead import columns, settled
from pneumo_ros.shooting.refit import to_fit

Array = NDArray[np.float64]

COEFFICIENTS = ("arctan_flow.filling_coefficient", "arctan_flow.exhaust_coefficient")
CHOKED = ("choked_flow.conductance_filling", "choked_flow.conductance_exhaust", "choked_flow.critical_ratio")
LIMITS = ("dead_zone.right_limit", "dead_zone.left_limit")
PATHS = {  # differences between paths and the shape of the law: half width of an interval beyond which one is not found
    "path_conductances.filling_difference": 0.1, "path_conductances.exhaust_difference": 0.1,
    "path_critical_ratios.exhaust_excess": 0.1, "subsonic_index.index": 0.05,
}  # fmt: skip
_RELATIVE = 1e-4  # of a flow: least error of a window's mass balance, as no motion is exactly steady
_KNOWN = 0.05  # relative prior deviation of the dead zone's limits, which runs of one voltage do not determine
_LOOSE = 0.2  # relative half width of an interval beyond which a coefficient counts as not determined
_F_SCALE = 3.0  # deviations: beyond, residuals count linearly


@dataclass(frozen=True)
class FlowFit:
    """Fitted valve parameters and 95 % intervals by dotted name, and a sentence for each undetermined parameter."""

    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    undetermined: dict[str, str]
    correlation: Array  # (names, names)
    names: tuple[str, ...]


def coefficients(model: Model) -> tuple[str, ...]:
    """The coefficients of the valve's law of flow: those of ISO 6358 where it replaces the linear law."""
    if model.parameters.get("choked_flow.blend") == 1.0:
        return CHOKED
    return tuple(name for name in COEFFICIENTS if name in model.parameters)


def measured_flow(model: Model, window: Window) -> tuple[float, ...]:
    """Mass flow into each chamber [kg/s]: (p V' + V p' / gamma) / (R T), Eqs. 3-4 solved for q."""
    gamma, r_t = model["air.heat_capacity_ratio"], model["air.gas_constant"] * model["air.temperature"]
    found = []
    for chamber in model.chambers:
        pressure, slope = (getattr(window, f"{what}_{chamber.side}") for what in ("pressure", "slope"))
        grows = chamber.way * model[chamber.area] * window.velocity
        found.append((pressure * grows + _volume(model, chamber, window) * slope / gamma) / r_t)
    return tuple(found)


def flow_noise(model: Model, window: Window) -> tuple[float, ...]:
    """Deviation of `measured_flow` by sensor noise [kg/s]: that of V p' / (gamma R T), the dominant term."""
    per_volume = window.slope_noise / (
        model["air.heat_capacity_ratio"] * model["air.gas_constant"] * model["air.temperature"]
    )
    return tuple(per_volume * _volume(model, chamber, window) for chamber in model.chambers)


def _volume(model: Model, chamber: Chamber, window: Window) -> float:
    return model[chamber.volume] + chamber.way * model[chamber.area] * window.position


def fit_flow(model: Model, windows: Sequence[Window]) -> FlowFit:
    """Fit the flow coefficients and, where slow voltages were used, the dead zone's limits, on the used windows.

    Needs the effects dead_zone and arctan_flow; without them, or with too few windows, everything is undetermined.
    """
    names = to_fit(model, (*coefficients(model), *LIMITS, *PATHS))
    used = [w for w in windows if w.used and w.velocity * w.input > 0.0]
    if "arctan_flow" not in model.effects or not names or len(used) < 2 * len(names):
        text = f"{len(used)} steady stretches with an open valve are too few"
        unknown = dict.fromkeys(to_fit(model, coefficients(model)), text)
        return FlowFit({}, {}, unknown, np.empty((0, 0)), ())
    problem = _FlowProblem(model, used, names)
    x = least_squares(
        problem.residuals, np.ones(len(names)), bounds=problem.bounds(), loss="soft_l1", f_scale=_F_SCALE
    ).x
    return problem.result(np.asarray(x))


class _FlowProblem:
    """Least squares over factors x of the parameters `names`, with priors of the dead zone's limits.

    A parameter of PATHS may be 0: it is its present value plus (x - 1) usual sizes.
    """

    def __init__(self, model: Model, used: Sequence[Window], names: tuple[str, ...]) -> None:
        self.model, self.names = model, names
        self.states = np.tile(model.state(), (len(used), 1))
        for column, key in enumerate(("position", "velocity", *(chamber.field for chamber in model.chambers))):
            self.states[:, column] = [getattr(w, key) for w in used]
        self.held = np.array([w.input for w in used])
        self.inputs = np.array([(w.input, *w.further) for w in used])
        if model.composition.commanded:  # a spool follows the command; at rest it would be closed
            self.states[:, columns(model)] = settled(model, self.inputs)
        self.flows = np.array([measured_flow(model, w) for w in used])
        self.spread = np.hypot([flow_noise(model, w) for w in used], _RELATIVE * np.abs(self.flows))
        self.begin = np.array([model[name] for name in names])
        self.scale = np.array([model.usual_size(n) if n in PATHS else model[n] for n in names])
        self.known = np.array([name in LIMITS for name in names], dtype=bool)
        self.groups = [*(w.run for w in used for _ in model.chambers), *("" for _ in range(int(self.known.sum())))]

    def values(self, x: Array) -> dict[str, float]:
        """Parameters by dotted name at x."""
        return dict(zip(self.names, (self.begin + (x - 1.0) * self.scale).tolist(), strict=True))

    def bounds(self) -> tuple[Array, Array]:
        """Least and largest x: a factor of 5 either way, the whole range for PATHS."""
        given = [(name, self.model.specification(name)) for name in self.names]
        low = [one.low if name in PATHS else 0.2 * self.model[name] for name, one in given]
        high = [one.high if name in PATHS else 5.0 * self.model[name] for name, one in given]
        first, last = (1.0 + (np.array(ends) - self.begin) / self.scale for ends in (low, high))
        return first, last

    def residuals(self, x: Array) -> Array:
        """Whitened: model minus measured flow into the chambers of every window, then the limits about their priors."""
        seen = self.model.with_parameters(self.values(x)).outputs(self.states, self.inputs)
        claimed = np.stack([seen[chamber.flow] for chamber in self.model.chambers], axis=1)
        flows = ((claimed - self.flows) / self.spread).ravel()
        return np.concatenate([flows, (x - 1.0)[self.known] / _KNOWN])

    def result(self, x: Array) -> FlowFit:
        """Values and intervals at the solution x; limits hardly better known than by their priors are undetermined."""
        residual = self.residuals(x)
        weight = 1.0 / (1.0 + (residual / _F_SCALE) ** 2)
        half, correlation = half_widths(residual, central_jacobian(self.residuals, x), weight, self.groups)
        most = np.array([PATHS.get(name, np.inf) for name in self.names]) / self.scale
        most[~np.isfinite(most)] = np.where(self.known, _KNOWN, _LOOSE * x)[~np.isfinite(most)]
        loose = half > most  # of a limit: half its prior 95 % interval
        values = self.values(x)
        unknown = {name: self._reason(name) for name, bad in zip(self.names, loose, strict=True) if bad}
        kept = {name: value for name, value in values.items() if name not in unknown}
        wide = dict(zip(self.names, (half * self.scale).tolist(), strict=True))
        intervals = {name: (value - wide[name], value + wide[name]) for name, value in kept.items()}
        return FlowFit(kept, intervals, unknown, correlation, self.names)

    def _reason(self, name: str) -> str:
        if name in LIMITS:
            sign = 1.0 if name == LIMITS[0] else -1.0
            side = "positive" if sign > 0.0 else "negative"
            if not (sign * self.held > 0.0).any():
                return f"needs runs at {side} voltages"
            return f"needs runs at several small {side} voltages, the smallest just beyond the dead zone"
        if name in PATHS and name != "subsonic_index.index":
            return "needs runs at several voltages in both directions"
        if name in (CHOKED[2], "subsonic_index.index"):
            return "needs runs at which a chamber is filled to nearly the supply pressure, and others with choked flow"
        return "needs runs at more voltages, including fast runs"
