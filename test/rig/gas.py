"""Chambers as open systems: mass and internal energy, walls that may exchange heat, leaks."""

from math import exp, sqrt, tanh

from numba import njit

from .machine import Machine

_WALL_PRESSURE = 4e5  # where wall_time is meant


@njit(error_model="numpy", _nrt=False)
def volumes(m: Machine, y: float):
    """Volumes of the chambers [m3]."""
    return m.volume_a + m.area_a * y, m.volume_b - m.area_b * y


@njit(error_model="numpy", _nrt=False)
def through_hose(m: Machine, y: float, p: float, to: float, out: float, end: float, kinked: bool):
    """Share of the flows to and from one chamber after kink, tube loss and cushion; `end` is where it is smallest."""
    if kinked and m.kink < 1.0:
        pinch = 0.5 * (1.0 + tanh(m.kink_side * (y - m.kink_position) / m.kink_width))
        left = 1.0 - (1.0 - m.kink) * pinch
        to, out = to * left, out * left
    if m.line_loss > 0.0:
        left = exp(-m.line_loss / p)
        to, out = to * left, out * left
    if m.cushion < 1.0:
        way = abs(end * m.half_stroke - y) / m.cushion_length
        if way < 1.0:  # the cushion spear leaves a ring that opens with the square of the distance
            out *= m.cushion + (1.0 - m.cushion) * way * way
    return to, out


@njit(error_model="numpy", _nrt=False)
def cross_leak(m: Machine, p_a: float, p_b: float) -> float:
    """Leak across the piston, from a to b [kg/s]."""
    difference = p_a - p_b
    leak = m.cross * difference
    if m.cross_gap != 0.0:
        leak += m.cross_gap * difference * (p_a + p_b) / 8e5
    if m.cross_orifice != 0.0:
        leak += m.cross_orifice * sqrt(2e5) * difference / sqrt(abs(difference) + 100.0)
    return leak


@njit(error_model="numpy", _nrt=False)
def outward_leak(m: Machine, linear: float, gap: float, p: float) -> float:
    """Leak from a chamber at p to atmosphere [kg/s]."""
    gauge = p - m.atmosphere
    return linear * gauge + gap * gauge * (p + m.atmosphere) / (_WALL_PRESSURE + m.atmosphere)


@njit(error_model="numpy", _nrt=False)
def wall_heat(m: Machine, area: float, volume: float, middle: float, p: float, gas: float) -> float:
    """Heat from the wall into the gas [W]: film coefficient growing with sqrt(p T), over the walls the gas touches."""
    specific = m.gas_constant / (m.adiabatic - 1.0)
    reference = _WALL_PRESSURE * middle / (m.gas_constant * m.temperature) * specific / m.wall_time
    bore = sqrt(4.0 * area / 3.141592653589793)
    touched = (2.0 * area + 4.0 * volume / bore) / (2.0 * area + 4.0 * middle / bore)
    film = sqrt(p * gas / (_WALL_PRESSURE * m.temperature))
    return reference * touched * film * (m.temperature - gas)
