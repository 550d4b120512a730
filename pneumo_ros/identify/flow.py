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
LIMITS = ("dead_zone.right_limit", "dead_zone.left_limit")
_RELATIVE = 1e-4  # of a flow: what steadiness leaves of a window's mass balance at best


@dataclass(frozen=True)
class FlowFit:
    """Fitted valve parameters and 95 % intervals by dotted name, and sentences for what the data do not determine."""

    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    undetermined: dict[str, str]


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
    """Deviation of `measured_flow` by sensor noise [kg/s]: that of V p' / (gamma R T), which outweighs the others."""
    per_volume = window.slope_noise / (
        model["air.heat_capacity_ratio"] * model["air.gas_constant"] * model["air.temperature"]
    )
    volume_a = model["chambers.volume_a"] + model["piston.area_a"] * window.position
    volume_b = model["chambers.volume_b"] - model["piston.area_b"] * window.position
    return per_volume * volume_a, per_volume * volume_b


def fit_flow(model: Model, windows: Sequence[Window]) -> FlowFit:
    """Fit both flow coefficients and, where slow voltages were used, the dead zone's limits, on the used windows.

    Needs the effects dead_zone and arctan_flow; without them, or with too few windows, everything is undetermined.
    """
    names = tuple(name for name in (*COEFFICIENTS, *LIMITS) if name in model.parameters)
    used = [w for w in windows if w.used and w.velocity * w.input > 0.0]
    if "arctan_flow" not in model.effects or len(used) < 2 * len(names):
        text = f"{len(used)} steady stretches with an open valve are too few"
        return FlowFit({}, {}, {name: text for name in COEFFICIENTS if name in model.parameters})
    states = np.tile(model.state(), (len(used), 1))
    for column, key in enumerate(("position", "velocity", "pressure_a", "pressure_b")):
        states[:, column] = [getattr(w, key) for w in used]
    held = np.array([w.input for w in used])
    flows = np.array([measured_flow(model, w) for w in used])
    spread = np.hypot([flow_noise(model, w) for w in used], _RELATIVE * np.abs(flows))
    scale = np.array([model[name] for name in names])

    def residuals(x: Array) -> Array:
        variant = model.with_parameters(dict(zip(names, (x * scale).tolist(), strict=True)))
        seen = variant.outputs(states, held)
        claimed = np.stack([seen["port_flow_a"], seen["port_flow_b"]], axis=1)
        return np.asarray(((claimed - flows) / spread).ravel())

    solution = least_squares(residuals, np.ones(len(names)), bounds=(0.2, 5.0), loss="soft_l1", f_scale=3.0)
    groups = [w.run for w in used for _ in "ab"]
    return _result(names, solution.x, scale, residuals(solution.x), central_jacobian(residuals, solution.x), groups)


def _result(
    names: tuple[str, ...], x: Array, scale: Array, residual: Array, jacobian: Array, groups: list[str]
) -> FlowFit:
    weight = 1.0 / (1.0 + (residual / 3.0) ** 2)
    half, _ = half_widths(residual, jacobian, weight, groups)
    half *= scale
    values = dict(zip(names, (x * scale).tolist(), strict=True))
    unknown = {
        n: f"the interval is as wide as +- {h:.3g} about {values[n]:.3g}"
        for n, h in zip(names, half, strict=True)
        if h > 0.2 * abs(values[n])
    }
    kept = {n: v for n, v in values.items() if n not in unknown}
    intervals = {n: (values[n] - float(h), values[n] + float(h)) for n, h in zip(names, half, strict=True) if n in kept}
    return FlowFit(kept, intervals, unknown)
