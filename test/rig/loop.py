"""The fixed-step integrator of recordings: classical Runge-Kutta at 20 us, delays and plays advanced once per step."""

import numpy as np
from numba import njit
from numpy import ndarray

from .cache import drop_stale_kernels
from .machine import Machine, Roughness, packed
from .rates import STATES, line_flows, rates

STEP = 2e-5
SAMPLE = 1e-3
_PLAYS = 5

drop_stale_kernels()


@njit(error_model="numpy", _nrt=False)
def _runge_kutta(m: Machine, rough: Roughness, x: ndarray, t: float, h: float, u: float, late: ndarray, k: ndarray):
    rates(m, rough, x, t, u, late, k[0])
    for stage, part in ((1, 0.5), (2, 0.5), (3, 1.0)):
        for i in range(len(x)):
            k[4, i] = x[i] + part * h * k[stage - 1, i]
        rates(m, rough, k[4], t + part * h, u, late, k[stage])
    for i in range(len(x)):
        x[i] += h / 6.0 * (k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i])


@njit(error_model="numpy", _nrt=False)
def _remember(m: Machine, x: ndarray, t: float, u: float, past: ndarray, step: int, weight: float) -> None:
    """Add flows and velocity of now, weighted, to the mean over `step` in the ring `past` (3, room)."""
    q_a, q_b, _ = line_flows(m, x, t, u)
    now = step % past.shape[1]
    past[0, now] += weight * q_a
    past[1, now] += weight * q_b
    past[2, now] += weight * x[1]


@njit(error_model="numpy", _nrt=False)
def _recall(m: Machine, past: ndarray, step: int, h: float, late: ndarray) -> None:
    """Write the means over `step`, moved back by the delays, into `late`; flows before the first step are zero."""
    room = past.shape[1]
    for i in range(3):
        delay = m.lag_delay if i == 2 else m.line_delay
        then = step - max(delay / h, 1.0)
        older = int(np.floor(then))
        share = then - older
        late[i] = (1.0 - share) * past[i, older % room] if older >= 0 else 0.0
        late[i] += share * past[i, (older + 1) % room] if older >= -1 and share > 0.0 else 0.0
    past[:, step % room] = 0.0


@njit(error_model="numpy", _nrt=False)
def _slipped(plays: ndarray, m: Machine, u: float) -> float:
    """Spool command behind the plays: one of half width m.play, or five from 0 to twice that, in parallel."""
    total = 0.0
    for i in range(_PLAYS):
        width = m.play * (1.0 + m.play_spread * (2.0 * i / (_PLAYS - 1) - 1.0))
        plays[i] = min(max(plays[i], u - width), u + width)
        total += plays[i]
    return total / _PLAYS


@njit(error_model="numpy", _nrt=False)
def _positioner(y: float, wanted: float, memory: ndarray, sample: float) -> float:
    """Voltage of a plain PI position loop with dead zone jump, as rigs have it for creeping [V]."""
    error = wanted - y
    memory[0] = min(max(memory[0] + 40.0 * error * sample, -1.0), 1.0)
    effort = min(max(60.0 * error + memory[0], -2.0), 2.0)
    if abs(error) < 2e-5:
        return 0.0
    return effort + (0.78 if effort > 0.0 else -0.78)


@njit(error_model="numpy", _nrt=False)
def _guarded(u: float, y: float, limit: float, memory: ndarray) -> float:
    """The voltage, turned inwards from beyond `limit` until 0.15 m back."""
    if abs(y) > limit:
        memory[1] = -1.0 if y > 0.0 else 1.0
    elif abs(y) < limit - 0.15:
        memory[1] = 0.0
    return u if memory[1] == 0.0 else memory[1] * abs(u)


