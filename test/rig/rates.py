"""The whole machine as one ordinary differential equation."""

from math import pi, sin

from numba import njit
from numpy import ndarray

from .friction import between, film, level, texture, yielded
from .gas import cross_leak, outward_leak, through_hose, volumes, wall_heat
from .machine import FORCE_SPACING, Machine, Roughness
from .motion import coupled, external, stop
from .valve import flows

# The bristle's state is its share of static friction, a chamber's are mass [kg] and internal energy [J].
STATES = (
    "y",
    "v",
    "bristle",
    "energy_a",
    "energy_b",
    "gas_a",
    "gas_b",
    "spool",
    "spool_rate",
    "supply",
    "load_y",
    "load_v",
    "age",
    "film",
    "warmth",
    "line_a",
    "line_b",
)


@njit(error_model="numpy", _nrt=False)
def gas_pressures(m: Machine, x: ndarray):
    """Chamber pressures [Pa] from internal energies."""
    room_a, room_b = volumes(m, x[0])
    return (m.adiabatic - 1.0) * x[3] / room_a, (m.adiabatic - 1.0) * x[4] / room_b


@njit(error_model="numpy", _nrt=False)
def spool_position(m: Machine, x: ndarray, command: float) -> float:
    """Position of the spool [V]."""
    return x[7] if m.spool_rate > 0.0 or m.spool_lag > 0.0 else command


@njit(error_model="numpy", _nrt=False)
def supply_pressure(m: Machine, x: ndarray, t: float) -> float:
    """Pressure at the valve's inlet [Pa]."""
    at_rest = x[9] if m.feed > 0.0 else m.supply
    if m.ripple == 0.0:
        return at_rest
    return at_rest * (1.0 + m.ripple * sin(2.0 * pi * m.ripple_hertz * t))


@njit(error_model="numpy", _nrt=False)
def line_flows(m: Machine, x: ndarray, t: float, command: float):
    """Net flows into the hoses of a and b, and the flow from the supply [kg/s]."""
    p_a, p_b = gas_pressures(m, x)
    to_a, from_a, to_b, from_b = flows(m, spool_position(m, x, command), supply_pressure(m, x, t), p_a, p_b)
    to_a, from_a = through_hose(m, x[0], p_a, to_a, from_a, -1.0, True)
    to_b, from_b = through_hose(m, x[0], p_b, to_b, from_b, 1.0, False)
    return to_a - from_a, to_b - from_b, to_a + to_b


@njit(error_model="numpy", _nrt=False)
def rates(m: Machine, rough: Roughness, x: ndarray, t: float, command: float, late: ndarray, dx: ndarray) -> None:
    """Write the time derivative of x into dx; `late` holds delayed flows a, b and the delayed velocity."""
    y, v = x[0], x[1]
    p_a, p_b = gas_pressures(m, x)
    q_a, q_b, drawn = line_flows(m, x, t, command)
    if m.line_delay > 0.0:
        q_a, q_b = late[0], late[1]
    dx[15] = dx[16] = 0.0
    if m.line_lag > 0.0:
        dx[15], dx[16] = (q_a - x[15]) / m.line_lag, (q_b - x[16]) / m.line_lag
        q_a, q_b = x[15], x[16]
    _chambers(m, x, p_a, p_b, q_a, q_b, dx)
    _supply(m, x, command, drawn, dx)

    lagged = late[2] if m.lag_delay > 0.0 else (x[13] if m.lag_film > 0.0 else v)
    dx[13] = (v - x[13]) / m.lag_film if m.lag_film > 0.0 else 0.0
    g = level(m, y, lagged, x[2], p_a, p_b, x[12], x[14], t) + texture(rough.texture, y)
    share = x[2] * m.static / g
    slip = v - yielded(m, v, x[2], share) * abs(v) * share
    resist = x[2] * m.static + m.bristle_damping * slip + film(m, v)
    gas = m.area_a * p_a - m.area_b * p_b - m.atmosphere * (m.area_a - m.area_b)
    force = gas - resist - external(m, y) + stop(m, y, v) + between(rough.force, t / FORCE_SPACING)
    _bodies(m, x, force, dx)
    dx[2] = slip * m.bristle / m.static
    dx[14] = (min(abs(resist * v) / 20.0, 1.0) - x[14]) / m.warm_fast if m.warm_work != 0.0 else 0.0
    dx[12] = 1.0 - abs(v) * x[12] / m.rest_slip if m.rest_rise != 0.0 else 0.0


@njit(error_model="numpy", _nrt=False)
def _chambers(m: Machine, x: ndarray, p_a: float, p_b: float, q_a: float, q_b: float, dx: ndarray) -> None:
    specific = m.gas_constant / (m.adiabatic - 1.0)
    gas_a, gas_b, warm_a, warm_b = m.temperature, m.temperature, 0.0, 0.0
    if m.wall_time > 0.0:
        room_a, room_b = volumes(m, x[0])
        gas_a, gas_b = x[3] / (x[5] * specific), x[4] / (x[6] * specific)
        warm_a = wall_heat(m, m.area_a, room_a, m.volume_a, p_a, gas_a)
        warm_b = wall_heat(m, m.area_b, room_b, m.volume_b, p_b, gas_b)
    across = cross_leak(m, p_a, p_b)
    out_a = outward_leak(m, m.leak_a, m.leak_gap_a, p_a)
    out_b = outward_leak(m, m.leak_b, m.leak_gap_b, p_b)
    crossing = across * (gas_a if across > 0.0 else gas_b)
    heat_a = q_a * (m.temperature if q_a > 0.0 else gas_a) - crossing - out_a * gas_a
    heat_b = q_b * (m.temperature if q_b > 0.0 else gas_b) + crossing - out_b * gas_b
    dx[3] = m.adiabatic * specific * heat_a - p_a * m.area_a * x[1] + warm_a
    dx[4] = m.adiabatic * specific * heat_b + p_b * m.area_b * x[1] + warm_b
    dx[5] = q_a - across - out_a
    dx[6] = q_b + across - out_b


@njit(error_model="numpy", _nrt=False)
def _supply(m: Machine, x: ndarray, command: float, drawn: float, dx: ndarray) -> None:
    dx[7] = dx[8] = dx[9] = 0.0
    if m.spool_rate > 0.0:
        dx[7] = x[8]
        dx[8] = m.spool_rate * (m.spool_rate * (command - x[7]) - 2.0 * m.spool_damping * x[8])
    elif m.spool_lag > 0.0:
        dx[7] = min(max((command - x[7]) / m.spool_lag, -m.spool_slew), m.spool_slew)
    if m.feed > 0.0:
        coming = (m.supply - x[9]) / m.feed
        dx[9] = m.adiabatic * m.gas_constant * m.temperature / m.tank * (coming - drawn)


@njit(error_model="numpy", _nrt=False)
def _bodies(m: Machine, x: ndarray, force: float, dx: ndarray) -> None:
    mass = m.mass + m.payload
    dx[0] = x[1]
    dx[10] = dx[11] = 0.0
    if m.load_share > 0.0:
        pull = coupled(m, x[10] - x[0], x[11] - x[1])
        dx[10], dx[11] = x[11], -pull / (m.load_share * mass)
        force, mass = force + pull, (1.0 - m.load_share) * mass
    dx[1] = force / mass
