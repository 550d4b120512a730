"""Breakaways: the force at which a resting piston begins to slide."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import resting_states
from pneumo_ros.plant import Model
from pneumo_ros.runs.noise import noise_level
from pneumo_ros.runs.rests import REST
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.smooth import smooth

Array = NDArray[np.float64]

SCATTER, UNSEEN = 0.2, 0.02  # N between breakaways under a slow force; s until sliding is detected
_EDGE = 2e-3  # m from the end of the stroke
_CHUNK = 2000  # samples searched at a time
_SLIP = 5.0  # times the largest bristle deflection: certainly sliding
_APART = 2.0  # deviations between slopes over a shorter and a longer time that show a bend and not noise


@dataclass(frozen=True)
class Breakaway:
    """One breakaway: when, in which direction, and the largest force that friction held just before [N]."""

    run: str
    index: int  # grid point where sliding is certain
    time: float
    direction: int
    force: float
    ramp: float  # [N/s], how fast the force rose just before
    rest: float  # [s] at rest before
    slip: float  # [m] from where it rested to where sliding is certain

    @property
    def spread(self) -> float:
        """Uncertainty of the force [N], when the time until the slip was detected is not computed."""
        return float(force_spread(self.ramp))


def force_spread(ramp: float | Array, unsure: float = UNSEEN) -> float | Array:
    """Uncertainty of the force at a breakaway [N]: 0.2 N, plus its rise `ramp` [N/s] before sliding is detected.

    Identification, diagnosis and planning all use this noise model. `unsure` [s]: uncertainty of the moment at which
    sliding began.
    """
    return SCATTER + unsure * np.abs(ramp)


def find_breakaways(model: Model, run: Run) -> list[Breakaway]:
    """Every breakaway after a rest of at least 0.15 s, away from the ends of the stroke."""
    deflection = model["lugre_friction.static_friction"] / model["lugre_friction.bristle_stiffness"]
    slip = _SLIP * deflection + 6.0 * run.noise["position_m"]
    rest, found, k = max(round(REST / run.sample_time), 2), [], 0
    raw, y = _balance(model, run), run.position
    force, noise = _smoothed(raw, run), noise_level(raw)
    while k + rest < len(y):
        here = float(np.median(y[k : k + rest]))
        if np.max(np.abs(y[k : k + rest] - here)) > slip:
            k += max(rest // 4, 1)
            continue
        at = _leaves(y, k + rest, here, slip)
        if at is None:
            break
        if abs(here) < 0.5 * model["piston.stroke"] - _EDGE and run.measured[k : at + 1].all():
            direction = 1 if y[at] > here else -1
            before = slice(max(at - rest, 0), at + 1)
            ramp = direction * last_slope(raw[before], run.sample_time, noise)
            held, rested = float((direction * force[before]).max()), (at - k) * run.sample_time
            time = at * run.sample_time
            found.append(Breakaway(run.name, at, time, direction, held, ramp, rested, slip))
        k = at
    return found


def last_slope(signal: Array, sample_time: float, noise: float) -> float:
    """Slope at the end of a signal (n,) with white noise of standard deviation `noise`, in its unit per s.

    Over the last 20 ms, or as much longer as the slopes over longer times agree with the shorter ones within their
    noise: the intersection of confidence intervals (Goldenshluger and Nemirovski 1997). A mean over 0.15 s is several
    times too low after a step of the command, and 20 ms alone are noisy where the force rises slowly.
    """
    least, samples = max(round(UNSEEN / sample_time), 3) + 1, len(signal)
    doubled = (least << k for k in range(samples.bit_length()))
    low, high, found = -np.inf, np.inf, 0.0
    for width in (*(width for width in doubled if width < samples), samples):
        last = signal[-width:]
        time = (np.arange(width) - 0.5 * (width - 1)) * sample_time
        square = max(float(time @ time), 1e-300)
        slope, unsure = float(time @ last) / square, _APART * noise / np.sqrt(square)
        low, high = max(low, slope - unsure), min(high, slope + unsure)
        if low > high:
            break
        found = slope
    return found


def _leaves(y: Array, start: int, here: float, slip: float) -> int | None:
    """First grid point from `start` on that is farther than `slip` from `here`."""
    for k in range(start, len(y), _CHUNK):
        away = np.abs(y[k : k + _CHUNK] - here) > slip
        if away.any():
            return k + int(np.argmax(away))
    return None


def holding_force(model: Model, run: Run) -> Array:
    """Force on the piston (n,) [N] without friction and inertia; friction balances it while the piston rests."""
    return _smoothed(_balance(model, run), run)


def _balance(model: Model, run: Run) -> Array:
    """The same with the noise of the sensors."""
    seen = model.outputs(resting_states(model, run), run.sampled(model.inputs))
    return np.asarray(seen["drive"] - seen["force"])


def _smoothed(force: Array, run: Run) -> Array:
    return smooth(force, run.sample_time, 0.008, 2)
