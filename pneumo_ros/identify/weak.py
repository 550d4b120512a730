"""Residuals of the model's equations along the measured signals, in weak form: nothing measured is differentiated.

Each equation is multiplied by a smooth bump phi(t) = (1 - tau^2)^6 and integrated by parts over a short window:

    momentum:  (1 / I) int (phi'' M y - phi M v'_model) dt   [N]
    chamber:   (1 / I) int (-phi' L - phi (p'/p + gamma V'/V)_model) dt  p V / (gamma R T)   [kg/s]

with I = int phi and L = ln p + gamma ln V. The chamber's form needs no velocity:
the model's p'/p + gamma V'/V is gamma R T q / (p V). The momentum's friction does, and what the noise of an estimated
velocity does to it, int phi (dv'/dv) dy = -int (phi dv'/dv)' dy, is part of the noise stated with each residual.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.bump import Bump
from pneumo_ros.identify.guess import smoothed
from pneumo_ros.identify.noise import noise_level, run_noise
from pneumo_ros.identify.run import Run, check_position
from pneumo_ros.identify.sensors import driven
from pneumo_ros.identify.smooth import smooth
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

MOMENTUM_WINDOW, CHAMBER_WINDOW = 0.1, 0.2  # s
FORCE_WINDOW = 0.02  # s: little more than the sampling, so that the error is that of the force itself
SLIDING = 0.01  # m/s: slower, friction is not a function of velocity and the momentum equation says little
# How coarse sums over samples are, measured on simulations without noise at 50 Hz to 4 kHz; see `Bump.coarseness`
_MOMENTUM_SUMS, _CHAMBER_SUMS = 0.12, 4.0


@dataclass(frozen=True)
class Residual:
    """Residual of one equation in consecutive windows: what is measured minus what the model claims."""

    equation: str  # momentum, chamber_a or chamber_b
    unit: str
    time: Array  # (windows,) centres [s]
    value: Array  # (windows,) in `unit`
    noise: Array  # (windows,) standard deviation that sensor noise and sums over samples alone give, in `unit`

    @property
    def rms(self) -> float:
        """Root mean square of the residual."""
        return float(np.sqrt(np.mean(self.value**2))) if len(self.value) else float("nan")

    @property
    def ratio_to_noise(self) -> float:
        """Root mean square of residual over noise: 1 where noise alone explains it."""
        return float(np.sqrt(np.mean((self.value / self.noise) ** 2))) if len(self.value) else float("nan")


def equation_residuals(model: Model, run: Run) -> dict[str, Residual]:
    """Residuals of momentum and, with chambers, of both chambers along a run, by equation name.

    There are no windows where there is nothing to judge: no sliding for the momentum, a run shorter than a window.
    Raises DataError when the run leaves the stroke of the model.
    """
    check_position(model, run)
    states, claimed = _along(model, run)
    noise = run_noise(run)
    result = {"momentum": _momentum(model, run, states, claimed, noise)}
    if not model.force_driven:
        for chamber in ("a", "b"):
            result[f"chamber_{chamber}"] = _chamber(model, run, states, claimed, noise, chamber)
    return result


def force_error(model: Model, run: Run) -> float:
    """Relative force error in percent: |measured - modelled driving force| / |measured|, both averaged over 20 ms.

    The figure that identification of drives is judged by (inverse dynamics, Gautier and Khalil); it takes rest and
    reversals in, unlike the residuals.
    """
    bump = Bump.of(FORCE_WINDOW, run.sample_time)
    states, claimed = _along(model, run)
    mass = model["piston.mass"]
    drive = np.append(run.held, run.held[-1]) if model.force_driven else model.outputs(states)["drive"]
    error = mass * (bump.apply(bump.second, states[:, 0]) - bump.apply(bump.phi, claimed[:, 1]))
    inside = bump.apply(np.ones(bump.width), (~run.measured).astype(float)) < 0.5
    return float(100.0 * np.linalg.norm(error[inside]) / np.linalg.norm(bump.apply(bump.phi, drive)[inside]))


def _along(model: Model, run: Run) -> tuple[Array, Array]:
    """States and claimed derivatives (n, states) along the measured signals, what sensors do taken back."""
    frame = smoothed(run).frame[:, : 2 if model.force_driven else 4].copy()
    for column, signal in zip((0, 2, 3), run.signals.values(), strict=False):
        if column < frame.shape[1]:
            frame[:, column] = signal
    states, mean = driven(model, frame, run)
    # the mean of the intervals on both sides of a sample: a sum over samples is then the integral, input steps and all
    return states, 0.5 * (mean + np.append(mean[1:], mean[-1:], axis=0))


def _momentum(model: Model, run: Run, states: Array, claimed: Array, noise: dict[str, float]) -> Residual:
    bump = Bump.of(MOMENTUM_WINDOW, run.sample_time)
    mass = model["piston.mass"]
    moving = mass + model.outputs(states, np.append(run.held, run.held[-1]))["added_mass"][bump.centres(len(run))]
    value = moving * (bump.apply(bump.second, states[:, 0]) - bump.apply(bump.phi, claimed[:, 1]))
    ones = np.ones(len(run))
    by_velocity = _sensitivity(model, run, states, 1, 1e-3)[:, 1]
    parts = [noise["position_m"] * mass * bump.noise([(bump.second, ones), (bump.first, by_velocity)])]
    if model.force_driven:
        parts.append(noise_level(run.force) * bump.noise([(bump.phi, ones)]))
        drive = np.append(run.held, run.held[-1])
    else:
        for area, name in (("area_a", "pressure_a_pa"), ("area_b", "pressure_b_pa")):
            parts.append(noise[name] * model[f"piston.{area}"] * bump.noise([(bump.phi, ones)]))
        drive = model.effort(states)
    parts.append(bump.coarseness(_MOMENTUM_SUMS) * np.sqrt(bump.apply(bump.phi, drive**2)))
    slow = np.abs(smooth(run.position, run.sample_time, 0.012, 3, 1)) < SLIDING
    usable = (bump.apply(np.ones(bump.width), (slow | ~run.measured).astype(float)) < 0.5) & _inside(model, run, bump)
    return _residual("momentum", "N", run, bump, value, np.sqrt(np.sum(np.square(parts), axis=0)), usable)


def _inside(model: Model, run: Run, bump: Bump) -> NDArray[np.bool_]:
    reach = 0.5 * model["piston.stroke"] - 1e-3
    return np.asarray(bump.apply(np.ones(bump.width), (np.abs(run.position) > reach).astype(float)) < 0.5)


def _chamber(model: Model, run: Run, states: Array, claimed: Array, noise: dict[str, float], chamber: str) -> Residual:
    bump = Bump.of(CHAMBER_WINDOW, run.sample_time)
    column = model.states.index(f"p_{chamber}")
    gamma = model["air.heat_capacity_ratio"]
    slope = model["piston.area_a"] if chamber == "a" else -model["piston.area_b"]
    p, volume = states[:, column], model[f"chambers.volume_{chamber}"] + slope * states[:, 0]
    rate = claimed[:, column] / p + gamma * slope * states[:, 1] / volume
    steep = _sensitivity(model, run, states, column, 100.0)[:, column] / p - claimed[:, column] / p**2
    content = p * volume / (gamma * model["air.gas_constant"] * model["air.temperature"])  # kg per unit of L
    scale = bump.apply(bump.phi, content)
    value = scale * (bump.apply(-bump.first, np.log(p) + gamma * np.log(volume)) - bump.apply(bump.phi, rate))
    by_pressure = noise[f"pressure_{chamber}_pa"] * bump.noise([(-bump.first, 1.0 / p), (-bump.phi, steep)])
    by_position = noise["position_m"] * bump.noise([(-bump.first, gamma * slope / volume)])
    by_sums = bump.coarseness(_CHAMBER_SUMS) * np.sqrt(bump.apply(bump.phi, rate**2))
    usable = bump.apply(np.ones(bump.width), (~run.measured).astype(float)) < 0.5
    total = scale * np.sqrt(by_pressure**2 + by_position**2 + by_sums**2)
    return _residual(f"chamber_{chamber}", "kg/s", run, bump, value, total, usable)


def _sensitivity(model: Model, run: Run, states: Array, column: int, probe: float) -> Array:
    """Change of all derivatives (n, states) per unit of the state in `column`."""
    held = np.append(run.held, run.held[-1])
    pushed = states.copy()
    pushed[:, column] += probe
    change = model.derivatives(pushed, held, run.time) - model.derivatives(states, held, run.time)
    return np.asarray(change / probe)


def _residual(
    equation: str, unit: str, run: Run, bump: Bump, value: Array, noise: Array, usable: NDArray[np.bool_]
) -> Residual:
    centre = bump.apply(bump.phi, run.time)
    good = usable & np.isfinite(value)
    return Residual(equation, unit, centre[good], value[good], np.broadcast_to(noise, value.shape)[good])
