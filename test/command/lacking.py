"""A user's recordings of a machine with more friction than the default one."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from identify.making import POSITION_NOISE, PRESSURE_NOISE, QUANTUM, voltage

from pneumo_ros.plant import Model, load_model
from pneumo_ros.records import write_recording

VISCOUS = 150.0  # N s/m


def machine() -> Model:
    """The default machine with viscous friction and slightly different base parameters."""
    model = load_model()
    worn = {"lugre_friction.coulomb_friction": 71.5, "arctan_flow.filling_coefficient": 7.05e-9}
    return model.with_effects([*model.effects, "viscous_friction"], {"viscous_friction.coefficient": VISCOUS, **worn})


def record(path: Path, kind: str, seconds: float = 6.0, seed: int = 0, model: Model | None = None) -> None:
    """A recording of `kind` (see `identify.making.voltage`), with sensor noise."""
    truth, rng = model or machine(), np.random.default_rng([seed, len(kind)])
    held = voltage(kind, np.arange(round(seconds * 1e3)) * 1e-3)
    start = truth.state(y=0.1 * seed, p_a=3e5, p_b=3.9e5)
    y, _, p_a, p_b = np.vstack([start, truth.simulate(held[:-1], start)])[:, :4].T
    y = np.round((y + rng.normal(0.0, POSITION_NOISE, len(y))) / QUANTUM) * QUANTUM
    p_a, p_b = (p + rng.normal(0.0, PRESSURE_NOISE, len(p)) for p in (p_a, p_b))
    write_recording(path, time=np.arange(len(y)) * 1e-3, position=y, pressure_a=p_a, pressure_b=p_b, voltage=held)


def shelf(folder: Path, kinds: Sequence[str] = ("steps", "sweep")) -> Path:
    """A folder `runs` with a recording of each kind, and one to hold out."""
    (folder / "runs").mkdir()
    for kind in kinds:
        record(folder / "runs" / kind, kind)
    record(folder / "runs" / "holdout_sweep", "sweep", seed=1)
    return folder
