"""Bags of constant-voltage runs, made by the conductor on a model without nodes: fast and repeatable."""

from pathlib import Path

import numpy as np

from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.constant_voltage import constant_voltage
from pneumo_ros.plant import Model
from pneumo_ros.plant.stepper import Stepper
from pneumo_ros.records import write_recording

POSITION_NOISE, PRESSURE_NOISE = 5e-6, 300.0  # m, Pa


def record_campaign(
    folder: Path,
    model: Model,
    voltages: tuple[float, ...],
    seconds: float,
    rate: float = 250.0,
    start_ns: int = 1_700_000_000_000_000_000,
) -> list[Path]:
    """One bag per run in `folder`, in the order of the programme, the first one recorded at `start_ns`."""
    conductor = Conductor(constant_voltage(model, voltages, seconds))
    plant = Stepper(model, model.state(), sample_time=1.0 / rate)
    rows: dict[str, list[tuple[float, ...]]] = {}
    while not conductor.done:
        y, _, p_a, p_b = plant.state[:4].tolist()
        volts = conductor.step(plant.time, y)
        if conductor.recording:
            rows.setdefault(conductor.recording, []).append((plant.time, y, p_a, p_b, volts))
        plant.advance(volts)
    noise = np.random.default_rng(0)
    paths = []
    for name, samples in rows.items():
        time, y, p_a, p_b, volts = np.array(samples).T
        y += POSITION_NOISE * noise.standard_normal(len(y))
        p_a, p_b = (p + PRESSURE_NOISE * noise.standard_normal(len(p)) for p in (p_a, p_b))
        write_recording(
            folder / name, time=time - time[0], position=y, pressure_a=p_a, pressure_b=p_b, voltage=volts,
            start_ns=start_ns + round(time[0] * 1e9),
        )  # fmt: skip
        paths.append(folder / name)
    return paths
