"""Valve: command to spool, spool to opening, opening and pressures to mass flows."""

from math import atan, pi, sqrt

from numba import njit

from .machine import Machine

REFERENCE_DENSITY = 1.185  # kg/m3, ISO 6358 reference atmosphere ANR
_LAMINAR = 1e-3  # relative pressure difference below which the ISO flow is linear


@njit(error_model="numpy", _nrt=False)
def opening(m: Machine, spool: float) -> float:
    """Signed opening phi of a spool at `spool` volts."""
    if spool > m.dead_right:
        return atan(m.gain * (spool - m.dead_right))
    if spool < -m.dead_left:
        return atan(m.gain * (spool + m.dead_left))
    return 0.0


@njit(error_model="numpy", _nrt=False)
def iso_6358(m: Machine, conductance: float, upstream: float, downstream: float) -> float:
    """Mass flow of an orifice after ISO 6358 [kg/s], choked below the critical ratio, laminar near equal pressures."""
    if downstream > upstream:
        return -iso_6358(m, conductance, downstream, upstream)
    ratio = downstream / upstream
    slope = 1.0
    if ratio > 1.0 - _LAMINAR:
        slope, ratio = (1.0 - ratio) / _LAMINAR, 1.0 - _LAMINAR
    beyond = (ratio - m.critical_ratio) / (1.0 - m.critical_ratio)
    share = 1.0 if beyond <= 0.0 else (1.0 - beyond * beyond) ** m.subsonic_index
    return conductance * REFERENCE_DENSITY * upstream * share * slope


@njit(error_model="numpy", _nrt=False)
def path(m: Machine, phi: float, coefficient: float, upstream: float, downstream: float) -> float:
    """Mass flow through one edge, open by phi >= 0: linear in the pressure difference, or choked, or a mixture."""
    linear = phi * coefficient * (upstream - downstream)
    if m.sonic == 0.0:
        return linear
    conductance = m.sonic_conductance * coefficient / m.fill * phi / (0.5 * pi)
    return (1.0 - m.sonic) * linear + m.sonic * iso_6358(m, conductance, upstream, downstream)


@njit(error_model="numpy", _nrt=False)
def _root(difference: float) -> float:
    return difference / sqrt(abs(difference) + 100.0)


@njit(error_model="numpy", _nrt=False)
def flows(m: Machine, spool: float, supply: float, p_a: float, p_b: float):
    """Mass flows supply -> a, a -> atmosphere, supply -> b, b -> atmosphere [kg/s]."""
    phi = opening(m, spool)
    to_a, from_a, to_b, from_b = 0.0, 0.0, 0.0, 0.0
    if phi > 0.0:
        to_a = path(m, phi, m.fill, supply, p_a)
        from_b = path(m, phi, m.exhaust, p_b, m.atmosphere)
    elif phi < 0.0:
        from_a = path(m, -phi, m.exhaust, p_a, m.atmosphere)
        to_b = path(m, -phi, m.fill, supply, p_b)
    if m.sneak > 0.0:  # turbulent clearances beside the spool, fading as it opens
        faded = m.sneak / (1.0 + (spool / m.sneak_width) ** 2) / sqrt(m.supply - m.atmosphere)
        to_a += faded * _root(supply - p_a)
        to_b += faded * _root(supply - p_b)
        from_a += faded * _root(p_a - m.atmosphere)
        from_b += faded * _root(p_b - m.atmosphere)
    return to_a, from_a, to_b, from_b
