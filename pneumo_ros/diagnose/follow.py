"""The states a model claims along the measured motion, corrected for the model's sensor effects."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.lanes import acting_in
from pneumo_ros.plant.reach import fades, read_by, written_by
from pneumo_ros.runs.readings import (
    differing,
    must_drive,
    neutral_of,
    others_of,
    parameters_of,
    read_from,
    reads_wrong,
    sensing,
)
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.sensors import QUICK, SHORT, at_rest, corrected_lanes, longest_step, parts_of, shifted

Array = NDArray[np.float64]
Index = NDArray[np.int64]

LANES_AT_ONCE = 16  # parameter vectors driven at once: more take memory, and no less time
_SETTLED = (1e-9, 1e-2, 1e-2)  # m, Pa: far below the differences of variants that are compared


@dataclass(frozen=True)
class Frame:
    """The measured states in a run, with smoothed velocity (n, 2 + chambers)."""

    run: Run
    chambers: tuple[Chamber, ...]
    states: Array


def frame_of(run: Run, chambers: Sequence[Chamber]) -> Frame:
    """Measured position, smoothed velocity and pressures of these chambers; the velocity at rest is exactly 0."""
    states = measured_frame(run, chambers)
    states[run.rests, 1] = 0.0
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
    corrects, lags = sensing(model, parameters), must_drive(model, parameters)
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
    none = np.zeros((len(first), len(frame.states), len(model.composition.sensed)))
    for k, shift in enumerate(at_rest(model, frame.states, none, parameters[own[first]], frame.run, _SETTLED)):
        reads = np.isfinite(shift).all()
        given[own[group == k]] = shifted(frame.states, shift, frame.run.sample_time) if reads else np.nan
    found[own] = own[first][group]
    return given, found


def _moving(model: Model, parameters: Array) -> list[str]:
    """States of effects of which one acts by any of the parameter vectors (lanes, parameters)."""
    acts = np.any(acting_in(model.composition.effects, parameters), axis=0).tolist()
    owned = list(zip(model.states, model.owners.tolist(), strict=True))[model.frame :]
    return [name for name, owner in owned if owner < 0 or acts[owner]]


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


def alike_sensors(model: Model, parameters: Array) -> tuple[Index, Index]:
    """Parameter vectors (variants, parameters) in groups of equal sensors: the first of each group, and the groups.

    Sensors that read more than parameters, the frame's states and their own states may differ in every lane.
    """
    columns: list[int] = []
    keys = [name.partition(".")[2] for name in model.parameters]
    for effect in filter(reads_wrong, model.composition.effects):
        reads, others = read_from(effect), others_of(effect)
        if not others <= parameters_of(model):
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
    watching = any(not reads_wrong(effect) and read_by(effect) & SENSED.keys() for effect in effects)
    neutral = [neutral_of(effect, read_from(effect)) for effect in filter(reads_wrong, effects)]
    if watching or not neutral or not all(neutral):
        return parameters
    found = np.array(parameters)
    for name, value in (item for one in neutral for item in one.items()):
        found[:, names.index(name)] = value
    return found


def adding_mass(model: Model, parameters: Array) -> NDArray[np.bool_]:
    """Parameter vectors (variants, parameters) by which an effect of the model may add to the moving mass."""
    found = np.zeros(len(parameters), dtype=bool)
    for effect in (one for one in model.composition.effects if "added_mass" in written_by(one)):
        found |= differing(model, parameters, neutral_of(effect, effect.parameters) if fades(effect) else {})
    return found
