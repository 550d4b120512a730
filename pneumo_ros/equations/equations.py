"""Equations of motion and of the chambers in weak form over windows: residual, its noise, usable windows.

Each equation is multiplied by a smooth bump phi(t) = (1 - tau^2)^6 and integrated by parts over a short window:

    momentum:  (1 / I) int (phi'' M y - phi M v'_model) dt   [N]
    chamber:   (1 / I) int (-phi' L - phi (p'/p + gamma V'/V)_model) dt  p V / (gamma R T)   [kg/s]

with I = int phi and L = ln p + gamma ln V. The chamber's form needs no velocity:
the model's p'/p + gamma V'/V is gamma R T q / (p V). The momentum's friction needs it; the effect of velocity noise,
int phi (dv'/dv) dy = -int (phi dv'/dv)' dy, is part of the noise of each residual.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.bump import Bump
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.runs.noise import noise_level
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.smooth import smooth

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

SLIDING = 0.01  # m/s: below, friction is not a function of velocity and the momentum equation is not usable
# Errors of sums over samples, measured on simulations without noise at 50 Hz to 4 kHz; see `Bump.coarseness`
_MOMENTUM_SUMS, _CHAMBER_SUMS = 0.08, 0.05


def centred(mean: Array) -> Array:
    """Mean derivatives (n, ...) of the intervals on both sides of a sample, from those of the interval before each.

    A sum over samples is then the integral, with input steps included.
    """
    return np.asarray(0.5 * (mean + np.append(mean[1:], mean[-1:], axis=0)))


def straight(function: Callable[..., Array], *signals: Array) -> Array:
    """Mean (n,) of a function of signals (n,) that are straight between samples, over the interval before each.

    By Simpson's rule; the first value repeats the second, as no interval ends there.
    """
    middle = function(*(0.5 * (signal[1:] + signal[:-1]) for signal in signals))
    ends = function(*signals)
    mean = (ends[1:] + 4.0 * middle + ends[:-1]) / 6.0
    return np.append(mean[:1], mean)


def moving_mass(model: Model) -> float:
    """Mass that moves with the piston at once [kg]: its own, and what effects add at rest."""
    return model["piston.mass"] + added_mass(model)


def added_mass(model: Model) -> float:
    """The part of it that effects add [kg]."""
    return float(model.outputs(model.state()[None])["added_mass"][0])


def drive_along(model: Model, run: Run, states: Array) -> Array:
    """Drive force (n,) [N] along states (n, states) of a run: measured, by the chambers, or as effects compute it."""
    if model.self_driven:
        return model.outputs(states, run.sampled(model.inputs), sample_time=run.sample_time)["drive"]
    return np.append(run.held, run.held[-1]) if model.force_driven else model.effort(states)


class Momentum:
    """The momentum equation of a model along states (n, states) of a run; values in N."""

    def __init__(self, model: Model, run: Run, states: Array) -> None:
        self.model, self.run = model, run
        self._steep = sensitivity(model, run, states, model.states.index("v"), 1e-3)[:, model.states.index("v")]
        self._drive = drive_along(model, run, states)

    @staticmethod
    def value(bump: Bump, mass: Array, position: Array, acceleration: Array) -> Array:
        """Residual (windows,): `mass` (windows,) [kg] moves as measured, and as claimed.

        acceleration (n,): claimed, the mean over the interval before each sample.
        """
        return MeasuredMotion.of(bump, position).value(mass, acceleration)

    def noise(self, bump: Bump) -> Array:
        """Standard deviation (windows,) by sensor noise and by the error of sums over samples."""
        model, run, noise = self.model, self.run, self.run.noise
        ones = np.ones(len(run))
        parts = [self.noise_by_position(bump)]
        if model.force_driven and not model.self_driven:
            parts.append(noise_level(run.force) * bump.noise([(bump.phi, ones)]))
        else:
            for chamber in model.chambers:
                parts.append(noise[chamber.signal] * model[chamber.area] * bump.noise([(bump.phi, ones)]))
        parts.append(bump.coarseness(_MOMENTUM_SUMS) * np.sqrt(bump.apply(bump.phi, self._drive**2)))
        return np.asarray(np.sqrt(np.sum(np.square(parts), axis=0)))

    def noise_by_position(self, bump: Bump) -> Array:
        """Standard deviation (windows,) by the noise of the position alone, in acceleration and friction."""
        by_position = bump.noise([(bump.second, np.ones(len(self.run))), (bump.first, self._steep)])
        return np.asarray(self.run.noise["position_m"] * moving_mass(self.model) * by_position)

    def noise_by_acceleration(self, bump: Bump) -> Array:
        """The part (windows,) of it that is in proportion to the moving mass."""
        by_position = bump.noise([(bump.second, np.ones(len(self.run)))])
        return np.asarray(self.run.noise["position_m"] * moving_mass(self.model) * by_position)

    def usable(self, bump: Bump) -> Mask:
        """Windows with sliding and measurement throughout, away from the ends of the stroke."""
        run, reach = self.run, 0.5 * self.model["piston.stroke"] - 1e-3
        velocity = smooth(run.position, run.sample_time, 0.012, 3, 1)
        turns = np.append(velocity[1:] * velocity[:-1] < 0.0, False)  # a light piston turns between two samples
        slow = (np.abs(velocity) < SLIDING) | turns
        return _free_of(slow | ~run.measured | (np.abs(run.position) > reach), bump)


class Balance:
    """The mass balance of one chamber along states (n, states) of a run; values in kg/s."""

    def __init__(self, model: Model, chamber: Chamber) -> None:
        self.model, self.chamber = model, chamber
        self.column = model.states.index(chamber.state)
        self.gamma = model["air.heat_capacity_ratio"]
        self._slope = chamber.way * model[chamber.area]

    def volume(self, position: Array) -> Array:
        """Volume (n,) [m3]."""
        return self.model[self.chamber.volume] + self._slope * position

    def value(self, bump: Bump, states: Array, pressure_rate: Array) -> Array:
        """Residual (windows,), with the pressure derivative (n,) that the model claims along the states.

        It is the mean over the interval before each sample.
        """
        return self.measured(bump, states).value(pressure_rate)

    def measured(self, bump: Bump, states: Array) -> "MeasuredChamber":
        """The part of the residual that depends on the states alone."""
        p = states[:, self.column]
        log = np.log(p) + self.gamma * np.log(self.volume(states[:, 0]))
        # What the claim holds of the smoothed velocity is taken off as it was claimed, along the same straight lines.
        per_pressure = straight(np.reciprocal, p)
        squeezed = straight(self._squeezed, states[:, 0], states[:, 1], p)
        rate = bump.apply(-bump.first, log) - bump.means(squeezed, per_pressure)
        return MeasuredChamber(bump, self.column, self._content(bump, states), rate, per_pressure)

    def noise(self, bump: Bump, run: Run, states: Array, pressure_rate: Array, steep: Array) -> Array:
        """Standard deviation (windows,) by sensor noise and by the error of sums.

        `steep` (n,): derivative of the claimed pressure derivative by the pressure.
        """
        noise, p = run.noise, states[:, self.column]
        by_log = steep / p - pressure_rate / p**2
        by_volume = self.gamma * self._slope / self.volume(states[:, 0])
        parts = [
            noise[self.chamber.signal] * bump.noise([(-bump.first, 1.0 / p), (-bump.phi, by_log)]),
            noise["position_m"] * bump.noise([(-bump.first, by_volume)]),
            bump.coarseness(_CHAMBER_SUMS) * np.sqrt(bump.apply(bump.phi, self._rate(states, pressure_rate) ** 2)),
        ]
        return np.asarray(self._content(bump, states) * np.sqrt(np.sum(np.square(parts), axis=0)))

    def steepness(self, run: Run, states: Array) -> Array:
        """Derivative (n,) of the claimed pressure derivative by the pressure [1/s]."""
        return np.asarray(sensitivity(self.model, run, states, self.column, 100.0)[:, self.column])

    def _rate(self, states: Array, pressure_rate: Array) -> Array:
        flow = self.gamma * self._slope * states[:, 1] / self.volume(states[:, 0])
        return np.asarray(pressure_rate / states[:, self.column] + flow)

    def _squeezed(self, position: Array, velocity: Array, pressure: Array) -> Array:
        """By how much the pressure (n,) falls [Pa/s] because the volume grows, without heat."""
        return np.asarray(self.gamma * self._slope * velocity * pressure / self.volume(position))

    def _content(self, bump: Bump, states: Array) -> Array:
        """Mass per unit of ln p (windows,) [kg]."""
        R_T = self.model["air.gas_constant"] * self.model["air.temperature"]
        return bump.apply(bump.phi, states[:, self.column] * self.volume(states[:, 0]) / (self.gamma * R_T))


@dataclass(frozen=True)
class MeasuredMotion:
    """The measured motion in windows, independent of a model; acceleration (windows,) [m/s2]."""

    bump: Bump
    acceleration: Array

    @classmethod
    def of(cls, bump: Bump, position: Array) -> "MeasuredMotion":
        """From a position (n,) [m]."""
        return cls(bump, bump.apply(bump.second, position))

    def value(self, mass: Array | float, acceleration: Array) -> Array:
        """Residual (windows,) [N] of `mass` (windows,) [kg], with the acceleration (n,) that a model claims.

        The mass may be the same in all windows. The claim is the mean over the interval before each sample.
        """
        return np.asarray(mass * (self.acceleration - self.bump.means(acceleration)))


@dataclass(frozen=True)
class MeasuredChamber:
    """The measured state of a chamber in windows, independent of a model's claims.

    column: of its pressure among the states; content (windows,): mass per unit of ln p [kg]; rate (windows,): of inflow
    per content [1/s]; per_pressure (n,): mean of 1 / p [1/Pa] over the
    interval before each sample.
    """

    bump: Bump
    column: int
    content: Array
    rate: Array
    per_pressure: Array

    def value(self, pressure_rate: Array) -> Array:
        """Residual (windows,) [kg/s], with the pressure derivative (n,) that a model claims.

        The claim is the mean over the interval before each sample.
        """
        return np.asarray(self.content * (self.rate - self.bump.means(pressure_rate, self.per_pressure)))


def measured_throughout(run: Run, bump: Bump) -> Mask:
    """Windows without a gap in the recording."""
    return _free_of(~run.measured, bump)


def sensitivity(model: Model, run: Run, states: Array, column: int, probe: float) -> Array:
    """Change of all derivatives (n, states) per unit of the state in `column`."""
    held = run.sampled(model.inputs)
    pushed = states.copy()
    pushed[:, column] += probe
    change = model.derivatives(pushed, held, run.time) - model.derivatives(states, held, run.time)
    return np.asarray(change / probe)


def _free_of(bad: Mask, bump: Bump) -> Mask:
    return np.asarray(bump.apply(np.ones(bump.width), bad.astype(float)) < 0.5)
