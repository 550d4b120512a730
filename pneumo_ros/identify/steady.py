"""Detection of stretches of constant velocity and constant pressures."""

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import SIDES
from pneumo_ros.runs.noise import noise_level
from pneumo_ros.runs.run import Run
from pneumo_ros.units import shown

Array = NDArray[np.float64]

WINDOW = 0.25  # s
TRAVEL = 5e-4  # m: ten times the bristles' deflection, so that friction does not depend on the start of the motion
SPEED_CHANGE = 0.015  # of the speed, within a window: a larger change would bias the velocity
FORCE_CHANGE = 0.01  # of the drive force, within a window: with less the pressures count as constant
_EDGE = 2e-3  # m from the end of the stroke


@dataclass(frozen=True)
class Window:
    """One window of constant input: least-squares velocity, acceleration, mean pressures; used, or the refusal."""

    run: str
    start: float  # [s]
    stop: float
    input: float  # [V] or [N]
    position: float  # [m], mean
    velocity: float  # [m/s]
    acceleration: float  # [m/s2]
    pressure_a: float  # [Pa], mean; NaN for a side that is no chamber
    pressure_b: float
    slope_a: float  # [Pa/s]
    slope_b: float
    friction: float  # [N], drive - load - M a
    friction_noise: float  # [N], standard deviation by sensor noise
    velocity_noise: float  # [m/s], likewise
    slope_noise: float  # [Pa/s], likewise, of either chamber; NaN when force-driven
    reason: str  # why it is refused, in the same words for every such window; empty when used
    refused: str  # the same with its figures
    further: tuple[float, ...] = ()  # means of the model's other inputs, in their order

    @property
    def used(self) -> bool:
        """Whether the window is a point of the static map."""
        return not self.refused


def find_windows(model: Model, run: Run, window: float = WINDOW) -> list[Window]:
    """Cut every interval of constant voltage into windows of `window` [s] and judge each.

    A measured force is never quite constant: there all windows are judged.
    """
    width = max(round(window / run.sample_time), 8)
    edges = np.flatnonzero(np.diff(run.held) != 0.0) + 1 if not model.force_driven else np.empty(0, dtype=np.int64)
    bounds = np.concatenate([[0], edges, [len(run) - 1]])
    starts = [s for a, b in itertools.pairwise(bounds) for s in range(int(a), int(b) - width + 1, width)]
    if not starts:
        return []
    return _judge(model, run, np.array(starts), width)


def _judge(model: Model, run: Run, starts: NDArray[np.int64], width: int) -> list[Window]:
    rows = starts[:, None] + np.arange(width + 1)
    time: Array = np.asarray((np.arange(width + 1) - 0.5 * width) * run.sample_time, dtype=np.float64)
    motion = np.polynomial.polynomial.polyfit(time, run.position[rows].T, 2)  # (3, windows)
    lines = {chamber.side: _line(time, run.signals[chamber.signal], rows) for chamber in model.chambers}
    a, b = (lines.get(side, np.full((2, len(rows)), np.nan)) for side in SIDES)
    position, velocity, acceleration = motion[0], motion[1], 2.0 * motion[2]
    held = run.held[rows[:, :-1]].mean(axis=1) if model.force_driven else run.held[starts]
    inputs = run.sampled(model.inputs)[rows[:, :-1]].mean(axis=1)
    drive, load, swing = _forces(model, position, velocity, lines, inputs)
    noise = _noise(model, run, width)
    friction = drive - load - moving_mass(model) * acceleration
    span = width * run.sample_time
    refused = _reasons(model, run, rows, position, velocity, acceleration * span, swing * span, drive - load)
    return [
        Window(
            run=run.name,
            start=float(s * run.sample_time),
            stop=float((s + width) * run.sample_time),
            input=float(held[i]),
            position=float(position[i]),
            velocity=float(velocity[i]),
            acceleration=float(acceleration[i]),
            pressure_a=float(a[0, i]),
            pressure_b=float(b[0, i]),
            slope_a=float(a[1, i]),
            slope_b=float(b[1, i]),
            friction=float(friction[i]),
            friction_noise=noise[0],
            velocity_noise=noise[1],
            slope_noise=noise[2],
            reason=refused[i][0],
            refused=refused[i][1],
            further=tuple(inputs[i, 1:].tolist()),
        )
        for i, s in enumerate(starts)
    ]


