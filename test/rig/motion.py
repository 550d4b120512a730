"""Forces on the piston other than gas and friction."""

from math import pi, sin

from numba import njit

from .machine import Machine

_SOFT = 2e-5  # m: the damping of a contact comes with its first 20 um


@njit(error_model="numpy", _nrt=False)
def stop(m: Machine, y: float, v: float) -> float:
    """Push of the end stops [N], positive outwards: spring and damper, never pulling."""
    if y > m.half_stroke:
        return -max(m.stop_stiffness * (y - m.half_stroke) + m.stop_damping * v, 0.0)
    if y < -m.half_stroke:
        return max(-m.stop_stiffness * (y + m.half_stroke) - m.stop_damping * v, 0.0)
    return 0.0


@njit(error_model="numpy", _nrt=False)
def external(m: Machine, y: float) -> float:
    """Loads by position, positive against extension [N]."""
    force = m.load
    if m.spring != 0.0:
        way = y - m.spring_centre
        force += m.spring * way * (1.0 + m.spring_hardening * (abs(way) / 0.3) ** m.spring_power)
    if m.detent != 0.0:
        force += m.detent * sin(2.0 * pi * y / m.detent_pitch + m.detent_phase)
    return force


@njit(error_model="numpy", _nrt=False)
def coupled(m: Machine, stretch: float, rate: float) -> float:
    """Force by which the coupling pulls the piston along with its load [N]; stretch = load minus piston [m]."""
    if abs(stretch) <= m.coupling_gap:
        return 0.0
    beyond = stretch - m.coupling_gap if stretch > 0.0 else stretch + m.coupling_gap
    if m.coupling_gap == 0.0:
        return m.coupling * beyond + m.coupling_damping * rate
    touching = min(abs(beyond) / _SOFT, 1.0)
    force = m.coupling * beyond + touching * m.coupling_damping * rate
    return force if force * beyond > 0.0 else 0.0  # faces of a gap do not stick together
