"""The weak form of a machine's equations by PySINDy: what the base model leaves of them, and the library's terms.

For each run and equation, `pysindy.WeakPDELibrary` integrates against its test functions what the base model leaves,
the changes of it by the base model's parameters, and the terms. Rows are divided by the noise of the sensors.
"""

import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from peer_signals import Array, Signals
from peer_terms import TERMS
from pysindy import AxesArray, PolynomialLibrary, WeakPDELibrary

from pneumo_ros.diagnose.basefit import Known
from pneumo_ros.equations.equations import SLIDING
from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.sensors import driven

HALF = {"momentum": 0.05, "chamber_a": 0.1, "chamber_b": 0.1}  # s: half of a window
PER_SECOND, POWER = 20, 6  # windows per second of a run; the test function is (1 - tau^2)^6


class Weak(NamedTuple):
    """Rows over noise: what is left (rows,), its slopes by base parameters per prior, and the terms (rows, terms)."""

    left: Array
    slopes: Array
    terms: Array


def weak_rows(model: Model, known: Known, runs: Sequence[Run]) -> Weak:
    """The rows of all runs and equations; base parameters `known` are free."""
    noise = _noise(model, runs)
    parts = [part for run in runs for part in _of_run(model, known, run, noise)]
    left, slopes, terms = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return Weak(left, slopes, terms)


def _noise(model: Model, runs: Sequence[Run]) -> dict[str, float]:
    """Usual noise of each equation [N, kg/s]."""
    found = [equation_residuals(model, run) for run in runs]
    return {name: float(np.median(np.concatenate([one[name].noise for one in found]))) for name in HALF}


def _of_run(model: Model, known: Known, run: Run, noise: Mapping[str, float]) -> list[Weak]:
    """The rows of each equation of one run."""
    signals, claims = Signals(model, run), [_claimed(model, run)]
    for name, step in zip(known.names, known.step, strict=True):
        claims.append(_claimed(model.with_parameters({name: model[name] + step}), run))
    found = []
    for equation, half in HALF.items():
        unit, bad, terms = _columns(signals, equation)
        left = np.stack([_remainder(signals, equation, claim) for claim in claims], axis=1)
        rates, means = _integrals(run, half, left, np.column_stack([unit, bad, *terms]))
        rows = means[:, 1] < 1e-3  # sliding, or measured, throughout
        scale = (means[:, :1] / noise[equation])[rows]
        rates, slopes = rates[rows] * scale, known.prior / known.step
        found.append(Weak(rates[:, 0], (rates[:, 1:] - rates[:, :1]) * slopes, means[rows, 2:] * scale))
    return found


def _claimed(model: Model, run: Run) -> Array:
    """Derivatives of v, p_a and p_b (n, 3) that the model claims along the measured signals."""
    rates = driven(model, measured_frame(run, model.chambers), run)[1]
    return np.asarray(rates[:, [model.states.index(name) for name in ("v", "p_a", "p_b")]])


def _remainder(s: Signals, equation: str, claimed: Array) -> Array:
    """A trajectory (n,) whose rate the model leaves: of velocity [m/s], or of the logarithm of a chamber's content."""
    if equation == "momentum":
        return np.asarray(s.v - np.cumsum(claimed[:, 0]) * s.dt)
    p, V, column, area = (s.p_a, s.V_a, 1, s.area_a) if equation == "chamber_a" else (s.p_b, s.V_b, 2, -s.area_b)
    rate = claimed[:, column] / p + s.gamma * area * s.v / V
    return np.asarray(np.log(p) + s.gamma * np.log(V) - np.cumsum(rate) * s.dt)


def _columns(s: Signals, equation: str) -> tuple[Array, Array, list[Array]]:
    """What turns the rate of `_remainder` into N or kg/s, where the equation does not hold, and the terms as rates."""
    lost, zero = ~s.run.measured, np.zeros(len(s.run))
    if equation == "momentum":
        reach, mass = 0.5 * s.model["piston.stroke"] - 1e-3, s.model["piston.mass"]
        bad = lost | (abs(s.v) < SLIDING) | (abs(s.y) > reach)
        return zero + mass, bad, [zero if term.force is None else term.force(s) / mass for term in TERMS]
    chamber = int(equation == "chamber_b")
    content = (s.p_b * s.V_b if chamber else s.p_a * s.V_a) / (s.gamma * s.R_T)
    return content, lost, [zero if term.inflow is None else term.inflow(s)[chamber] / content for term in TERMS]


def _integrals(run: Run, half: float, left: Array, columns: Array) -> tuple[Array, Array]:
    """Weak rates of `left` (windows, trajectories), and weak means of `columns` (windows, columns)."""
    np.random.seed(0)  # by which WeakPDELibrary places its windows
    warnings.filterwarnings("ignore", message=".*axes labeled")  # about arrays of its own
    count, identity = round(PER_SECOND * run.time[-1]), PolynomialLibrary(degree=1, include_bias=False)
    library = WeakPDELibrary(identity, spatiotemporal_grid=run.time, K=count, H_xt=half, p=POWER)
    axes = {"ax_time": 0, "ax_coord": 1}
    every = AxesArray(np.column_stack([np.ones(len(run)), columns]), axes)
    means = np.asarray(library.fit([every]).transform([every])[0])
    rates = np.asarray(library.convert_u_dot_integral(AxesArray(left, axes)))
    return rates / means[:, :1], means[:, 1:] / means[:, :1]
