"""Runs and recordings for the tests: the model's own with sensor noise, and those of the independent rig."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from rig import case as rig_case
from rig.effects import Wish, build
from rig.machine import Machine
from rig.sensors import Run as RigRun

from pneumo_ros.plant import Model, load_model
from pneumo_ros.records import Recording
from pneumo_ros.runs.run import PARTS, Run, make_run

POSITION_NOISE, QUANTUM, PRESSURE_NOISE = 5e-6, 1e-5, 300.0
POSITION_FLOOR = float(np.hypot(POSITION_NOISE, QUANTUM / np.sqrt(12.0)))

FRICTION = ("lugre_friction.static_friction", "lugre_friction.coulomb_friction")

# the rig's names of what wears
PARAMETERS = {
    "dead_zone.right_limit": "dead_right",
    "dead_zone.left_limit": "dead_left",
    "arctan_flow.voltage_gain": "gain",
    "arctan_flow.filling_coefficient": "fill",
    "arctan_flow.exhaust_coefficient": "exhaust",
    "lugre_friction.static_friction": "static",
    "lugre_friction.coulomb_friction": "coulomb",
    "lugre_friction.stribeck_velocity": "stribeck",
    "lugre_friction.bristle_stiffness": "bristle",
    "lugre_friction.bristle_damping": "bristle_damping",
    "quadratic_drag.coefficient": "drag",
}


def voltage(kind: str, time: np.ndarray) -> np.ndarray:
    """Random steps, a rising sine, or pushes just beyond the dead zone [V]."""
    if kind == "steps":
        return np.random.default_rng(1).uniform(-2.5, 2.5, 100)[(time / 0.4 + 1e-9).astype(int)]
    if kind == "sweep":
        return 1.6 * np.sin(2.0 * np.pi * (0.2 * time + 0.02 * time**2))
    pushes = np.sin(2.0 * np.pi * 0.7 * time) > -0.2
    return 0.95 * np.sign(np.sin(2.0 * np.pi * 0.11 * time)) * pushes


@lru_cache(maxsize=16)
def own(
    kind: str, sample_time: float = 1e-3, noisy: bool = True, seconds: float = 20.0, friction: float = 1.0
) -> tuple[Model, np.ndarray, Run]:
    """The default machine with `friction` times its own, its true states (n, 5) and its measured run."""
    model, rng = load_model(), np.random.default_rng(0)
    model = model.with_parameters({name: friction * model[name] for name in FRICTION})
    time = np.arange(round(seconds / sample_time)) * sample_time
    held = np.repeat(voltage(kind, time)[:-1], PARTS)
    start = model.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([start, model.simulate(held, start, sample_time=sample_time, parts=PARTS)])
    y, p_a, p_b = states[:, [0, 2, 3]].T
    if noisy:
        y = np.round((y + rng.normal(0.0, POSITION_NOISE, len(time))) / QUANTUM) * QUANTUM
        p_a, p_b = (p + rng.normal(0.0, PRESSURE_NOISE, len(time)) for p in (p_a, p_b))
    return model, states, Run(kind, sample_time, y, p_a, p_b, held, np.ones(len(time), dtype=bool), False)


@lru_cache(maxsize=32)
def rig(name: str, seed: int = 0, effect: str = "", size: float | None = None) -> tuple[Model, RigRun, Run]:
    """The model with the parameters of a worn rig, and a run of that rig, which may hide an effect of a given size."""
    case = build(seed, [Wish(effect, size)] if effect else [])
    recorded = rig_case.make_run(case, name)
    return model_of(case.machine), recorded, make_run(recording_of(recorded))


def model_of(machine: Machine) -> Model:
    """The model with the parameters of a rig's machine, without the hidden effect."""
    return load_model().with_parameters({ours: getattr(machine, theirs) for ours, theirs in PARAMETERS.items()})


def recording_of(run: RigRun) -> Recording:
    """A run of the rig, as read from its bag."""
    origin = run.stamps[0]
    return recording(
        time=(run.stamps - origin) * 1e-9,
        position=run.position,
        pressure_a=run.pressure_a,
        pressure_b=run.pressure_b,
        command_time=(run.command_index * 10**6 - origin) * 1e-9,
        command=run.voltage[run.command_index],
        voltage=run.voltage,
        name=run.name,
    )


def recording(**signals: Any) -> Recording:
    """A recording of the given arrays; other signals are not recorded."""
    fields: dict[str, Any] = dict.fromkeys(Recording.__dataclass_fields__)
    fields |= {
        "name": "run",
        "path": Path("run"),
        "namespace": "",
        "joint_name": "piston",
        "start_ns": 0,
        "warnings": (),
    }
    return Recording(**(fields | signals))


def ratio(errors: np.ndarray, noise: float) -> float:
    """Root mean square of errors in noise floors."""
    return float(np.sqrt(np.nanmean(np.square(errors)))) / noise
