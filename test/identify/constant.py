"""Constant-voltage runs of the paper's machine with sensor noise, and an inexact machine file."""

from functools import lru_cache
from pathlib import Path

import numpy as np

from pneumo_ros.plant import Model, load_model
from pneumo_ros.records import write_recording
from pneumo_ros.runs.run import PARTS, Run

POSITION_NOISE, PRESSURE_NOISE = 10e-6, 300.0
CLOSED = 0.1  # s before the valve opens
VOLTAGES = (0.80, -0.80, 0.83, -0.83, 1.0, -1.0, 2.0, -2.0, 7.0, -7.0)


@lru_cache(maxsize=1)
def truth() -> Model:
    """The machine that is recorded."""
    return load_model("paper")


def wrong() -> Model:
    """The same with friction off by 10 to 30 %, as a user has it before identification."""
    factor = {"static_friction": 0.85, "coulomb_friction": 1.1, "stribeck_velocity": 1.3}
    values = {f"lugre_friction.{key}": truth()[f"lugre_friction.{key}"] * by for key, by in factor.items()}
    return truth().with_parameters(
        {**values, "quadratic_drag.coefficient": 1.2 * truth()["quadratic_drag.coefficient"]}
    )


@lru_cache(maxsize=64)
def states(volts: float, seconds: float, sample_time: float = 1e-3, model: Model | None = None) -> np.ndarray:
    """(samples + 1, states) of a run from rest near the end that it moves away from."""
    start = truth().state(y=-0.9 if volts > 0 else 0.9, p_a=1.2e5, p_b=1.6e5)
    held = held_voltage(volts, seconds, sample_time)
    return np.vstack([start, (model or truth()).simulate(held, start, sample_time=sample_time)])


def held_voltage(volts: float, seconds: float, sample_time: float) -> np.ndarray:
    """Closed for 0.1 s, then constant."""
    held = np.full(round(seconds / sample_time), volts)
    held[: round(CLOSED / sample_time)] = 0.0
    return held


def constant_run(
    volts: float, seconds: float = 8.0, sample_time: float = 1e-3, noisy: bool = True, model: Model | None = None
) -> Run:
    """One run; the noise depends on the voltage alone."""
    x = states(volts, seconds, sample_time, model)
    rng = np.random.default_rng(round(1000 * abs(volts)) + (volts < 0.0))
    y, p_a, p_b = (
        x[:, column] + (size if noisy else 0.0) * rng.standard_normal(len(x))
        for column, size in ((0, POSITION_NOISE), (2, PRESSURE_NOISE), (3, PRESSURE_NOISE))
    )
    held = np.repeat(held_voltage(volts, seconds, sample_time), PARTS)
    return Run(f"constant_{volts:+.2f}V", sample_time, y, p_a, p_b, held, np.ones(len(x), dtype=bool), False)


def constant_runs(*volts: float, seconds: float = 8.0) -> list[Run]:
    """One run for each voltage."""
    return [constant_run(one, seconds) for one in volts or VOLTAGES]


def write_bag(folder: Path, run: Run) -> Path:
    """A run as a bag."""
    voltage = run.input[::PARTS]
    write_recording(
        folder, time=run.time, position=run.position, pressure_a=run.pressure_a, pressure_b=run.pressure_b,
        voltage=np.append(voltage, voltage[-1]), start_ns=10**18,
    )  # fmt: skip
    return folder
