"""Machines of several axes for the tests."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.multiaxis import Machine
from pneumo_ros.plant import load_model
from pneumo_ros.records.writing import write_axes

Array = NDArray[np.float64]
STEP = 2e-3  # s, of the recordings
LINE = {"resistance_supply": 5e7, "time_constant": 0.3}


def two(supply: dict[str, float] | None = None) -> Machine:
    """A heavy shoulder with a spring, and the default machine as elbow."""
    axis = load_model("axis")
    spring = axis.with_effects([*axis.effects, "spring_load"], {"spring_load.stiffness": 100.0, "piston.mass": 9.0})
    return Machine("two", {"shoulder": spring, "elbow": axis}, supply)


def leaky(machine: Machine, size: float = 6e-10) -> Machine:
    """The same with a leak [kg/(s Pa)] in chamber a of the elbow."""
    elbow = machine.axes["elbow"]
    values = {"leakage_to_atmosphere.conductance_a": size, "leakage_to_atmosphere.conductance_b": 0.0}
    return machine.with_axes({"elbow": elbow.with_effects([*elbow.effects, "leakage_to_atmosphere"], values)})


def voltages(seed: int, samples: int, axes: int) -> Array:
    """Steps to and fro (samples, axes) [V], some of them of no voltage, at times of their own on each axis."""
    rng, volts = np.random.default_rng(seed), np.zeros((samples, axes))
    for k in range(axes):
        at, way = round(0.3 / STEP), 1.0
        while at < samples:
            length = round(rng.uniform(0.5, 1.1) / STEP)
            volts[at : at + length, k] = way * rng.uniform(1.2, 4.0) * (rng.uniform() > 0.15)
            at, way = at + length, -way
    return volts


def record(machine: Machine, path: Path, seed: int, seconds: float, supply_noise: float | None = None) -> Array:
    """Write a recording of all axes with sensor noise; returns the states (samples, states).

    supply_noise: of a sensor of the supply [Pa]; None for no such sensor.
    """
    samples = round(seconds / STEP)
    volts = voltages(seed, samples, len(machine.axes))
    begin = machine.state({name: one.state(y=-0.1, p_a=3.5e5, p_b=3.5e5) for name, one in machine.axes.items()})
    states = np.vstack([begin, machine.simulate(volts, begin, sample_time=STEP)])
    rng, time = np.random.default_rng(seed + 1000), np.arange(samples + 1) * STEP
    signals = {
        axis: {
            "time": time,
            "position": own[:, 0] + 5e-6 * rng.normal(size=len(time)),
            "pressure_a": own[:, 2] + 200.0 * rng.normal(size=len(time)),
            "pressure_b": own[:, 3] + 200.0 * rng.normal(size=len(time)),
            "voltage": np.append(volts[:, k], volts[-1, k]),
        }
        for k, (axis, own) in enumerate(machine.split(states).items())
    }
    measured = None if supply_noise is None else 7e5 - states[:, -1] + supply_noise * rng.normal(size=len(time))
    write_axes(path, signals, supply_pressure=measured)
    return states
