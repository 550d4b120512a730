"""What the machine did, from what its sensors read: measurements corrected for the sensor effects of a model."""

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.smooth import HALF_WIDTH, smooth

Array = NDArray[np.float64]

_ITERATIONS = 2  # at most: the fixed point of a delay tau does not hold for motion faster than 1 / tau (rad/s)
_ENOUGH = (1e-7, 1.0)  # m, Pa: a tenth of what any sensor of such a machine resolves


def corrected(model: Model, frame: Array, run: Run) -> Array:
    """Frame states (n, 2 or 4) behind measured ones: y, v, p_a, p_b without what the model's sensor effects did.

    `frame` holds the measured position, its derivative and, with chambers, the pressures. The very same array comes
    back from a model without sensor effects.
    """
    return frame if model.composition.true_sensors else driven(model, frame, run)[0][:, : frame.shape[1]]


def driven(model: Model, frame: Array, run: Run) -> tuple[Array, Array]:
    """As `Model.follow` along the corrected frame: states, frame included, and mean derivatives, both (n, states).

    The readings r(x) are inverted by the fixed point x = x_measured - (r(x) - x), which drives the sensors' own states
    anew each time; the velocity is corrected by the derivative of the correction of position.
    """
    rest = model.state()[frame.shape[1] :]
    states, rates = model.follow(frame, run.input, rest, sample_time=run.sample_time, parts=PARTS)
    if model.composition.true_sensors:
        return states, rates
    before = np.zeros((len(frame), frame.shape[1] - 1))
    for _ in range(_ITERATIONS):
        shift = taken_back(model, states[None], None, run)[0]
        change = np.abs(shift - before).max(axis=0)
        if not (change > np.append(_ENOUGH[0], np.full(len(change) - 1, _ENOUGH[1]))).any():
            break
        states, rates = model.follow(
            shifted(frame, shift, run.sample_time), run.input, rest, sample_time=run.sample_time, parts=PARTS
        )
        before = shift
    return states, rates


def taken_back(model: Model, states: Array, parameters: Array | None, run: Run) -> Array:
    """What to add to the readings (lanes, n, 1 or 3) of position and pressures to get these states (lanes, n, states).

    parameters (lanes, parameters) or None, where all lanes are the model's.
    """
    voltage = np.concatenate([run.input[:PARTS], run.input])  # row k is read under the last voltage before it
    first, dt = np.zeros(len(states), dtype=np.int64), run.sample_time
    read = sense(model, states, parameters, voltage, first, sample_time=dt, start=-dt, parts=PARTS)
    columns = [model.states.index(name) for name in model.composition.sensed]
    return np.asarray(states[:, :, columns] - read)


def shifted(frame: Array, shift: Array, sample_time: float) -> Array:
    """The frame (n, 2 or 4) with `shift` (n, 1 or 3) added to position and pressures, and its rate to the velocity."""
    moved: Array = frame.copy()
    moved[:, 0] += shift[:, 0]
    moved[:, 1] += smooth(shift[:, 0], sample_time, HALF_WIDTH, 3, 1)
    moved[:, 2:] += shift[:, 1:]
    return moved