@njit(cache=True, error_model="numpy")  # the called functions are compiled into it; see `cache`
def integrate(
    m: Machine,
    rough: Roughness,
    x: ndarray,
    voltage: ndarray,
    wanted: ndarray,
    noise: ndarray,
    limit: float,
    steps: int,
    sample: float,
    out: ndarray,
    applied: ndarray,
) -> None:
    """Run len(voltage) samples of `sample` s in `steps` steps each, from x, which it advances.

    voltage (n,) [V] is applied, or, where wanted (n,) [m] is not NaN, the positioner's output for it and the
    position read with noise (n,) [m]. Writes the state at the START of each sample to out (n, states), the voltage to
    applied (n,).
    """
    h = sample / steps
    k, late, memory = np.empty((5, len(x))), np.zeros(3), np.zeros(2)
    past = np.zeros((3, 3 + int(max(m.line_delay, m.lag_delay) / h)))
    plays, delayed = np.zeros(_PLAYS), m.line_delay > 0.0 or m.lag_delay > 0.0
    for n in range(len(voltage)):
        u = voltage[n]
        if not np.isnan(wanted[n]):
            u = _positioner(x[0] + noise[n], wanted[n], memory, sample)
        u = _guarded(u, x[0], limit, memory)
        out[n], applied[n] = x, u
        command = _slipped(plays, m, u + m.null_offset)
        for i in range(steps):
            t = n * sample + i * h
            if delayed:
                _recall(m, past, n * steps + i, h, late)
                _remember(m, x, t, command, past, n * steps + i, 0.5)
            _runge_kutta(m, rough, x, t, h, command, late, k)
            if delayed:
                _remember(m, x, t + h, command, past, n * steps + i, 0.5)


def rest(m: Machine, y: float, p_a: float) -> ndarray:
    """State of a machine at rest at y [m], p_a [Pa] in chamber a, the same gas force from b, cold, long unmoved."""
    p_b = p_a * m.area_a / m.area_b
    gas_work, heat = m.adiabatic - 1.0, m.gas_constant * m.temperature
    room_a, room_b = m.volume_a + m.area_a * y, m.volume_b - m.area_b * y
    values = {
        "y": y,
        "bristle": -m.atmosphere * (m.area_a - m.area_b) / m.static,
        "energy_a": p_a * room_a / gas_work,
        "energy_b": p_b * room_b / gas_work,
        "gas_a": p_a * room_a / heat,
        "gas_b": p_b * room_b / heat,
        "supply": m.supply,
        "load_y": y,
        "age": 5.0,
    }
    return np.array([values.get(name, 0.0) for name in STATES])


def run(
    m: Machine,
    rough: Roughness,
    x: ndarray,
    voltage: ndarray,
    wanted: ndarray | None = None,
    noise: ndarray | None = None,
    limit: float = np.inf,
    step: float = STEP,
    sample: float = SAMPLE,
) -> tuple[ndarray, ndarray]:
    """States (n, len(STATES)) at the start of each sample, and voltages applied (n,) [V]; see `integrate`.

    `x` (len(STATES),) is the state at the start, `limit` [m] where the voltage turns inwards. A `sample` [s]
    is divided into steps of about `step` [s].
    """
    n = len(voltage)
    wanted = np.full(n, np.nan) if wanted is None else wanted
    noise = np.zeros(n) if noise is None else noise
    out, applied = np.empty((n, len(STATES))), np.empty(n)
    voltage, steps = np.array(voltage, dtype=float), round(sample / step)
    integrate(packed(m), rough, x.copy(), voltage, wanted, noise, limit, steps, sample, out, applied)
    return out, applied


def readings(m: Machine, states: ndarray) -> ndarray:
    """(n, 5): y [m], v [m/s], p_a, p_b [Pa], bristle deflection z [m] of states (n, len(STATES))."""
    y, v, bristle, energy_a, energy_b = states[:, :5].T
    p_a = (m.adiabatic - 1.0) * energy_a / (m.volume_a + m.area_a * y)
    p_b = (m.adiabatic - 1.0) * energy_b / (m.volume_b - m.area_b * y)
    return np.column_stack([y, v, p_a, p_b, bristle * m.static / m.bristle])
