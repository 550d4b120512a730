"""The states a model claims along the measured motion, corrected for the model's sensor effects."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import REST
from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.plant.commanded import readings_from
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.effect import Effect
from pneumo_ros.plant.lanes import acting_in
from pneumo_ros.plant.reach import fades
from pneumo_ros.plant.signals import SIGNALS
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.sensors import QUICK, SHORT, at_rest, corrected_lanes, longest_step, parts_of, shifted

Array = NDArray[np.float64]
Index = NDArray[np.int64]

LANES_AT_ONCE = 16  # parameter vectors driven at once: more take memory, and no less time
_SETTLED = (1e-9, 1e-2, 1e-2)  # m, Pa: far below the differences of variants that are compared
_SLIP = 6.0  # noise deviations of the position: a piston that moves less rests


@dataclass(frozen=True)
class Frame:
    """The measured states in a run, with smoothed velocity (n, 2 + chambers)."""

    run: Run
    chambers: tuple[Chamber, ...]
    states: Array


def frame_of(run: Run, chambers: Sequence[Chamber]) -> Frame:
    """Measured position, smoothed velocity and pressures of these chambers; the velocity at rest is exactly 0."""
    states = measured_frame(run, chambers)
    states[resting(run), 1] = 0.0
    return Frame(run, tuple(chambers), states)


def noisier(frame: Frame) -> Frame:
    """The frame of the run with the noise of its sensors added once more; what rests still rests."""
    run, draw = frame.run, np.random.default_rng(0)
    again: dict[str, Any] = {
        name.rpartition("_")[0]: signal + draw.normal(0.0, run.noise[name], len(signal))
        for name, signal in run.signals.items()
    }
    states = measured_frame(replace(run, **again), frame.chambers)
    states[frame.states[:, 1] == 0.0, 1] = 0.0
    return Frame(run, frame.chambers, states)


def resting(run: Run) -> NDArray[np.bool_]:
    """Samples (n,) within stretches of 0.15 s or more in which the position stays within its noise."""
    width = max(round(REST / run.sample_time), 2)
    slip = _SLIP * run.noise["position_m"]
    still = np.zeros(len(run), dtype=bool)
    if len(run) < width:
        return still
    every = np.lib.stride_tricks.sliding_window_view(run.position, width)
    quiet = np.flatnonzero(every.max(axis=1) - every.min(axis=1) < 2.0 * slip)
    marks = np.zeros(len(run) + 1)
    np.add.at(marks, quiet, 1.0)
    np.add.at(marks, quiet + width, -1.0)
    return np.asarray(np.cumsum(marks)[:-1] > 0.0)


def follow(model: Model, frame: Frame) -> tuple[Array, Array]:
    """States (n, states) of the model itself, and its claimed derivatives, means over the interval before a sample."""
    parts = parts_of(model)
    return _drive(model, frame.run, frame.states, frame.run.averaged(model.inputs, parts), parts)


@dataclass(frozen=True)
class Followed:
    """A run by one parameter vector: its index, its states, and claimed derivatives of v and each pressure.

    frame (n, 2 + chambers): the measured states, corrected for sensors; own (n, columns): states in these `columns`;
    rest (states,): all others stay as they begin. claimed (n, 1 + chambers): means over the interval before a sample.
    `along`: index of a vector whose sensors read the same, so that the frame's states are alike; None: as measured.
    """

    index: int
    frame: Array
    own: Array
    columns: Index
    rest: Array
    claimed: Array
    along: int | None

    def states(self, rows: Index) -> Array:
        """All states (rows, states) at some samples."""
        found = np.tile(self.rest, (len(rows), 1))
        found[:, : self.frame.shape[1]] = self.frame[rows]
        found[:, self.columns] = self.own[rows]
        return found


def follow_each(model: Model, frame: Frame, parameters: Array, ranking: bool = False) -> Iterator[Followed]:
    """States and claimed derivatives of a run by each parameter vector; those along the same states one after another.

    Where a vector has sensor effects, the measured states are first corrected for them: at once, or where a sensor has
    states of its own, which have to be driven, by x = measured - (observed(x) - x), twice. `ranking`: only as exact as
    the ranking of candidates needs: a short sample is one part, with an error of 1 % of an effect.
    """
    parts = parts_of(model, 1 if ranking and frame.run.sample_time < SHORT else QUICK)
    corrects, lags = sensing(model, parameters), sensing(model, parameters, with_states=True)
    rest, plain = model.state(), unsensed(model, parameters)
    for rows in [*_some(np.flatnonzero(~lags)), *_some(np.flatnonzero(lags))]:
        late = bool(lags[rows[0]])
        own = _moving(model, plain[rows])
        columns = np.array([model.states.index(name) for name in own], dtype=np.int64)
        if late:
            given, first = _corrected(model, frame, parameters[rows], parts)
        else:
            given, first = _at_once(model, frame, parameters[rows], corrects[rows])
        true = not late or plain is not parameters
        states, mean = _drive_lanes(model, frame.run, given, plain[rows], parts, own, true_sensors=true)
        for j in np.argsort(first, kind="stable"):
            seen = given if given.ndim == 2 else given[j]
            along = int(rows[first[j]]) if first[j] >= 0 else None
            yield Followed(int(rows[j]), seen, states[j], columns, rest, mean[j], along)


def _at_once(model: Model, frame: Frame, parameters: Array, corrects: NDArray[np.bool_]) -> tuple[Array, Index]:
    """Frame states (n, frame), or (lanes, n, frame) where sensors differ, without what sensors add at once.

    And the first lane (lanes,) of each group of equal sensors; of lanes whose sensors read right, -1.
    """
    found = np.full(len(parameters), -1)
    if not corrects.any():
        return frame.states, found
    given, own = np.repeat(frame.states[None], len(parameters), axis=0), np.flatnonzero(corrects)
    first, group = alike_sensors(model, parameters[own])
    for k, lane in enumerate(own[first]):
        none = np.zeros((1, len(frame.states), len(model.composition.sensed)))
        shift = at_rest(model, frame.states, none, parameters[lane : lane + 1], frame.run, _SETTLED)[0]
        reads = np.isfinite(shift).all()
        given[own[group == k]] = shifted(frame.states, shift, frame.run.sample_time) if reads else np.nan
    found[own] = own[first][group]
    return given, found


def _moving(model: Model, parameters: Array) -> list[str]:
    """States of effects of which one acts by any of the parameter vectors (lanes, parameters)."""
    fading = [effect for effect in model.composition.effects if fades(effect)]
    acts = acting_in(model.composition.effects, parameters)
    still = {name for effect, own in zip(fading, acts.T, strict=True) if not own.any() for name in effect.states}
    return [name for name in model.states[model.frame :] if name not in still]


def _some(own: Index) -> Iterator[Index]:
    return (own[k : k + LANES_AT_ONCE] for k in range(0, len(own), LANES_AT_ONCE))


def _corrected(model: Model, frame: Frame, parameters: Array, parts: int) -> tuple[Array, Index]:
    """As `_at_once`, where sensors have states of their own: these are driven, once for each group of equal sensors."""
    first, group = alike_sensors(model, parameters)
    own, names = parameters[first], _moving(model, parameters[first])
    given = corrected_lanes(
        model, frame.states, frame.run, own,
        lambda states, lanes: _drive_lanes(model, frame.run, states, own[lanes], parts, names)[0], names, _SETTLED,
    )  # fmt: skip
    return given[0] if len(first) == 1 else given[group], first[group]


def _drive_lanes(
    model: Model, run: Run, given: Array, parameters: Array, parts: int, states: Sequence[str],
    true_sensors: bool = False,
) -> tuple[Array, Array]:  # fmt: skip
    """The states named (lanes, n, states), and claimed derivatives of lanes driven along given states."""
    step = longest_step(model, run, parts, true_sensors)
    rest = model.state()[given.shape[-1] :]
    columns = ("v", *(chamber.state for chamber in model.chambers))
    held = run.averaged(model.inputs, parts)
    return model.follow_lanes(
        given, held, rest, parameters, sample_time=run.sample_time, step=step, start=run.begin, parts=parts,
        states=states, columns=columns, passing=True,
    )  # fmt: skip


def _drive(model: Model, run: Run, given: Array, held: Array, parts: int) -> tuple[Array, Array]:
    step = longest_step(model, run, parts)
    rest = model.state()[given.shape[1] :]
    return model.follow(given, held, rest, sample_time=run.sample_time, step=step, start=run.begin, parts=parts)


def reads_wrong(effect: type[Effect]) -> bool:
    """Whether an effect makes a sensor differ from its state."""
    return any(signal in SENSED for function in effect.functions.values() for signal in function.writes)


def read_from(effect: type[Effect]) -> frozenset[str]:
    """What the readings of an effect's sensors depend on: not what else it does, as a play before the load."""
    return readings_from(effect, SENSED)


