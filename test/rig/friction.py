"""Friction: the level a bristle can bear, its yielding, and the film's drag."""

from math import exp, log1p, pi, sin, tanh

from numba import njit
from numpy import ndarray

from .machine import TEXTURE_SPACING, TEXTURE_START, Machine


@njit(error_model="numpy", _nrt=False)
def between(table: ndarray, at: float) -> float:
    """Linear interpolation of a table at the fractional index `at`, ends held."""
    if at <= 0.0:
        return table[0]
    last = len(table) - 1
    if at >= last:
        return table[last]
    i = int(at)
    return table[i] + (at - i) * (table[i + 1] - table[i])


@njit(error_model="numpy", _nrt=False)
def level(
    m: Machine, y: float, v: float, load: float, p_a: float, p_b: float, age: float, warmth: float, t: float
) -> float:
    """Highest steady force of the bristle g [N]; `load` is the bristle's share of static friction, signed."""
    static = m.static
    if m.rest_rise != 0.0:  # Kato's law of static friction over the time at rest
        if m.rest_log == 0.0:
            static += m.rest_rise * (1.0 - exp(-((age / m.rest_time) ** m.rest_power)))
        else:  # after Dieterich
            static += m.rest_rise * log1p(age / m.rest_time) / log1p(10.0 / m.rest_time)
    speed = abs(v / m.stribeck)
    speed = speed * speed if m.stribeck_power == 2.0 else speed**m.stribeck_power
    rise = exp(-speed)
    if m.stribeck_rational != 0.0:  # after Hess and Soom
        rise += m.stribeck_rational * (1.0 / (1.0 + speed) - rise)
    g = m.coulomb + (static - m.coulomb) * rise
    if m.retract_excess != 0.0:  # the direction is that of the sheared bristle, not of the velocity
        excess = m.retract_excess * 0.5 * (1.0 - tanh(20.0 * load))
        g += excess * (m.coulomb + m.retract_static * (g - m.coulomb))
    if m.spot_height != 0.0:
        g *= 1.0 + m.spot_height * exp(-0.5 * ((y - m.spot_centre) / m.spot_width) ** 2)
    if m.bow != 0.0:
        g *= 1.0 + m.bow * (y / 0.5) ** 2
    if m.warm_share != 0.0:
        cold = m.warm_split * exp(-t / m.warm_fast) + (1.0 - m.warm_split) * exp(-t / m.warm_slow)
        g *= 1.0 - m.warm_share * (1.0 - cold)
    if m.warm_work != 0.0:
        g *= 1.0 - m.warm_work * warmth
    if m.seal != 0.0:
        gauge_a, gauge_b = max(p_a - m.atmosphere, 1.0), max(p_b - m.atmosphere, 1.0)
        scale = 0.5 * m.seal * 3e5 ** (1.0 - m.seal_power)
        g += scale * (gauge_a**m.seal_power + gauge_b**m.seal_power)
    return g


@njit(error_model="numpy", _nrt=False)
def texture(table: ndarray, y: float) -> float:
    """Friction texture at position y [N]."""
    return between(table, (y - TEXTURE_START) / TEXTURE_SPACING)


@njit(error_model="numpy", _nrt=False)
def yielded(m: Machine, v: float, deflection: float, share: float) -> float:
    """alpha: the plastic part of the motion, from the bristle's share of its highest force."""
    share = abs(share)
    if v * deflection < 0.0 or share <= m.elastic_share:
        return 0.0
    if share >= 1.0:
        return 1.0
    middle, width = 0.5 * (1.0 + m.elastic_share), 1.0 - m.elastic_share
    return 0.5 + 0.5 * sin(pi * (share - middle) / width)


@njit(error_model="numpy", _nrt=False)
def film(m: Machine, v: float) -> float:
    """Drag of the film [N]: the base model's square, and the viscous part, by the direction."""
    viscous = m.viscous_out * max(v, 0.0) + m.viscous_in * min(v, 0.0)
    if m.viscous_power != 1.0 and v != 0.0:
        viscous *= (abs(v) / 0.3) ** (m.viscous_power - 1.0)
    return viscous + m.drag * v * abs(v)
