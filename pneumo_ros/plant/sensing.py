"""Sensor readings along simulated states: the states themselves, unless an effect changes the readings."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.plant.held import held_inputs

if TYPE_CHECKING:
    from pneumo_ros.plant.model import Model

Array = NDArray[np.float64]


def sense(
    model: "Model",
    states: Array,
    parameters: Array | None,
    inputs: Array,
    first: NDArray[np.int64],
    *,
    sample_time: float = 1e-3,
    start: ArrayLike = 0.0,
    parts: int = 1,
) -> Array:
    """Readings (lanes, samples, signals) of position and, with chambers, of both pressures along lanes of states.

    states (lanes, samples, states), row k at the END of sample k, parameters (lanes, parameters) or None, inputs and
    first as in `Model.simulate_lanes`; `start` [s], one or (lanes,), is the time of inputs[0]. Without an effect on a
    sensor the readings are the states themselves, and no kernel runs.
    """
    if model.composition.true_sensors:
        columns = [model.states.index(name) for name in model.composition.sensed]
        return states[:, :, columns]
    q = np.broadcast_to(model.values, (len(states), len(model.parameters))) if parameters is None else parameters
    begin = np.asarray(start, dtype=float) + first * (sample_time / parts)
    out = np.empty((*states.shape[:2], len(model.composition.sensed)))
    X, held = np.ascontiguousarray(states, dtype=float), held_inputs(inputs, model.inputs)
    q = np.require(q, float, ["C", "W"])  # the kernel would be compiled again for an array that is read-only
    model.kernel.sense(X, q, held, first, begin, sample_time, parts, out)
    return out
