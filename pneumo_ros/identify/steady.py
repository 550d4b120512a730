"""Detection of stretches of constant velocity and constant pressures."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.equations import moving_mass
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

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
    pressure_a: float  # [Pa], mean; NaN when force-driven
    pressure_b: float
    slope_a: float  # [Pa/s]
    slope_b: float
    friction: float  # [N], drive - load - M a
    friction_noise: float  # [N], standard deviation by sensor noise
    velocity_noise: float  # [m/s], likewise
    slope_noise: float  # [Pa/s], likewise, of either chamber; NaN when force-driven
    reason: str  # why it is refused, in the same words for every such window; empty when used
    refused: str  # the same with its figures

    @property
    def used(self) -> bool:
        """Whether the window is a point of the static map."""
        return not self.refused


def find_windows(model: Model, run: Run, window: float = WINDOW) -> list[Window]:
    """Cut every interval of constant input into windows of `window` [s] and judge each."""
    width = max(round(window / run.sample_time), 8)
    edges = np.flatnonzero(np.diff(run.held) != 0.0) + 1
    bounds = np.concatenate([[0], edges, [len(run) - 1]])
    starts = [s for a, b in itertools.pairwise(bounds) for s in range(int(a), int(b) - width + 1, width)]
    if not starts:
        return []
    return _judge(model, run, np.array(starts), width)


def _judge(model: Model, run: Run, starts: NDArray[np.int64], width: int) -> list[Window]:
    rows = starts[:, None] + np.arange(width + 1)
    time: Array = np.asarray((np.arange(width + 1) - 0.5 * width) * run.sample_time, dtype=np.float64)
    motion = np.polynomial.polynomial.polyfit(time, run.position[rows].T, 2)  # (3, windows)
    a, b = (_line(time, signal, rows) for signal in (run.pressure_a, run.pressure_b))
    position, velocity, acceleration = motion[0], motion[1], 2.0 * motion[2]
    held = run.held[starts]
    drive, load, swing = _forces(model, position, velocity, a, b, run.sampled(model.inputs)[starts])
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
        )
        for i, s in enumerate(starts)
    ]


def _line(time: Array, signal: Array | None, rows: NDArray[np.int64]) -> Array:
    if signal is None:
        return np.full((2, len(rows)), np.nan)
    # A least-squares slope of position is the velocity's mean under a parabola; pressures are averaged likewise, so
    # that changes during a window do not bias the force against the velocity.
    weight = 1.0 - (time / (time[-1] + time[1] - time[0])) ** 2
    mean = signal[rows] @ weight / weight.sum()
    return np.stack([mean, np.polynomial.polynomial.polyfit(time, signal[rows].T, 1)[1]])


def _forces(
    model: Model, position: Array, velocity: Array, a: Array, b: Array, held: Array
) -> tuple[Array, Array, Array]:
    """Drive and load force [N] at each window's mean, and the rate of change of the drive force [N/s]."""
    states = np.tile(model.state(), (len(position), 1))
    states[:, 0], states[:, 1] = position, velocity
    swing = np.zeros(len(position))
    if not model.force_driven:
        states[:, 2], states[:, 3] = a[0], b[0]
        swing = model["piston.area_a"] * a[1] - model["piston.area_b"] * b[1]
    seen = model.outputs(states, held)
    return seen["drive"], seen["force"], swing


def _noise(model: Model, run: Run, width: int) -> tuple[float, float, float]:
    """Deviations by sensor noise of a window's friction force [N], velocity [m/s] and pressure slope [Pa/s]."""
    noise, span = run.noise, width * run.sample_time
    parts = [moving_mass(model) * noise["position_m"] * np.sqrt(720.0 / width) / span**2]  # of a parabola's curvature
    if not model.force_driven:
        for area, name in (("area_a", "pressure_a_pa"), ("area_b", "pressure_b_pa")):
            parts.append(model[f"piston.{area}"] * noise[name] * np.sqrt(1.2 / width))
    slope = np.sqrt(12.0 / width) / span  # of a line through white noise of unit size
    steepest = max(noise.get("pressure_a_pa", np.nan), noise.get("pressure_b_pa", np.nan))
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
        ("the piston rests or creeps", speed * span < TRAVEL, lambda i: f" ({1e3 * speed[i]:.2f} mm/s)"),
        (
            "the velocity changes",
            np.abs(speed_change) > SPEED_CHANGE * speed,
            lambda i: f" by {100 * abs(speed_change[i]) / speed[i]:.0f} % in {span:.2g} s",
        ),
        (
            "the pressures still change the force",
            np.abs(force_change) > FORCE_CHANGE * np.abs(force),
            lambda i: f" by {abs(force_change[i]):.1f} N in {span:.2g} s",
        ),
    )
    found = (((why, why + words(i)) for why, bad, words in tests if bad[i]) for i in range(len(rows)))
    return [next(one, ("", "")) for one in found]
