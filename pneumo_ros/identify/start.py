"""The state at given instants of a recording: estimated with the model from the measurements around them.

A prediction started from smoothed signals alone is off by many times the noise even with the true parameters: what
decides when a stuck piston breaks away is the bristle's deflection, which no sensor shows. Here a short simulation is
fitted to the measurements before and after each instant, with its initial state free (Gauss-Newton with
Levenberg-Marquardt damping); where the measurements say nothing, the balance of forces does.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.noise import run_noise
from pneumo_ros.identify.run import PARTS, Run
from pneumo_ros.identify.smooth import noise_gain, smooth
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Index = NDArray[np.int64]

HALF_WIDTH = 0.012  # s, of the local polynomials that give first guesses
BEFORE, AFTER = 0.3, 0.1  # s, fitted before and after each instant: most of what the state follows from is its past
_ITERATIONS = 6
_FORCE = 1.0  # N, how far the balance of forces may be off


@dataclass(frozen=True)
class Smoothed:
    """First guesses along a whole run: measured states (n, 2 or 4) with smoothed velocity, and acceleration (n,)."""

    frame: Array
    acceleration: Array


def smoothed(run: Run) -> Smoothed:
    """Position, velocity, pressures and acceleration by local polynomials over +-12 ms."""
    dt, y = run.sample_time, run.position
    columns = [smooth(y, dt, HALF_WIDTH, 3), smooth(y, dt, HALF_WIDTH, 3, 1)]
    columns += [smooth(p, dt, HALF_WIDTH, 2) for p in (run.pressure_a, run.pressure_b) if p is not None]
    return Smoothed(np.stack(columns, axis=1), smooth(y, dt, 1.5 * HALF_WIDTH, 3, 2))


def first_guess(model: Model, run: Run, at: Index) -> Array:
    """States (len(at), states): measured ones smoothed, others driven along, bristles by balance of forces."""
    guess = smoothed(run)
    frame = guess.frame[:, : 2 if model.force_driven else 4]
    rest = model.state()[frame.shape[1] :]
    states, _ = model.follow(frame, run.held, rest, sample_time=run.sample_time)
    chosen: Array = states[at]
    if "z" in model.states:
        _balance(model, chosen, run.held[np.minimum(at, len(run.held) - 1)], guess.acceleration[at])
    return chosen


def _balance(model: Model, states: Array, held: Array, acceleration: Array) -> None:
    """Set the bristle deflection so that the model's acceleration is the measured one (two secant steps)."""
    z, v = model.states.index("z"), model.states.index("v")
    probe = 1e-6
    for _ in range(2):
        shifted = states.copy()
        shifted[:, z] += probe
        here, there = (model.derivatives(x, held)[:, v] for x in (states, shifted))
        slope = (there - here) / probe
        states[:, z] += np.where(slope != 0.0, (acceleration - here) / np.where(slope == 0.0, 1.0, slope), 0.0)
    limit = _deflection_limit(model)
    states[:, z] = np.clip(states[:, z], -limit, limit)


def _deflection_limit(model: Model) -> float:
    section = "lugre_friction"
    return model[f"{section}.static_friction"] / model[f"{section}.bristle_stiffness"]


def start_states(model: Model, run: Run, at: Index) -> Array:
    """States (len(at), states) of `model` at the grid points `at` of a run, fitted to the measurements around them."""
    before = round(BEFORE / run.sample_time)
    samples = min(before + round(AFTER / run.sample_time), len(run) - 1)
    begin = np.clip(at - before, 0, len(run) - 1 - samples)
    fit = _Fit(model, run, begin, samples)
    found = fit.solve(first_guess(model, run, begin))
    ahead = at - begin
    trajectory = fit.simulate(found)
    result: Array = found.copy()
    moved = ahead > 0
    result[moved] = trajectory[moved, ahead[moved] - 1]
    return result


class _Fit:
    """Least squares for the initial states of many short simulations at once; all perturbations run as lanes."""

    def __init__(self, model: Model, run: Run, begin: Index, samples: int) -> None:
        self.model, self.run, self.begin, self.samples = model, run, begin, samples
        noise = run_noise(run)
        signals = list(run.signals.items())[: 1 if model.force_driven else 3]
        rows = begin[:, None] + np.arange(1, samples + 1)
        self.measured = np.stack([signal[rows] for _, signal in signals], axis=2)  # (windows, samples, signals)
        self.sigma = np.array([noise[name] for name, _ in signals])
        self.columns = [0, *range(2, 2 + len(signals) - 1)]
        self.weight = run.measured[rows].astype(float)[:, :, None] / self.sigma
        self.scale = self._prior()

    def _prior(self) -> Array:
        """Standard deviation of each initial state about its first guess; also its unit in the fit."""
        dt, model = self.run.sample_time, self.model
        scale = np.array([max(abs(s), 1.0) * 0.1 for s in model.state()])
        scale[self.columns] = 3.0 * self.sigma
        scale[1] = 3.0 * self.sigma[0] * noise_gain(dt, HALF_WIDTH, 3, 1) + 1e-4
        if "z" in model.states:
            scale[model.states.index("z")] = _FORCE / model["lugre_friction.bristle_stiffness"]
        return scale

    def simulate(self, states: Array) -> Array:
        """(lanes, samples, states) from initial states (lanes, states), lanes a multiple of the windows."""
        copies = len(states) // len(self.begin)
        return self.model.simulate_lanes(
            self.run.input, states, samples=self.samples, first=np.tile(self.begin, copies) * PARTS,
            sample_time=self.run.sample_time, parts=PARTS,
        )  # fmt: skip

    def _residuals(self, states: Array, guess: Array) -> Array:
        """(windows, samples * signals + states), whitened; non-finite predictions count as very wrong."""
        windows = len(self.begin)
        copies = len(states) // windows
        predicted = self.simulate(states)[:, :, self.columns].reshape(copies, windows, self.samples, -1)
        error = ((predicted - self.measured) * self.weight).reshape(copies * windows, -1)
        prior = (states - np.tile(guess, (copies, 1))) / self.scale
        stacked = np.concatenate([error, prior], axis=1)
        return np.asarray(np.nan_to_num(stacked, nan=1e6, posinf=1e6, neginf=-1e6))

    def solve(self, guess: Array) -> Array:
        """Initial states (windows, states) of least whitened squares, starting from `guess`."""
        windows, n = guess.shape
        x: Array = guess.copy()
        damping = np.full(windows, 1e-3)
        residual = self._residuals(x, guess)
        for _ in range(_ITERATIONS):
            lanes = np.concatenate([x + step for step in np.diag(1e-2 * self.scale)])
            shifted = self._residuals(lanes, guess).reshape(n, windows, -1)
            jacobian = np.moveaxis((shifted - residual) / 1e-2, 0, 2)  # (windows, residuals, states)
            normal = np.swapaxes(jacobian, 1, 2) @ jacobian
            gradient = np.einsum("wrs,wr->ws", jacobian, residual)
            diagonal = np.einsum("wss->ws", normal)
            damped = normal + damping[:, None, None] * np.eye(n) * diagonal[:, None, :]
            candidate = x - np.linalg.solve(damped, gradient[:, :, None])[:, :, 0] * self.scale
            tried = self._residuals(candidate, guess)
            better = np.sum(tried**2, axis=1) < np.sum(residual**2, axis=1)
            x[better], residual[better] = candidate[better], tried[better]
            damping = np.where(better, damping * 0.2, damping * 10.0)
        return x
