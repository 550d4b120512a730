"""Inverse of chambers and valve for control laws: from a wanted rate of force to the opening of the valve."""

import math
from typing import NamedTuple

from pneumo_ros.control.machine import Machine

LEAST_VOLUME = 1e-8  # m3, keeps divisions finite for all parameters
STEEPEST = 1.5  # rad, arctangent of the flow at which the valve counts as fully open
NORMAL_DENSITY, NORMAL_TEMPERATURE = 1.185, 293.15  # kg/m3, K: ISO 6358-1
LINEAR = 0.999  # pressure ratio above which the flow is linear in it, as in the plant


class Chambers(NamedTuple):
    """Terms of the balances of both chambers at one instant: F' = fill * phi - stiffness * v - leak.

    F = A_a p_a - A_b p_b - F_atm [N]. With p_a' = gamma (R T q_a - A_a v p_a) / V_a and b likewise:
    fill = gamma R T (A_a w_a / V_a + A_b w_b / V_b) [N/(s rad)], where phi w is the flow through an edge; it differs
    for phi >= 0 (`fill`) and phi < 0 (`vent`); stiffness = gamma (A_a^2 p_a / V_a + A_b^2 p_b / V_b) [N/m].
    """

    force: float
    fill: float
    vent: float
    stiffness: float
    leak: float


def chambers(machine: Machine, position: float, p_a: float, p_b: float) -> Chambers:
    """The balances at `position` [m] and pressures [Pa]; areas may differ. Sources: paper Eqs. 3-4 and 6-9."""
    m = machine
    gamma_a = m.heat_capacity_ratio * m.area_a / max(m.volume_a + m.area_a * position, LEAST_VOLUME)
    gamma_b = m.heat_capacity_ratio * m.area_b / max(m.volume_b - m.area_b * position, LEAST_VOLUME)
    p_s, p_0, heat = m.supply_pressure, m.atmospheric_pressure, m.gas_constant * m.temperature
    fill = gamma_a * _edge(m, True, p_s, p_a) + gamma_b * _edge(m, False, p_b, p_0)
    vent = gamma_a * _edge(m, False, p_a, p_0) + gamma_b * _edge(m, True, p_s, p_b)
    return Chambers(
        force=m.area_a * p_a - m.area_b * p_b - m.atmosphere,
        fill=heat * fill,
        vent=heat * vent,
        stiffness=gamma_a * m.area_a * p_a + gamma_b * m.area_b * p_b,
        leak=heat * m.leakage * (gamma_a + gamma_b) * (p_a - p_b),
    )


def _edge(m: Machine, filling: bool, p_1: float, p_2: float) -> float:
    """Mass flow [kg/s] per rad of phi from p_1 to p_2 [Pa]: linear, or ISO 6358, or a share of both."""
    linear = (m.filling_coefficient if filling else m.exhaust_coefficient) * (p_1 - p_2)
    if m.choked_share == 0.0:
        return linear
    high, low = max(p_1, p_2, 1.0), max(min(p_1, p_2), 0.0)
    conductance = m.conductance_filling if filling else m.conductance_exhaust
    sonic = conductance * NORMAL_DENSITY * high * math.sqrt(NORMAL_TEMPERATURE / m.temperature)
    flow = math.copysign(sonic * _subsonic(low / high, m.critical_ratio) * 2.0 / math.pi, p_1 - p_2)
    return linear + m.choked_share * (flow - linear)


def _subsonic(ratio: float, b: float) -> float:
    """Share of the sonic flow, ISO 6358-1: an ellipse above the critical ratio b, linear near 1."""
    if ratio <= b:
        return 1.0
    bent = (min(ratio, LINEAR) - b) / (1.0 - b)
    ellipse = math.sqrt(max(1.0 - bent * bent, 0.0))
    return ellipse if ratio <= LINEAR else ellipse * (1.0 - ratio) / (1.0 - LINEAR)


def opening(machine: Machine, now: Chambers, velocity: float, force_rate: float) -> float:
    """Opening u [V] that makes F' = `force_rate` [N/s] at `velocity` [m/s]: phi = atan(k_u u) inverted.

    A rate that the valve cannot reach gives the opening of `STEEPEST`.
    """
    wanted = force_rate + now.stiffness * velocity + now.leak
    conductance = now.fill if wanted >= 0.0 else now.vent
    phi = wanted / max(conductance, 1e-3)
    return math.tan(min(max(phi, -STEEPEST), STEEPEST)) / machine.voltage_gain