def _line(time: Array, signal: Array, rows: NDArray[np.int64]) -> Array:
    # A least-squares slope of position is the velocity's mean under a parabola; pressures are averaged likewise, so
    # that changes during a window do not bias the force against the velocity.
    weight = 1.0 - (time / (time[-1] + time[1] - time[0])) ** 2
    mean = signal[rows] @ weight / weight.sum()
    return np.stack([mean, np.polynomial.polynomial.polyfit(time, signal[rows].T, 1)[1]])


def _forces(
    model: Model, position: Array, velocity: Array, lines: Mapping[str, Array], held: Array
) -> tuple[Array, Array, Array]:
    """Drive and load force [N] at each window's mean, and the rate of change of the drive force [N/s]."""
    states = np.tile(model.state(), (len(position), 1))
    states[:, 0], states[:, 1] = position, velocity
    swing = np.zeros(len(position))
    for chamber in model.chambers:
        pressure, slope = lines[chamber.side]
        states[:, model.states.index(chamber.state)] = pressure
        swing += chamber.way * model[chamber.area] * slope
    seen = model.outputs(states, held)
    return seen["drive"], seen["force"], swing


def _noise(model: Model, run: Run, width: int) -> tuple[float, float, float]:
    """Deviations by sensor noise of a window's friction force [N], velocity [m/s] and pressure slope [Pa/s]."""
    noise, span = run.noise, width * run.sample_time
    parts = [moving_mass(model) * noise["position_m"] * np.sqrt(720.0 / width) / span**2]  # of a parabola's curvature
    for chamber in model.chambers:
        parts.append(model[chamber.area] * noise[chamber.signal] * np.sqrt(1.2 / width))
    if model.force_driven and not model.self_driven:
        parts.append(noise_level(run.force) * np.sqrt(1.0 / width))
    slope = np.sqrt(12.0 / width) / span  # of a line through white noise of unit size
    steepest = max((noise[chamber.signal] for chamber in model.chambers), default=np.nan)
    return float(np.sqrt(np.sum(np.square(parts)))), float(noise["position_m"] * slope), float(steepest * slope)


def _reasons(
    model: Model, run: Run, rows: NDArray[np.int64], position: Array, velocity: Array, speed_change: Array,
    force_change: Array, force: Array,
) -> list[tuple[str, str]]:  # fmt: skip
    """Reason, and reason with figures, of each window; empty for used windows."""
    span = (rows.shape[1] - 1) * run.sample_time
    speed, edge = np.abs(velocity), 0.5 * model["piston.stroke"] - _EDGE
    tests: tuple[tuple[str, Any, Callable[[int], str]], ...] = (
        ("a gap in the recording", ~run.measured[rows].all(axis=1), lambda i: ""),
        ("at the end of the stroke", np.abs(run.position[rows]).max(axis=1) > edge, lambda i: ""),
        ("the piston rests or creeps", speed * span < TRAVEL, lambda i: f" ({1e3 * speed[i]:.2f} {shown('mm/s')})"),
        (
            "the velocity changes",
            np.abs(speed_change) > SPEED_CHANGE * speed,
            lambda i: f" by {100 * abs(speed_change[i]) / speed[i]:.0f} % in {span:.2g} s",
        ),
        (
            "the pressures still change the force",
            np.abs(force_change) > FORCE_CHANGE * np.abs(force),
            lambda i: f" by {abs(force_change[i]):.1f} {shown('N')} in {span:.2g} s",
        ),
    )
    found = (((why, why + words(i)) for why, bad, words in tests if bad[i]) for i in range(len(rows)))
    return [next(one, ("", "")) for one in found]
