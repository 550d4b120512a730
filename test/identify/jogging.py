"""Machines of data sheets with on/off valves and regulators, and runs in which the piston is sent to and fro."""

import numpy as np

from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import Model
from pneumo_ros.plant.stepper import Stepper
from pneumo_ros.runs.run import PARTS, Run

SHEETS = {
    "pulses": Wishes(supply="6barg", mass="2", cylinder="iso6432-25-200", valve="smc-vq110u"),
    "regulators": Wishes(supply="6barg", mass="2", cylinder="iso6432-25-200", valve="festo-vppe", valve_flow="C 0.5"),
}


def sheet(kind: str) -> Model:
    """The machine as its data sheets tell it."""
    return design(SHEETS[kind], load_shelf([])).model


def truth(model: Model) -> Model:
    """The machine within the scatter of its data sheets."""
    rng = np.random.default_rng(5)
    fitted = [name for name in model.uncertainty if not name.startswith("arctan_flow.")]  # a scale of C, not fitted
    moved = {name: model[name] + rng.uniform(-1.0, 1.0) * model.uncertainty[name] for name in fitted}
    friction = {"static_friction": 38.0, "coulomb_friction": 28.0, "stribeck_velocity": 0.012}
    return model.with_parameters(moved | {f"lugre_friction.{name}": value for name, value in friction.items()}
                                 | {"lugre_friction.bristle_stiffness": 5e5})  # fmt: skip


def jogged(model: Model, name: str, seconds: float, every: float) -> Run:
    """A run with sensor noise in which the piston goes to another place every so many seconds."""
    return true_and_seen(model, name, seconds, every)[1]


def true_and_seen(model: Model, name: str, seconds: float, every: float) -> tuple[np.ndarray, Run]:
    """The true states (n, 4) of the frame, and the run."""
    rng, n, plant = np.random.default_rng(len(name)), round(1e3 * seconds), Stepper(model, model.state())
    goal, gain, base, sent = 0.0, 60.0, 3.0, np.zeros(len(model.inputs))
    states, held = np.empty((n, 4)), np.empty((n, len(sent)))
    for k in range(n):
        if k % round(1e3 * every) == 0:
            goal, gain, base = rng.uniform(-0.06, 0.06), rng.uniform(30.0, 150.0), rng.uniform(2.0, 5.0)
        if k % 20 == 0:
            push = float(np.clip(gain * (goal - plant.state[0]), -9.0, 9.0))
            sent = np.array([push] if len(sent) == 1 else [base + 0.5 * push, 1.19 * base - 0.5 * push]).clip(-10, 10)
            sent = np.maximum(sent, 0.0) if len(sent) > 1 else sent
        states[k], held[k] = plant.state[:4], sent
        plant.advance(*sent.tolist())
    y, a, b = (states[:, i] + s * rng.normal(size=n) for i, s in ((0, 5e-6), (2, 300.0), (3, 300.0)))
    cells = np.repeat(held[:-1], PARTS, axis=0)
    further = {"U_b": cells[:, 1].copy()} if cells.shape[1] > 1 else {}
    return states, Run(name, 1e-3, y, a, b, cells[:, 0].copy(), np.ones(n, dtype=bool), False, further)
