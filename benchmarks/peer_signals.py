"""Signals along one recorded run from which the terms of PySINDy's library are made."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.smooth import HALF_WIDTH, smooth

Array = NDArray[np.float64]
Pair = tuple[Array, Array]  # of chamber a and chamber b


class Signals:
    """Measured signals (n,) of a run, smoothed over +-12 ms, and what the model's valve and gas make of them."""

    def __init__(self, model: Model, run: Run) -> None:
        self.model, self.run, self.dt = model, run, run.sample_time
        self.y, self.v, self.p_a, self.p_b = measured_frame(run, model.chambers).T
        self.sign, self.time = np.sign(self.v), run.time
        self.U = np.append(run.held, run.held[-1])
        self.p_s, self.p_atm = model["air.supply_pressure"], model["air.atmospheric_pressure"]
        self.area_a, self.area_b = model["piston.area_a"], model["piston.area_b"]
        self.gamma, self.R_T = model["air.heat_capacity_ratio"], model["air.gas_constant"] * model["air.temperature"]
        self.V_a = model["chambers.volume_a"] + self.area_a * self.y
        self.V_b = model["chambers.volume_b"] - self.area_b * self.y

    @cached_property
    def acceleration(self) -> Array:
        """Acceleration [m/s2]."""
        return smooth(self.run.position, self.dt, 1.5 * HALF_WIDTH, 3, 2)

    @cached_property
    def p_rate(self) -> Pair:
        """Rates of both pressures [Pa/s]."""
        return smooth(self.p_a, self.dt, HALF_WIDTH, 2, 1), smooth(self.p_b, self.dt, HALF_WIDTH, 2, 1)

    def opening(self, U: Array) -> Array:
        """The valve's opening phi for a voltage (n,)."""
        m, u = self.model, np.zeros_like(U)
        right, left = m["dead_zone.right_limit"], m["dead_zone.left_limit"]
        u = np.where(right < U, m["dead_zone.right_slope"] * (U - right), u)
        u = np.where(-left > U, m["dead_zone.left_slope"] * (U + left), u)
        return np.asarray(np.arctan(m["arctan_flow.voltage_gain"] * u))

    def inlet(self, U: Array) -> Pair:
        """Mass flows from the supply into the chambers [kg/s]."""
        phi, beta = self.opening(U), self.model["arctan_flow.filling_coefficient"]
        return np.maximum(phi, 0.0) * beta * (self.p_s - self.p_a), np.maximum(-phi, 0.0) * beta * (self.p_s - self.p_b)

    def outlet(self, U: Array) -> Pair:
        """Mass flows from the atmosphere into the chambers, negative [kg/s]."""
        phi, beta = self.opening(U), self.model["arctan_flow.exhaust_coefficient"]
        out_a = np.minimum(phi, 0.0) * beta * (self.p_a - self.p_atm)
        return out_a, np.minimum(-phi, 0.0) * beta * (self.p_b - self.p_atm)

    def inflow(self, U: Array) -> Pair:
        """Mass flows into the chambers [kg/s]."""
        (in_a, in_b), (out_a, out_b) = self.inlet(U), self.outlet(U)
        return in_a + out_a, in_b + out_b

    @cached_property
    def steepness(self) -> Pair:
        """Derivative of each inflow by its chamber's pressure [kg/(s Pa)]."""
        phi = self.opening(self.U)
        fill, exhaust = (self.model[f"arctan_flow.{name}_coefficient"] for name in ("filling", "exhaust"))
        return np.where(phi > 0.0, -phi * fill, phi * exhaust), np.where(phi < 0.0, phi * fill, -phi * exhaust)

    def changed(self, U: Array) -> Pair:
        """Change of both inflows [kg/s] if the valve saw the voltage `U` in place of the command."""
        (new_a, new_b), (old_a, old_b) = self.inflow(U), self.inflow(self.U)
        return new_a - old_a, new_b - old_b

    def lagged(self, signal: Array, seconds: float) -> Array:
        """A signal behind a first-order lag; it starts settled."""
        keep = np.exp(-self.dt / seconds)
        return np.asarray(lfilter([1.0 - keep], [1.0, -keep], signal, zi=[keep * signal[0]])[0])

    def resonant(self, signal: Array, omega: float, damping: float) -> Array:
        """A signal behind a second-order lag of `omega` [rad/s]; it starts from zero."""
        w = omega * self.dt
        return np.asarray(lfilter([w * w], [1.0 + 2.0 * damping * w + w * w, -2.0 - 2.0 * damping * w, 1.0], signal))

    def delayed(self, signal: Array, seconds: float) -> Array:
        """A signal `seconds` later."""
        k = max(round(seconds / self.dt), 1)
        return np.concatenate([np.full(k, signal[0]), signal[:-k]])

    def play(self, signal: Array, half_width: float) -> Array:
        """A signal behind a play."""
        out, here = np.empty_like(signal), float(signal[0])
        for k, value in enumerate(signal.tolist()):
            here = min(max(here, value - half_width), value + half_width)
            out[k] = here
        return out

    def rate(self, signal: Array) -> Array:
        """Derivative of a signal in time."""
        return np.asarray(np.gradient(signal, self.dt))

    def iso(self, upstream: Any, downstream: Any) -> Array:
        """Flow by ISO 6358 [kg/s] through C = 5e-9 m3/(s Pa) with the critical ratio 0.3."""
        ratio = np.clip((downstream / upstream - 0.3) / 0.7, 0.0, 1.0)
        return np.asarray(5e-9 * 1.185 * upstream * np.sqrt(1.0 - ratio**2))
