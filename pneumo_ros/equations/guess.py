"""First guesses of the state along a recording, before any simulation is fitted."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.runs.run import POSITION, Run, check_position
from pneumo_ros.runs.sensors import driven
from pneumo_ros.runs.smooth import HALF_WIDTH, noise_gain, smooth

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# N, error of the balance of forces: a piston that has just stopped oscillates on its bristle (84 Hz on the default
# machine) with tens of newtons, which smoothing over +-12 ms removes
_FORCE = 10.0
_HALF = 0.5  # of the static friction, where this is less: a stuck machine that is weak, or turns, moves at more
# of the variation of a state without sensor: error of its value when driven along the measurements
_UNSURE = 0.3


def measured_frame(run: Run, chambers: Sequence[Chamber]) -> Array:
    """Measured position, smoothed velocity and the measured pressures of a machine's chambers (n, 2 + chambers)."""
    return np.column_stack([run.position, run.smoothed.motion[:, 1], run.pressures(chambers)])


@dataclass(frozen=True)
class Guess:
    """First guesses at some grid points of a run (points, states), and their standard deviations (states,)."""

    states: Array
    scale: Array


def first_guess(model: Model, run: Run, at: Index) -> Array:
    """States (len(at), states) of `guess_states`."""
    return guess_states(model, run, at).states


def guess_states(model: Model, run: Run, at: Index) -> Guess:
    """States at grid points `at`: measured ones smoothed, others driven along, bristles by balance of forces.

    Readings are corrected for the model's sensor effects. Raises DataError when the run leaves the stroke of the
    model.
    """
    check_position(model, run)
    guess = run.smoothed
    frame = guess.states(model.chambers)
    states, _ = driven(model, frame, run)
    chosen: Array = states[at]
    if "z" in model.states and not model.imposed:
        acceleration: Array = guess.acceleration[at]
        if not model.composition.true_sensors:
            acceleration += smooth(states[:, 0] - frame[:, 0], run.sample_time, 1.5 * HALF_WIDTH, 3, 2)[at]
        _balance(model, chosen, run.sampled(model.inputs)[at], acceleration)
    return Guess(chosen, _scale(model, run, states, frame))


def resting_states(model: Model, run: Run) -> Array:
    """States (n, states) of a piston that rests at each measured position, under the measured pressures."""
    states = np.tile(model.state(), (len(run), 1))
    states[:, 0], states[:, 2 : model.frame] = run.position, run.pressures(model.chambers)
    return states


def _balance(model: Model, states: Array, held: Array, acceleration: Array) -> None:
    """Set the bristle deflection so that the model's acceleration is the measured one (two secant steps)."""
    z, v = model.states.index("z"), model.states.index("v")
    probe = 1e-6
    for _ in range(2):
        shifted = states.copy()
        shifted[:, z] += probe
        here, there = (model.derivatives(x, held)[:, v] for x in (states, shifted))
        slope = (there - here) / probe
        states[:, z] += np.where(slope != 0.0, (acceleration - here) / np.where(slope == 0.0, 1.0, slope), 0.0)
    limit = _deflection_limit(model)
    states[:, z] = np.clip(states[:, z], -limit, limit)


def _deflection_limit(model: Model) -> float:
    section = "lugre_friction"
    return model[f"{section}.static_friction"] / model[f"{section}.bristle_stiffness"]


def _scale(model: Model, run: Run, states: Array, frame: Array) -> Array:
    """Standard deviation (states,) of each state about its first guess; for measured states that of the readings."""
    noise = run.noise
    with np.errstate(over="ignore", invalid="ignore"):
        scale: Array = np.maximum(np.nan_to_num(_UNSURE * np.std(states, axis=0), posinf=1.0), 1e-9)
        late = _UNSURE * np.std(states[:, 1] - frame[:, 1])
    for name, column in measured_columns(model).items():
        scale[column] = 3.0 * noise[name]
    scale[1] = 3.0 * noise["position_m"] * noise_gain(run.sample_time, HALF_WIDTH, 3, 1) + 1e-4 + late
    if "z" in model.states:
        stiffness = model["lugre_friction.bristle_stiffness"]
        force = min(_FORCE, _HALF * model["lugre_friction.static_friction"])
        scale[model.states.index("z")] = force / stiffness
        scale[1] += force / np.sqrt(stiffness * model["piston.mass"])  # of an oscillation with that force
    return scale


def measured_columns(model: Model) -> dict[str, int]:
    """Column of the state of each measured signal, by report name: position, and the pressure of each chamber."""
    columns = {chamber.signal: model.states.index(chamber.state) for chamber in model.chambers}
    return {POSITION: model.states.index("y"), **columns}
