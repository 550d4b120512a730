"""The equations of the base machine, in the variables of the energy balance.

Chamber pressures are states s = p (V / V_0)^gamma, which adiabatic motion does not change: the energy balance of a
chamber without heat exchange, d(p V^gamma)/dt = gamma V^(gamma - 1) R T q, needs no velocity. The bristle's state is
its force w = sigma_0 z. Nothing here is compiled or optimised for speed.
"""

import math
from collections.abc import Mapping

import numpy as np

PARAMETERS: dict[str, float] = {
    "mass": 5.0,
    "area_a": 4.1e-4,
    "area_b": 3.0e-4,
    "stroke": 2.0,
    "volume_a": 5.1e-4,
    "volume_b": 4.0e-4,
    "supply_pressure": 7e5,
    "atmospheric_pressure": 1e5,
    "gas_constant": 287.0,
    "temperature": 293.0,
    "heat_capacity_ratio": 1.4,
    "right_limit": 0.78,
    "left_limit": 0.78,
    "right_slope": 1.0,
    "left_slope": 1.0,
    "voltage_gain": 2.0,
    "filling_coefficient": 0.69501e-8,
    "exhaust_coefficient": 0.898105e-8,
    "static_friction": 100.0,
    "coulomb_friction": 70.0,
    "stribeck_velocity": 0.01,
    "bristle_stiffness": 1.4e6,
    "bristle_damping": 50.0,
    "breakaway_ratio": 0.9,
    "drag_coefficient": 4546.7,
    "end_stop_stiffness": 1e6,
    "end_stop_damping": 1e3,
    "rod_atmospheric_force": 1.0,  # 1: the atmosphere presses on the rod; 0: as the paper prints it
}


class Axis:
    """The equations of one machine; `parameters` override PARAMETERS, an unknown name raises KeyError."""

    def __init__(self, parameters: Mapping[str, float]) -> None:
        unknown = set(parameters) - set(PARAMETERS)
        if unknown:
            raise KeyError(f"unknown parameters {sorted(unknown)}; known: {sorted(PARAMETERS)}")
        self.p = {**PARAMETERS, **parameters}

    def opening(self, voltage: float) -> float:
        """phi, the signed opening of the valve after dead zone and atan [-]."""
        p = self.p
        beyond = p["right_slope"] * max(voltage - p["right_limit"], 0.0)
        beyond += p["left_slope"] * min(voltage + p["left_limit"], 0.0)
        return math.atan(p["voltage_gain"] * beyond)

    def volumes(self, y: float) -> tuple[float, float]:
        """Volumes of the two chambers [m3]."""
        p = self.p
        return p["volume_a"] + p["area_a"] * y, p["volume_b"] - p["area_b"] * y

    def pressures(self, y: float, s_a: float, s_b: float) -> tuple[float, float]:
        """Pressures [Pa] from the adiabatic invariants s = p (V / V_0)^gamma [Pa]."""
        gamma, (room_a, room_b) = self.p["heat_capacity_ratio"], self.volumes(y)
        return s_a * (self.p["volume_a"] / room_a) ** gamma, s_b * (self.p["volume_b"] / room_b) ** gamma

    def inflows(self, opening: float, p_a: float, p_b: float) -> tuple[float, float]:
        """Mass flows into chamber a and into chamber b [kg/s]."""
        p = self.p
        fill, empty = p["filling_coefficient"], p["exhaust_coefficient"]
        supply, atmosphere = p["supply_pressure"], p["atmospheric_pressure"]
        if opening >= 0.0:
            return opening * fill * (supply - p_a), -opening * empty * (p_b - atmosphere)
        return opening * empty * (p_a - atmosphere), -opening * fill * (supply - p_b)

    def bristle_rate(self, v: float, w: float) -> float:
        """Rate of the bristle force w = sigma_0 z [N/s], elasto-plastic."""
        p = self.p
        level = p["coulomb_friction"]
        level += (p["static_friction"] - level) * math.exp(-((v / p["stribeck_velocity"]) ** 2))
        plastic = self.plasticity(v * w, abs(w) / level)
        return p["bristle_stiffness"] * (v - plastic * abs(v) * w / level)

    def plasticity(self, loading: float, load: float) -> float:
        """alpha [-] from the bristle's share `load` of its highest force; `loading` > 0 while v and w agree."""
        elastic = self.p["breakaway_ratio"]
        if loading < 0.0 or load <= elastic:
            return 0.0
        if load >= 1.0:
            return 1.0
        # the half wave 1/2 + 1/2 sin of the model, as a squared sine of the way through the transition
        return math.sin(0.5 * math.pi * (load - elastic) / (1.0 - elastic)) ** 2

    def friction(self, v: float, w: float) -> float:
        """Friction force, positive against positive velocity [N]."""
        p = self.p
        micro_damping = p["bristle_damping"] / p["bristle_stiffness"] * self.bristle_rate(v, w)
        return w + micro_damping + p["drag_coefficient"] * v * abs(v)

    def stop_force(self, y: float, v: float) -> float:
        """Force of the end stops on the piston: spring and damper that push and never pull [N]."""
        stiffness, damping, half = self.p["end_stop_stiffness"], self.p["end_stop_damping"], 0.5 * self.p["stroke"]
        if y > half:
            return -max(stiffness * (y - half) + damping * v, 0.0)
        if y < -half:
            return -min(stiffness * (y + half) + damping * v, 0.0)
        return 0.0

    def drive(self, p_a: float, p_b: float) -> float:
        """Force of gas and atmosphere on the piston [N]."""
        p = self.p
        rod = p["rod_atmospheric_force"] * p["atmospheric_pressure"] * (p["area_a"] - p["area_b"])
        return p["area_a"] * p_a - p["area_b"] * p_b - rod

    def rates(self, x: np.ndarray, opening: float) -> list[float]:
        """Time derivative of x = (y, v, s_a, s_b, w) with the valve held at `opening`."""
        p, (y, v, s_a, s_b, w) = self.p, (float(value) for value in x)
        gamma, heat = p["heat_capacity_ratio"], p["gas_constant"] * p["temperature"]
        (room_a, room_b), (p_a, p_b) = self.volumes(y), self.pressures(y, s_a, s_b)
        q_a, q_b = self.inflows(opening, p_a, p_b)
        force = self.drive(p_a, p_b) - self.friction(v, w) + self.stop_force(y, v)
        filling_a = gamma * heat * q_a * s_a / (p_a * room_a)
        filling_b = gamma * heat * q_b * s_b / (p_b * room_b)
        return [v, force / p["mass"], filling_a, filling_b, self.bristle_rate(v, w)]


class PlainLuGre(Axis):
    """The same machine with alpha = 1: the bristle yields under any load, and creeps."""

    def plasticity(self, loading: float, load: float) -> float:
        """1, at any load."""
        return 1.0
