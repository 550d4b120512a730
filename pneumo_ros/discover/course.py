"""Along the measured motion: the states a model claims, with what the sensors do to them taken back."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.identify.breakaway import REST
from pneumo_ros.identify.equations import centred
from pneumo_ros.identify.guess import measured_frame
from pneumo_ros.identify.noise import run_noise
from pneumo_ros.identify.run import PARTS, Run
from pneumo_ros.identify.sensors import shifted, taken_back
from pneumo_ros.plant import Model
from pneumo_ros.plant.compose import SENSED

Array = NDArray[np.float64]

BLOCK = 32  # parameter vectors driven at once: as many as fit in memory beside each other
QUICK = 2  # parts of a sample in quick evaluations: differences of two of them are as good as of two exact ones
_SETTLED = (1e-9, 1e-2, 1e-2)  # m, Pa: far below the differences of variants that are compared
_SLIP = 6.0  # noise deviations of the position: a piston that stays within them rests


@dataclass(frozen=True)
class Frame:
    """What a run says of the frame's states: measured ones with smoothed velocity (n, 2 or 4)."""

    run: Run
    states: Array


def frame_of(run: Run, force_driven: bool) -> Frame:
    """Measured position, smoothed velocity and measured pressures; a piston at rest has exactly no velocity."""
    states = measured_frame(run, force_driven)
    states[resting(run), 1] = 0.0
    return Frame(run, states)


def resting(run: Run) -> NDArray[np.bool_]:
    """Samples (n,) within stretches of 0.15 s or more in which the position stays within its noise."""
    width = max(round(REST / run.sample_time), 2)
    slip = _SLIP * run_noise(run)["position_m"]
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
    """States and claimed mean derivatives (n, states) of the model itself, the latter centred at the samples."""
    states, mean = _drive(model, frame.run, frame.states, _held(frame.run))
    return states, centred(mean)


def follow_each(model: Model, frame: Frame, parameters: Array) -> Iterator[tuple[int, Array, Array]]:
    """For each parameter vector, in any order: its index, states (n, states), claimed derivatives of v, p_a, p_b.

    Where the vector makes sensors differ from the states, the measured states are first corrected for what it claims
    the sensors do: x = measured - (observed(x) - x), twice.
    """
    corrects = sensing(model, parameters)
    for own, shared in ((np.flatnonzero(~corrects), True), (np.flatnonzero(corrects), False)):
        for rows in (own[k : k + BLOCK] for k in range(0, len(own), BLOCK)):
            states, mean = _drive_lanes(model, frame.run, frame.states, parameters[rows])
            if not shared:
                states, mean = _corrected(model, frame, parameters[rows], states, mean)
            for k, x, m in zip(rows, states, mean, strict=True):
                yield int(k), x, centred(m)


def _corrected(model: Model, frame: Frame, parameters: Array, states: Array, mean: Array) -> tuple[Array, Array]:
    """Lanes driven anew along the measured states less what sensors do, by a fixed point of two steps at most.

    Each lane stops by itself: what it gives does not depend on those beside it.
    """
    moving, before = np.arange(len(states)), np.zeros((len(states), 1, 1))
    for _ in range(2):
        shift = taken_back(model, states[moving], parameters[moving], frame.run)
        still = np.any(np.abs(shift - before).max(axis=1) > _SETTLED[: shift.shape[-1]], axis=1)
        moving, before = moving[still], shift[still]
        if not len(moving):
            break
        given = np.stack([shifted(frame.states, own, frame.run.sample_time) for own in before])
        states[moving], mean[moving] = _drive_lanes(model, frame.run, given, parameters[moving])
    return states, mean


def _drive_lanes(model: Model, run: Run, given: Array, parameters: Array) -> tuple[Array, Array]:
    step = 1.01 * run.sample_time / QUICK
    rest = model.state()[given.shape[-1] :]
    columns = ("v",) if model.force_driven else ("v", "p_a", "p_b")
    return model.follow_lanes(
        given, _held(run), rest, parameters, sample_time=run.sample_time, parts=QUICK, step=step, columns=columns
    )


def _held(run: Run) -> Array:
    """The input over halves of a sample: short enough for differences of variants."""
    return np.asarray(run.input.reshape(-1, QUICK, PARTS // QUICK).mean(axis=2).ravel())


def _drive(model: Model, run: Run, given: Array, held: Array) -> tuple[Array, Array]:
    step = 1.01 * run.sample_time / QUICK
    rest = model.state()[given.shape[1] :]
    return model.follow(given, held, rest, sample_time=run.sample_time, parts=QUICK, step=step)


def sensing(model: Model, parameters: Array) -> NDArray[np.bool_]:
    """Which parameter vectors (variants, parameters) make any sensor of the model show something else than a state."""
    found = np.zeros(len(parameters), dtype=bool)
    names = list(model.parameters)
    for effect in model.composition.effects:
        if any(signal in SENSED for function in effect.functions.values() for signal in function.writes):
            fading = [(f"{effect.name}.{key}", p.neutral) for key, p in effect.parameters.items()]
            acts = [parameters[:, names.index(name)] != neutral for name, neutral in fading if neutral is not None]
            found |= np.any(acts, axis=0) if acts else True
    return found