def alike_sensors(model: Model, parameters: Array) -> tuple[Index, Index]:
    """Parameter vectors (variants, parameters) in groups of equal sensors: the first of each group, and the groups.

    Sensors that read more than parameters, the frame's states and their own states may differ in every lane.
    """
    frame = {"y", "v", *SENSED, *SENSED.values()}
    columns: list[int] = []
    keys = [name.partition(".")[2] for name in model.parameters]
    for effect in filter(reads_wrong, model.composition.effects):
        reads = read_from(effect)
        others = reads - frame - set(effect.states) - set(effect.parameters)
        if not others <= {*keys} - {*SIGNALS, *model.states}:
            return np.arange(len(parameters)), np.arange(len(parameters))
        own = [f"{effect.name}.{key}" for key in effect.parameters if key in reads]
        columns += [k for k, name in enumerate(model.parameters) if name in own]
        columns += [k for k, key in enumerate(keys) if key in others]
    _, first, group = np.unique(parameters[:, columns], axis=0, return_index=True, return_inverse=True)
    return first, np.ravel(group)


def unsensed(model: Model, parameters: Array) -> Array:
    """Parameter vectors (variants, parameters) with true sensors: what else a machine does along corrected states.

    The same ones where other effects read the sensors, as a drive that follows the measured position, or where a sensor
    effect cannot be neutral.
    """
    names, effects = list(model.parameters), model.composition.effects
    wrong = [effect for effect in effects if reads_wrong(effect)]
    read = {
        name for one in effects if one not in wrong for function in one.functions.values() for name in function.reads
    }
    neutral = [_neutral(effect) for effect in wrong]
    if not wrong or read & {*SENSED} or not all(neutral):
        return parameters
    found = np.array(parameters)
    for name, value in (item for one in neutral for item in one.items()):
        found[:, names.index(name)] = value
    return found


def _neutral(effect: type[Effect]) -> dict[str, float]:
    """By dotted name, the neutral values of the parameters by which an effect makes a sensor differ from its state."""
    own = read_from(effect)
    fading = [(key, p.neutral) for key, p in effect.parameters.items() if key in own]
    return {f"{effect.name}.{key}": neutral for key, neutral in fading if neutral is not None}


def sensing(model: Model, parameters: Array, with_states: bool = False) -> NDArray[np.bool_]:
    """Which parameter vectors (variants, parameters) make any sensor of the model differ from its state.

    `with_states`: of sensors whose readings depend on more than parameters and the frame's states, as a late one.
    """
    found = np.zeros(len(parameters), dtype=bool)
    names = list(model.parameters)
    keys = {name.partition(".")[2] for name in names} - {*SIGNALS, *model.states}
    for effect in filter(reads_wrong, model.composition.effects):
        own = read_from(effect)
        if with_states and own <= {"y", "v", *SENSED, *SENSED.values(), *effect.parameters, *keys}:
            continue
        acts = [parameters[:, names.index(name)] != neutral for name, neutral in _neutral(effect).items()]
        found |= np.any(acts, axis=0) if acts else True
    return found
