"""Machines driven along a given motion, and their signals."""

import numpy as np
from plant.catalogue import lone_machine

from pneumo_ros.plant import Model

F_S, F_C, V_S, SIGMA = 100.0, 70.0, 0.01, 1.4e6  # the bristle of the axis


def along(model: Model, y: object, v: object, sample: float, p: float = 4e5, **start: float) -> tuple:
    """States (n, states) and signals along positions y [m] and velocities v [m/s] that are `sample` [s] apart.

    Both chambers are at p [Pa]; the effects' states begin at rest or as `start` says.
    """
    y, v = np.broadcast_arrays(np.asarray(y, dtype=float), np.asarray(v, dtype=float))
    measured = np.column_stack([y, v, np.full_like(y, p), np.full_like(y, p)])
    rest = model.state(**start)[4:]
    x, _ = model.follow(measured, np.zeros(len(y)), rest, sample_time=sample, step=min(sample, 1e-4))
    return x, model.outputs(x, np.zeros(len(y)), start=-sample, sample_time=sample)


def sliding(name: str, speed: float, y: float = 0.0, p: float = 4e5, seconds: float = 0.2, **values: float) -> float:
    """Friction [N] of the machine with effect `name` alone, its parameters at `values`, after `seconds` of sliding.

    The position stays y, where friction is evaluated.
    """
    model = lone_machine(name).with_parameters({f"{name}.{key}": value for key, value in values.items()})
    count = round(seconds / 1e-3)
    _, seen = along(model, np.full(count, y), np.full(count, speed), 1e-3, p)
    return float(seen["friction"][-1])
