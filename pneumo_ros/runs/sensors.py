"""True states from sensor readings: measurements corrected for the sensor effects of a model."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import shift

from pneumo_ros.plant import Model
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.model import STEP
from pneumo_ros.plant.reach import written_by
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.crossings import Crossing, crossings, play_of
from pneumo_ros.runs.readings import INVERTED, must_drive
from pneumo_ros.runs.run import PARTS, POSITION, Run
from pneumo_ros.runs.smooth import HALF_WIDTH, smooth

Array = NDArray[np.float64]
Index = NDArray[np.int64]
# frames (lanes, n, frame) and lane numbers -> states (lanes, n, own), some of those beside the frame's
Drive = Callable[[Array, Index], Array]

STIFFNESS, STATIC = "lugre_friction.bristle_stiffness", "lugre_friction.static_friction"
_ITERATIONS = 2  # at most: the fixed point of a delay tau does not hold for motion faster than 1 / tau (rad/s)
_AT_REST = 10  # at most, without their own states: each step leaves a share of the error that is the gain's
LAST = 20  # samples at the end by which a reading goes on
QUICK = 2  # parts of a sample along a measured motion: their errors cancel in differences of two variants
SHORT = 1.01e-3  # s: a sample that is cut into few parts
# s, integration steps: of all effects, and of those that make sensors differ from states, of which the fastest, a
# position that is 2 ms late, is unstable from 0.7 ms on
LONGEST, DIFFERING = SHORT, 0.51e-3
_ENOUGH = (1e-7, 1.0, 1.0)  # m, Pa, Pa: a tenth of what any sensor of such a machine resolves


def corrected(model: Model, frame: Array, run: Run) -> Array:
    """True frame states (n, frame) from measured ones: y, v, p_a, p_b without the model's sensor effects.

    `frame` holds the measured position, its derivative and, with chambers, the pressures. A model without sensor
    effects returns the same array.
    """
    return frame if model.composition.true_sensors else driven(model, frame, run)[0][:, : frame.shape[1]]


def driven(model: Model, frame: Array, run: Run) -> tuple[Array, Array]:
    """As `Model.follow` along the corrected frame: states, frame included, and mean derivatives, both (n, states).

    In steps of half a millisecond where the samples are that fine: first guesses need no more. The model reads at these
    states what was measured: the position makes good what inverting its sensor left.
    """
    parts = parts_of(model) if run.sample_time < SHORT else PARTS
    rest = model.state()[frame.shape[1] :]
    held, step = run.averaged(model.inputs, parts), STEP if parts == PARTS else longest_step(model, run, parts)

    def follow(given: Array) -> tuple[Array, Array]:
        return model.follow(given, held, rest, sample_time=run.sample_time, step=step, start=run.begin, parts=parts)

    if model.composition.true_sensors:
        return follow(frame)
    names = model.states[frame.shape[1] :]
    (true,) = corrected_lanes(
        model, frame, run, None, lambda given, _: follow(given[0])[0][None, :, -len(names) :], names, _ENOUGH
    )
    states, means = follow(true)
    along, own = np.split(states[None], [frame.shape[1]], axis=2)
    states[:, 0] = frame[:, 0] + taken_back(model, along, own, names, None, run)[0, :, 0]
    return states, means


def parts_of(model: Model, enough: int = QUICK) -> int:
    """Parts of a sample: `enough`, or all where valves open and close within one: steps of 1 ms are 200 noises off."""
    return PARTS if model.composition.jumping else enough


def longest_step(model: Model, run: Run, parts: int, true_sensors: bool = False) -> float:
    """Longest step of the integration [s] along a measured motion.

    `true_sensors`: that no effect of the model which makes a sensor differ from its state acts in any lane.
    """
    most = LONGEST if true_sensors or model.composition.true_sensors else DIFFERING
    return min(1.01 * run.sample_time / parts, STEP if model.composition.jumping else most)


def corrected_lanes(
    model: Model, frame: Array, run: Run, parameters: Array | None, drive: Drive, names: Sequence[str],
    enough: Sequence[float],
) -> Array:  # fmt: skip
    """Frame states without sensor effects (lanes, n, frame); `drive` follows the states of `names` along them.

    What the roles of parameters say is inverted first (`inverted`), then what else a reading differs by with the
    sensors' own states at rest, which is all that a gain needs. Where a reading depends on states in another way, it is
    inverted by at most two steps of the fixed point x = x_measured - (r(x) - x); each step drives the sensors' own
    states again, and amplifies noise: in windows of 40 ms by 3.6 % behind a delay of 1 ms. A lane stops when its
    correction changes by no more than `enough` [m, Pa, Pa], so its result does not depend on other lanes. The velocity
    is corrected by the derivative of the correction of position. A lane whose readings are not finite has no states: as
    measured, it would be that of a machine whose sensors are right. parameters (lanes, parameters), or None for one
    lane with the model's own, which is returned as it is.
    """
    before = inverted(model, frame, parameters, run)
    others = at_rest(model, frame, before, parameters, run, enough)
    finite = np.isfinite(others).all(axis=(1, 2))
    before[finite] += others[finite]
    given = np.repeat(frame[None], len(before), axis=0)
    for lane in np.flatnonzero(before.any(axis=(1, 2))):
        given[lane] = shifted(frame, before[lane], run.sample_time)
    steps = must_drive(model, model.values[None] if parameters is None else parameters, untold=True)
    if parameters is not None:
        given[~finite & ~steps] = np.nan
    moving = np.flatnonzero(steps)
    for _ in range(_ITERATIONS if len(moving) else 0):
        own = None if parameters is None else parameters[moving]
        added = taken_back(model, given[moving], drive(given[moving], moving), names, own, run)
        still = np.any(np.abs(added - before[moving]).max(axis=1) > enough[: added.shape[-1]], axis=1)
        lost = ~np.isfinite(added).all(axis=(1, 2))
        if parameters is not None:
            given[moving[lost]] = np.nan
        still &= ~lost
        moving = moving[still]
        before[moving] = added[still]
        if not len(moving):
            break
        given[moving] = [shifted(frame, own, run.sample_time) for own in before[moving]]
    return given


def inverted(model: Model, frame: Array, parameters: Array | None, run: Run) -> Array:
    """What to add to the readings (lanes, n, sensed) for what the roles of their effects' parameters say.

    Readings that a sensor gives late stand at their own times; after the end one goes on as it did last. What a
    low-pass of time constant T reads as r was r + T r'. A fixed point alone would amplify the noise of what is faster
    than 1 / delay (rad/s) by a factor of eight; two steps of it leave a third of what passes a low-pass at 1 / T. The
    piston crosses a play while the sensor behind it rests.
    """
    own = model.values[None] if parameters is None else parameters
    delays, lags, plays = (by_role(model, own, role) for role in INVERTED)
    found, time = np.zeros((len(delays), len(frame), delays.shape[1])), run.sample_time * np.arange(len(frame))
    known = dict[tuple[float, ...], list[Crossing]]()  # of a reading: most lanes differ in other parameters
    held = bent(model, frame, run) if plays.any() else None
    for lane, k in zip(*np.nonzero((delays > 0.0) | (lags > 0.0) | (plays > 0.0)), strict=True):
        state = model.composition.sensed[k]
        reading, late = frame[:, model.states.index(state)], delays[lane, k]
        rate = (reading[-1] - reading[-1 - LAST]) / (LAST * run.sample_time) if len(reading) > LAST else 0.0
        beyond = np.maximum(time + late - time[-1], 0.0)
        # a cubic spline: straight lines between two samples take out noise, which passes for a better model
        own_times = shift(reading, -late / run.sample_time, order=3, mode="nearest") if late > 0.0 else reading
        own_times = np.where(beyond > 0.0, reading[-1] + rate * beyond, own_times)
        if lags[lane, k] > 0.0:
            own_times += lags[lane, k] * smooth(own_times, run.sample_time, HALF_WIDTH, 3, 1)
        found[lane, :, k] = own_times - reading
        if held and plays[lane, k] > 0.0:
            if (key := (k, late, lags[lane, k])) not in known:
                noise = run.noise[POSITION if state == "y" else f"pressure_{state[2:]}_pa"]
                known[key] = crossings(own_times, run.sample_time, noise, run.rests)
            found[lane, :, k] += play_of(known[key], plays[lane, k], *held)
    return found


def bent(model: Model, frame: Array, run: Run) -> tuple[Array, float]:
    """How far (n,) bristles are bent where the piston rests [m], and at most: they hold what else acts on it."""
    if not model.parameters.keys() >= {STIFFNESS, STATIC}:
        return np.zeros(len(frame)), 0.0
    states = np.tile(model.state(), (len(frame), 1))
    states[:, : frame.shape[1]] = frame
    states[:, 1] = 0.0
    seen = model.outputs(states, run.sampled(model.inputs), start=run.begin, sample_time=run.sample_time)
    most = model[STATIC] / model[STIFFNESS]
    return np.clip((seen["drive"] - seen["force"]) / model[STIFFNESS], -most, most), float(most)


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
            added = taken_back(model, x[None], none, (), own, run)[0]
            change, found[lane] = np.abs(added - found[lane]).max(axis=0), added
            if not np.isfinite(change).all() or np.all(change <= enough[: len(change)]):
                break
    return found


def by_role(model: Model, parameters: Array, role: str) -> Array:
    """The sum of the parameters of a role of those effects (lanes, sensed) that change the reading of each state."""
    names, sensed = list(model.parameters), model.composition.sensed
    found = np.zeros((len(parameters), len(sensed)))
    for effect in model.composition.effects:
        own = [names.index(f"{effect.name}.{key}") for key, one in effect.parameters.items() if one.role == role]
        written = {SENSED.get(signal) for signal in written_by(effect)}
        found += parameters[:, own].sum(axis=1)[:, None] * np.array([state in written for state in sensed])
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


def shifted(frame: Array, added: Array, sample_time: float) -> Array:
    """The frame (n, frame) with `added` (n, sensed) added to position and pressures, and its rate to the velocity."""
    moved: Array = frame.copy()
    moved[:, 0] += added[:, 0]
    moved[:, 1] += smooth(added[:, 0], sample_time, HALF_WIDTH, 3, 1)
    moved[:, 2:] += added[:, 1:]
    return moved
