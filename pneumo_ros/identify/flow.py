"""Flow coefficients of the valve from steady motion: mass flow q = p A v / (R T) into a chamber that grows at A v."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumo_ros.identify.confidence import central_jacobian, half_widths
from pneumo_ros.identify.steady import Window
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

COEFFICIENTS = ("arctan_flow.filling_coefficient", "arctan_flow.exhaust_coefficient")
CHOKED = ("choked_flow.conductance_filling", "choked_flow.conductance_exhaust", "choked_flow.critical_ratio")
LIMITS = ("dead_zone.right_limit", "dead_zone.left_limit")
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


def measured_flow(model: Model, window: Window) -> tuple[float, float]:
    """Mass flow into chamber a and into chamber b [kg/s]: (p V' + V p' / gamma) / (R T), Eqs. 3-4 solved for q."""
    gamma, r_t = model["air.heat_capacity_ratio"], model["air.gas_constant"] * model["air.temperature"]
    a, b = model["piston.area_a"], model["piston.area_b"]
    volume_a = model["chambers.volume_a"] + a * window.position
    volume_b = model["chambers.volume_b"] - b * window.position
    into_a = (window.pressure_a * a * window.velocity + volume_a * window.slope_a / gamma) / r_t
    into_b = (-window.pressure_b * b * window.velocity + volume_b * window.slope_b / gamma) / r_t
    return into_a, into_b


def flow_noise(model: Model, window: Window) -> tuple[float, float]:
    """Deviation of `measured_flow` by sensor noise [kg/s]: that of V p' / (gamma R T), the dominant term."""
    per_volume = window.slope_noise / (
        model["air.heat_capacity_ratio"] * model["air.gas_constant"] * model["air.temperature"]
    )
    volume_a = model["chambers.volume_a"] + model["piston.area_a"] * window.position
    volume_b = model["chambers.volume_b"] - model["piston.area_b"] * window.position
    return per_volume * volume_a, per_volume * volume_b


def fit_flow(model: Model, windows: Sequence[Window]) -> FlowFit:
    """Fit the flow coefficients and, where slow voltages were used, the dead zone's limits, on the used windows.

    Needs the effects dead_zone and arctan_flow; without them, or with too few windows, everything is undetermined.
    """
    names = (*coefficients(model), *(name for name in LIMITS if name in model.parameters))
    used = [w for w in windows if w.used and w.velocity * w.input > 0.0]
    if "arctan_flow" not in model.effects or len(used) < 2 * len(names):
        text = f"{len(used)} steady stretches with an open valve are too few"
        unknown = dict.fromkeys(coefficients(model), text)
        return FlowFit({}, {}, unknown, np.empty((0, 0)), ())
    problem = _FlowProblem(model, used, names)
    x = least_squares(problem.residuals, np.ones(len(names)), bounds=(0.2, 5.0), loss="soft_l1", f_scale=_F_SCALE).x
    return problem.result(np.asarray(x))


class _FlowProblem:
    """Least squares over factors of the parameters `names`, with priors of the dead zone's limits."""

    def __init__(self, model: Model, used: Sequence[Window], names: tuple[str, ...]) -> None:
        self.model, self.names = model, names
        self.states = np.tile(model.state(), (len(used), 1))
        for column, key in enumerate(("position", "velocity", "pressure_a", "pressure_b")):
            self.states[:, column] = [getattr(w, key) for w in used]
        self.held = np.array([w.input for w in used])
        self.flows = np.array([measured_flow(model, w) for w in used])
        self.spread = np.hypot([flow_noise(model, w) for w in used], _RELATIVE * np.abs(self.flows))
        self.scale = np.array([model[name] for name in names])
        self.known = np.array([name in LIMITS for name in names], dtype=bool)
        self.groups = [*(w.run for w in used for _ in "ab"), *("" for _ in range(int(self.known.sum())))]

    def residuals(self, x: Array) -> Array:
        """Whitened: model minus measured flow into a and b of every window, then the limits about their priors."""
        values = dict(zip(self.names, (x * self.scale).tolist(), strict=True))
        seen = self.model.with_parameters(values).outputs(self.states, self.held)
        claimed = np.stack([seen["port_flow_a"], seen["port_flow_b"]], axis=1)
        flows = ((claimed - self.flows) / self.spread).ravel()
        return np.concatenate([flows, (x - 1.0)[self.known] / _KNOWN])

    def result(self, x: Array) -> FlowFit:
        """Values and intervals at the solution x; limits hardly better known than by their priors are undetermined."""
        residual = self.residuals(x)
        weight = 1.0 / (1.0 + (residual / _F_SCALE) ** 2)
        half, correlation = half_widths(residual, central_jacobian(self.residuals, x), weight, self.groups)
        loose = half > np.where(self.known, _KNOWN, _LOOSE * x)  # of a limit: half its prior 95 % interval
        values = dict(zip(self.names, (x * self.scale).tolist(), strict=True))
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
        if name == CHOKED[2]:
            return "needs runs at which a chamber is filled to nearly the supply pressure, and others with choked flow"
        return "needs runs at more voltages, including fast runs"
