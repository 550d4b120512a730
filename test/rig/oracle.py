"""The base machine to many digits: the equations of `axis` through scipy's stiff solvers."""

import itertools
from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import solve_ivp

from .axis import PARAMETERS, Axis, PlainLuGre

__all__ = ["COLUMNS", "PARAMETERS", "push", "simulate"]

COLUMNS = ("y", "v", "p_a", "p_b", "z")
_ERROR_SCALE = np.array([1e-3, 1e-2, 1e5, 1e5, 10.0])  # atol = rtol times this, by component of the state
_LONGEST_STEP = 2e-3  # s: no reversal, no touch of an end stop is jumped over


def simulate(
    parameters: Mapping[str, float],
    voltage: np.ndarray,
    state: Mapping[str, float],
    sample_time: float,
    rtol: float = 1e-9,
    method: str = "LSODA",
) -> np.ndarray:
    """Simulate the base machine; voltage[k] [V] is held during sample k of length sample_time [s].

    `parameters` override PARAMETERS. `state` gives y [m], v [m/s], p_a, p_b [Pa abs], z [m] at the start of sample 0;
    missing ones are zero, pressures atmospheric. Returns (n, 5): the COLUMNS at the END of each sample. The
    solver restarts at every change of the voltage. `method` names a solver of scipy's solve_ivp; at rtol = 1e-10 LSODA,
    Radau and DOP853 agree within 1e-10 m and 1e-5 Pa. Raises KeyError for an unknown name, RuntimeError if the solver
    gives up.
    """
    axis, voltage = Axis(parameters), np.asarray(voltage, dtype=float)
    x, out = _pack(axis, state), np.empty((len(voltage), len(COLUMNS)))
    for first, end in _holds(voltage):
        opening = axis.opening(float(voltage[first]))
        ends = sample_time * np.arange(1, end - first + 1)
        out[first:end] = _solve(lambda _, x, phi=opening: axis.rates(x, phi), x, ends, rtol, method)
        x = out[end - 1]
    return _unpack(axis, out)


def push(
    parameters: Mapping[str, float],
    force: Callable[[float], float],
    times: np.ndarray,
    rtol: float = 1e-9,
    plain_lugre: bool = False,
) -> np.ndarray:
    """Push mass and friction alone, from rest, by `force` [N] of time [s]; no gas, no end stops.

    `plain_lugre` lets the bristle yield under any load (alpha = 1). Returns (n, 3): y [m], v [m/s], z [m] at `times`
    [s] after the start.
    """
    axis = (PlainLuGre if plain_lugre else Axis)(parameters)

    def rates(t: float, x: np.ndarray) -> list[float]:
        _, v, w = (float(value) for value in x)
        return [v, (force(t) - axis.friction(v, w)) / axis.p["mass"], axis.bristle_rate(v, w)]

    x = _solve(rates, np.zeros(3), times, rtol, "LSODA", 1e-3 * _ERROR_SCALE[[0, 1, 4]])
    return x / np.array([1.0, 1.0, axis.p["bristle_stiffness"]])


def _solve(
    rates: Callable[[float, np.ndarray], list[float]],
    start: np.ndarray,
    times: np.ndarray,
    rtol: float,
    method: str,
    scale: np.ndarray = _ERROR_SCALE,
) -> np.ndarray:
    span = (0.0, float(times[-1]))
    run = solve_ivp(rates, span, start, method, times, rtol=rtol, atol=rtol * scale, max_step=_LONGEST_STEP)
    if not run.success:
        raise RuntimeError(f"{method} gave up at {run.t[-1] if len(run.t) else 0.0} s: {run.message}")
    return run.y.T


def _holds(voltage: np.ndarray) -> list[tuple[int, int]]:
    edges = [0, *(np.flatnonzero(np.diff(voltage)) + 1).tolist(), len(voltage)]
    return list(itertools.pairwise(edges))


def _pack(axis: Axis, state: Mapping[str, float]) -> np.ndarray:
    unknown = set(state) - set(COLUMNS)
    if unknown:
        raise KeyError(f"unknown states {sorted(unknown)}; known: {COLUMNS}")
    y, atmosphere = state.get("y", 0.0), axis.p["atmospheric_pressure"]
    unit_a, unit_b = axis.pressures(y, 1.0, 1.0)
    s_a, s_b = state.get("p_a", atmosphere) / unit_a, state.get("p_b", atmosphere) / unit_b
    return np.array([y, state.get("v", 0.0), s_a, s_b, axis.p["bristle_stiffness"] * state.get("z", 0.0)])


def _unpack(axis: Axis, x: np.ndarray) -> np.ndarray:
    p = np.array([axis.pressures(*row) for row in x[:, [0, 2, 3]]]).reshape(-1, 2)
    return np.column_stack([x[:, :2], p, x[:, 4] / axis.p["bristle_stiffness"]])
