"""True states from sensor readings: measurements corrected for the sensor effects of a model."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.model import STEP
from pneumo_ros.plant.reach import written_by
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.smooth import HALF_WIDTH, smooth

Array = NDArray[np.float64]
Index = NDArray[np.int64]
# frames (lanes, n, frame) and lane numbers -> states (lanes, n, own), some of those beside the frame's
Drive = Callable[[Array, Index], Array]

_ITERATIONS = 2  # at most: the fixed point of a delay tau does not hold for motion faster than 1 / tau (rad/s)
_AT_REST = 10  # at most, without their own states: each step leaves a share of the error that is the gain's
LAST = 20  # samples at the end by which a reading goes on
QUICK = 2  # parts of a sample along a measured motion: their errors cancel in differences of two variants
SHORT = 1.01e-3  # s: a sample that is cut into few parts
# s, integration steps: of all effects, and of those that make sensors differ from states, of which the fastest, a
# position that is 2 ms late, is unstable from 0.7 ms on
LONGEST, LATE = SHORT, 0.51e-3
_ENOUGH = (1e-7, 1.0, 1.0)  # m, Pa, Pa: a tenth of what any sensor of such a machine resolves


def corrected(model: Model, frame: Array, run: Run) -> Array:
    """True frame states (n, frame) from measured ones: y, v, p_a, p_b without the model's sensor effects.

    `frame` holds the measured position, its derivative and, with chambers, the pressures. A model without sensor
    effects returns the same array.
    """
    return frame if model.composition.true_sensors else driven(model, frame, run)[0][:, : frame.shape[1]]


def driven(model: Model, frame: Array, run: Run) -> tuple[Array, Array]:
    """As `Model.follow` along the corrected frame: states, frame included, and mean derivatives, both (n, states).

    In steps of half a millisecond where the samples are that fine: first guesses need no more.
    """
    rest, parts = model.state()[frame.shape[1] :], parts_of(model) if run.sample_time < SHORT else PARTS
    held, step = run.averaged(model.inputs, parts), STEP if parts == PARTS else longest_step(model, run, parts)

    def follow(given: Array) -> tuple[Array, Array]:
        return model.follow(given, held, rest, sample_time=run.sample_time, step=step, start=run.begin, parts=parts)

    if not model.composition.true_sensors:
        names = model.states[frame.shape[1] :]
        (frame,) = corrected_lanes(
            model, frame, run, None, lambda given, _: follow(given[0])[0][None, :, -len(names) :], names, _ENOUGH
        )
    return follow(frame)


def parts_of(model: Model, enough: int = QUICK) -> int:
    """Parts of a sample: `enough`, or all where valves open and close within one: steps of 1 ms are 200 noises off."""
    return PARTS if model.composition.jumping else enough


def longest_step(model: Model, run: Run, parts: int, true_sensors: bool = False) -> float:
    """Longest step of the integration [s] along a measured motion.

    `true_sensors`: that no effect of the model which makes a sensor differ from its state acts in any lane.
    """
    most = LONGEST if true_sensors or model.composition.true_sensors else LATE
    return min(1.01 * run.sample_time / parts, STEP if model.composition.jumping else most)


def corrected_lanes(
    model: Model, frame: Array, run: Run, parameters: Array | None, drive: Drive, names: Sequence[str],
    enough: Sequence[float],
) -> Array:  # fmt: skip
    """Frame states without sensor effects (lanes, n, frame); `drive` follows the states of `names` along them.

    Readings that are late are first taken at their own times, what a low-pass smoothed is made good, and others are
    inverted as if the sensors' own states were at rest, which is all that a gain needs. Then the readings r(x) are
    inverted by at most two steps of the fixed point x = x_measured - (r(x) - x); each step drives the sensors' own
    states again. The velocity is corrected by the derivative of the correction of position. Each lane stops when its
    correction changes by no more than `enough` [m, Pa, Pa], so its result does not depend on other lanes. A lane whose
    readings are not finite has no states: as measured, it would be that of a machine whose sensors are right.
    parameters (lanes, parameters), or None for one lane with the model's own, which is returned as it is.
    """
    count = 1 if parameters is None else len(parameters)
    moving, before = np.arange(count), advanced(model, frame, parameters, run)
    inverted = at_rest(model, frame, before, parameters, run, enough)
    before += np.where(np.isfinite(inverted).all(axis=(1, 2), keepdims=True), inverted, 0.0)
    given = np.repeat(frame[None], count, axis=0)
    for lane in np.flatnonzero(before.any(axis=(1, 2))):
        given[lane] = shifted(frame, before[lane], run.sample_time)
    for _ in range(_ITERATIONS):
        own = None if parameters is None else parameters[moving]
        shift = taken_back(model, given[moving], drive(given[moving], moving), names, own, run)
        still = np.any(np.abs(shift - before).max(axis=1) > enough[: shift.shape[-1]], axis=1)
        lost = ~np.isfinite(shift).all(axis=(1, 2))
        if parameters is not None:
            given[moving[lost]] = np.nan
        still &= ~lost
        moving, before = moving[still], shift[still]
        if not len(moving):
            break
        given[moving] = [shifted(frame, own, run.sample_time) for own in before]
    return given


def advanced(model: Model, frame: Array, parameters: Array | None, run: Run) -> Array:
    """What to add to the readings (lanes, n, sensed) so that those that a sensor gives late stand at their own times.

    After the end a reading goes on as it did last. What a low-pass of time constant T reads as r was r + T r'. A fixed
    point alone would amplify the noise of what is faster than 1 / delay (rad/s) by a factor of eight, and two steps of
    it leave a third of what passes a low-pass at 1 / T.
    """
    own = model.values[None] if parameters is None else parameters
    delays, lags = (late_by(model, own, role) for role in ("delay", "low-pass"))
    found, time = np.zeros((len(delays), len(frame), delays.shape[1])), run.sample_time * np.arange(len(frame))
    for lane, k in zip(*np.nonzero((delays > 0.0) | (lags > 0.0)), strict=True):
        reading, then = frame[:, model.states.index(model.composition.sensed[k])], time + delays[lane, k]
        rate = (reading[-1] - reading[-1 - LAST]) / (LAST * run.sample_time) if len(reading) > LAST else 0.0
        early = np.interp(then, time, reading) + rate * np.maximum(then - time[-1], 0.0)
        found[lane, :, k] = early + lags[lane, k] * smooth(early, run.sample_time, HALF_WIDTH, 3, 1) - reading
    return found


def at_rest(
    model: Model, frame: Array, late: Array, parameters: Array | None, run: Run, enough: Sequence[float]
) -> Array:
    """What else to add to the readings (lanes, n, sensed), beside `late`, if the sensors' own states stay at rest.

    By the same fixed point to within `enough`, but without driving anything. Not finite in a lane whose readings are
    not.
    """
    found, none = np.zeros_like(late), np.empty((1, len(frame), 0))
    for lane in range(len(late)):
        own = None if parameters is None else parameters[lane : lane + 1]
        for _ in range(_AT_REST):
            x = shifted(frame, late[lane] + found[lane], run.sample_time)
            shift = taken_back(model, x[None], none, (), own, run)[0]
            change, found[lane] = np.abs(shift - found[lane]).max(axis=0), shift
            if not np.isfinite(change).all() or np.all(change <= enough[: len(change)]):
                break
    return found


def late_by(model: Model, parameters: Array, role: str) -> Array:
    """By how much sensors give each state late [s] (lanes, sensed): the sum of their effects' parameters of a role."""
    names, sensed = list(model.parameters), model.composition.sensed
    found = np.zeros((len(parameters), len(sensed)))
    for effect in model.composition.effects:
        late = [names.index(f"{effect.name}.{key}") for key, one in effect.parameters.items() if one.role == role]
        written = {SENSED.get(signal) for signal in written_by(effect)}
        found += parameters[:, late].sum(axis=1)[:, None] * np.array([state in written for state in sensed])
    return found


