"""PySINDy's library: candidate terms of the momentum and of both chambers, and the catalogue effect each stands for.

A term is a force on the piston [N], an inflow of each chamber [kg/s], or both: one coefficient then multiplies all of
them. Only shapes matter; coefficients are free. An effect at rest (`dwell_time_breakaway`) has no term.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from peer_signals import Array, Pair, Signals


class Term(NamedTuple):
    """One column of the library; `force` and `inflow` make it from the signals of a run."""

    effect: str
    text: str
    force: Callable[[Signals], Array] | None = None
    inflow: Callable[[Signals], Pair] | None = None


def _a(flow: Callable[[Signals], Array]) -> Callable[[Signals], Pair]:
    return lambda s: (flow(s), 0.0 * s.y)


def _b(flow: Callable[[Signals], Array]) -> Callable[[Signals], Pair]:
    return lambda s: (0.0 * s.y, flow(s))


def _cross(flow: Callable[[Signals], Array]) -> Callable[[Signals], Pair]:
    return lambda s: (-flow(s), flow(s))


def _hat(centre: float) -> Callable[[Signals], Array]:
    return lambda s: s.sign * np.exp(-(((s.y - centre) / 0.08) ** 2))


def _seal(s: Signals) -> Array:
    return 0.5 * (s.p_a + s.p_b) - s.p_atm


def _hanging(hertz: float) -> Callable[[Signals], Array]:
    return lambda s: s.resonant(s.acceleration, 2.0 * np.pi * hertz, 0.1) - s.acceleration


def _drive_rate(s: Signals) -> Array:
    return s.area_a * s.p_rate[0] - s.area_b * s.p_rate[1]


def _volume_rate(s: Signals) -> Pair:
    """Change of both inflows that the motion shows, per second by which the position is late."""
    earlier_a = s.p_a * s.acceleration + s.v * s.p_rate[0] / s.gamma
    earlier_b = s.p_b * s.acceleration + s.v * s.p_rate[1] / s.gamma
    return s.area_a * earlier_a / s.R_T, -s.area_b * earlier_b / s.R_T


def _jump(s: Signals) -> Pair:
    jump = s.rate(s.y - s.play(s.y, 1e-4))
    return s.area_a * s.p_a * jump / s.R_T, -s.area_b * s.p_b * jump / s.R_T


def _iso_filling(s: Signals) -> Pair:
    phi, old = s.opening(s.U) / (0.5 * np.pi), s.inlet(s.U)
    return (
        np.maximum(phi, 0.0) * s.iso(s.p_s, s.p_a) - old[0],
        np.maximum(-phi, 0.0) * s.iso(s.p_s, s.p_b) - old[1],
    )


def _iso_exhaust(s: Signals) -> Pair:
    phi, old = s.opening(s.U) / (0.5 * np.pi), s.outlet(s.U)
    return (
        np.minimum(phi, 0.0) * s.iso(s.p_a, s.p_atm) - old[0],
        np.minimum(-phi, 0.0) * s.iso(s.p_b, s.p_atm) - old[1],
    )


def _behind_tube(s: Signals) -> Pair:
    q_a, q_b = s.inflow(s.U)
    return s.delayed(q_a, 0.01) - q_a, s.delayed(q_b, 0.01) - q_b


def _lossy(s: Signals) -> Pair:
    q_a, q_b = s.inflow(s.U)
    return -q_a * abs(q_a), -q_b * abs(q_b)


def _sneaking(s: Signals) -> Pair:
    closed = 1.0 - abs(s.opening(s.U)) / (0.5 * np.pi)
    return closed * (s.p_s + s.p_atm - 2.0 * s.p_a), closed * (s.p_s + s.p_atm - 2.0 * s.p_b)


def _drooping(seconds: float) -> Callable[[Signals], Pair]:
    def flows(s: Signals) -> Pair:
        phi, drawn = s.opening(s.U), s.lagged(sum(s.inlet(s.U)), seconds)
        return -np.maximum(phi, 0.0) * drawn, -np.maximum(-phi, 0.0) * drawn

    return flows


def _cushioned(s: Signals) -> Pair:
    out, reach = s.outlet(s.U), 0.5 * s.model["piston.stroke"] - 0.025
    return -out[0] * (s.y < -reach), -out[1] * (s.y > reach)


def _polytropic(s: Signals) -> Pair:
    return -s.V_a * s.p_rate[0], -s.V_b * s.p_rate[1]


def _wall(s: Signals) -> Pair:
    hot_a, hot_b = np.log(s.p_a), np.log(s.p_b)
    return s.p_a * s.V_a * (hot_a - s.lagged(hot_a, 0.3)), s.p_b * s.V_b * (hot_b - s.lagged(hot_b, 0.3))


def _by_offset_a(s: Signals) -> Array:
    return s.area_a * s.v / s.R_T - s.steepness[0]


def _by_offset_b(s: Signals) -> Array:
    return -s.area_b * s.v / s.R_T - s.steepness[1]


def _by_gain_a(s: Signals) -> Array:
    return s.V_a * s.p_rate[0] / (s.gamma * s.R_T) + s.p_a * _by_offset_a(s)


def _by_gain_b(s: Signals) -> Array:
    return s.V_b * s.p_rate[1] / (s.gamma * s.R_T) + s.p_b * _by_offset_b(s)


TERMS = (
    Term("viscous_friction", "v", lambda s: s.v),
    Term("viscous_friction", "sgn(v) sqrt|v|", lambda s: s.sign * np.sqrt(abs(s.v))),
    Term("asymmetric_friction", "sgn v where v < 0", lambda s: 1.0 * (s.v < 0.0)),
    Term("asymmetric_viscous_friction", "v where v < 0", lambda s: np.minimum(s.v, 0.0)),
    Term("position_dependent_friction", "y sgn v", lambda s: s.y * s.sign),
    Term("position_dependent_friction", "y^2 sgn v", lambda s: s.y**2 * s.sign),
    Term("position_dependent_friction", "y v", lambda s: s.y * s.v),
    *(Term("position_dependent_friction", f"hat({c:g} m) sgn v", _hat(c)) for c in (-0.3, -0.15, 0.0, 0.15, 0.3)),
    Term("pressure_dependent_friction", "(p_a + p_b) sgn v", lambda s: _seal(s) * s.sign),
    Term("stribeck_shape", "exp(-|v| / v_s) sgn v", lambda s: s.sign * np.exp(-abs(s.v) / 0.01)),
    Term("stribeck_shape", "sgn v / (1 + (v / v_s)^2)", lambda s: s.sign / (1.0 + (s.v / 0.01) ** 2)),
    Term("friction_warmup", "exp(-t / 5 s) sgn v", lambda s: s.sign * np.exp(-s.time / 5.0)),
    Term("friction_warmup", "exp(-t / 20 s) sgn v", lambda s: s.sign * np.exp(-s.time / 20.0)),
    Term("friction_lag", "|v| dv/dt", lambda s: abs(s.v) * s.acceleration),
    Term("friction_lag", "exp(-(v / v_s)^2) dv/dt", lambda s: np.exp(-((s.v / 0.01) ** 2)) * s.acceleration),
    Term("payload_mass", "dv/dt", lambda s: s.acceleration),
    Term("constant_load", "1", lambda s: np.ones_like(s.y)),
    Term("spring_load", "y", lambda s: s.y),
    Term("spring_load", "y^3", lambda s: s.y**3),
    *(Term("load_compliance", f"dv/dt behind {hertz} Hz", _hanging(hertz)) for hertz in (6, 12, 24)),
    Term("backlash", "jump of y at a reversal", None, _jump),
    Term("choked_flow", "ISO 6358 filling", None, _iso_filling),
    Term("choked_flow", "ISO 6358 exhaust", None, _iso_exhaust),
    Term("valve_spool_dynamics", "q(U behind 10 ms)", None, lambda s: s.changed(s.lagged(s.U, 0.01))),
    Term("valve_spool_dynamics", "q(U behind 80 rad/s)", None, lambda s: s.changed(s.resonant(s.U, 80.0, 0.7))),
    Term("valve_null_offset", "q(U + 0.1 V)", None, lambda s: s.changed(s.U + 0.1)),
    Term("valve_hysteresis", "q(U behind a play of 0.1 V)", None, lambda s: s.changed(s.play(s.U, 0.1))),
    Term("valve_internal_leakage", "p_s + p_atm - 2 p where closed", None, _sneaking),
    Term("supply_pressure_droop", "phi times flow drawn", None, _drooping(0.005)),
    Term("supply_pressure_droop", "phi times flow drawn, 0.15 s", None, _drooping(0.15)),
    Term("line_delay", "q 10 ms ago", None, _behind_tube),
    Term("line_delay", "q |q|", None, _lossy),
    Term("cross_piston_leakage", "p_a - p_b", None, _cross(lambda s: s.p_a - s.p_b)),
    Term("cross_piston_leakage", "p_a^2 - p_b^2", None, _cross(lambda s: s.p_a**2 - s.p_b**2)),
    Term(
        "cross_piston_leakage", "sqrt|p_a - p_b|", None,
        _cross(lambda s: np.sign(s.p_a - s.p_b) * np.sqrt(abs(s.p_a - s.p_b))),
    ),
    Term("leakage_to_atmosphere", "p_a - p_atm", None, _a(lambda s: s.p_atm - s.p_a)),
    Term("leakage_to_atmosphere", "p_b - p_atm", None, _b(lambda s: s.p_atm - s.p_b)),
    Term("leakage_to_atmosphere", "p_a^2 - p_atm^2", None, _a(lambda s: s.p_atm**2 - s.p_a**2)),
    Term("leakage_to_atmosphere", "p_b^2 - p_atm^2", None, _b(lambda s: s.p_atm**2 - s.p_b**2)),
    Term("cushioning", "outflow within 25 mm of an end", None, _cushioned),
    Term("dead_volume", "dp_a/dt", None, _a(lambda s: -s.p_rate[0])),
    Term("dead_volume", "dp_b/dt", None, _b(lambda s: -s.p_rate[1])),
    Term("heat_exchange", "V dp/dt", None, _polytropic),
    Term("heat_exchange", "p V (ln p - its lag of 0.3 s)", None, _wall),
    Term("pressure_sensor_offset", "p_a + p_0", lambda s: -s.area_a + 0.0 * s.y, _a(_by_offset_a)),
    Term("pressure_sensor_offset", "p_b + p_0", lambda s: s.area_b + 0.0 * s.y, _b(_by_offset_b)),
    Term("pressure_sensor_gain", "k p_a", lambda s: -s.area_a * s.p_a, _a(_by_gain_a)),
    Term("pressure_sensor_gain", "k p_b", lambda s: s.area_b * s.p_b, _b(_by_gain_b)),
    Term("position_sensor_delay", "d(A_a p_a - A_b p_b)/dt, and dV/dt earlier", _drive_rate, _volume_rate),
)  # fmt: skip