def taken_back(
    model: Model, given: Array, states: Array, names: Sequence[str], parameters: Array | None, run: Run
) -> Array:
    """What to add to the readings (lanes, n, sensed) of position and pressures to get these states.

    given (lanes, n, frame), states (lanes, n, names); all others rest. parameters (lanes, parameters) or None
    for the model's own.
    """
    held = run.inputs(model.inputs)
    held = np.concatenate([held[:PARTS], held])  # row k is read under the last inputs before it
    first, dt = np.zeros(1, dtype=np.int64), run.sample_time
    columns = [model.states.index(name) for name in names]
    sensed = [model.states.index(name) for name in model.composition.sensed]
    every, found = np.tile(model.state(), (1, given.shape[1], 1)), np.empty((*given.shape[:2], len(sensed)))
    for lane, own in enumerate(states):  # one after another, as all states are large
        every[0, :, : given.shape[2]], every[0, :, columns] = given[lane], own.T
        q = None if parameters is None else parameters[lane : lane + 1]
        read = sense(model, every, q, held, first, sample_time=dt, start=run.begin - dt, parts=PARTS)
        found[lane] = given[lane][:, sensed] - read[0]
    return found


def shifted(frame: Array, shift: Array, sample_time: float) -> Array:
    """The frame (n, frame) with `shift` (n, sensed) added to position and pressures, and its rate to the velocity."""
    moved: Array = frame.copy()
    moved[:, 0] += shift[:, 0]
    moved[:, 1] += smooth(shift[:, 0], sample_time, HALF_WIDTH, 3, 1)
    moved[:, 2:] += shift[:, 1:]
    return moved
