"""Many short simulations against measurements: segments of runs, whitened, as one batch of lanes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.identify.guess import guess_states, measured_columns
from pneumo_ros.identify.noise import run_noise
from pneumo_ros.identify.run import PARTS, Run
from pneumo_ros.plant import Model
from pneumo_ros.plant.sensing import sense

Array = NDArray[np.float64]
Index = NDArray[np.int64]

PROBE = 1e-2  # scales: step of finite differences
_WRONG = 1e9  # noise deviations: the most an error counts, so that its square stays a number


@dataclass(frozen=True)
class Segments:
    """Segments of equal length; arrays hold one row per segment.

    first: index of each segment's first entry in `voltage`, the inputs of all runs one after another; start [s]: when
    voltage[0] would be by the clock of the segment's run; measured and
    weight (segments, samples, signals), weight = 1 / noise, or 0 where nothing was measured; guess and scale
    (segments, states): initial states and their prior deviations; shown (segments, signals): what sensors read at the
    guess, so as the model then was; columns: the states that the signals show.
    """

    sample_time: float
    samples: int
    voltage: Array
    first: Index
    start: Array
    measured: Array
    weight: Array
    guess: Array
    scale: Array
    shown: Array
    columns: tuple[int, ...]
    run: Index  # which run each segment is from

    def __len__(self) -> int:
        return len(self.first)

    def pick(self, chosen: Index) -> "Segments":
        """Some of the segments, by index."""
        rows = ("first", "start", "measured", "weight", "guess", "scale", "shown", "run")
        return replace(self, **{name: getattr(self, name)[chosen] for name in rows})

    def probes(self, states: Array) -> Array:
        """States (states * segments, states), each entry in turn moved by `PROBE` of its scale: lanes of a Jacobian."""
        moved = np.tile(states, (states.shape[1], 1, 1))
        for j in range(states.shape[1]):
            moved[j, :, j] += PROBE * self.scale[:, j]
        return moved.reshape(-1, states.shape[1])

    def from_guess(self, model: Model, states: Array, parameters: Array | None = None) -> Array:
        """How far states (copies * segments, states) are from the guesses, in scales: (copies, segments, states).

        For the measured ones it is the readings that are compared, which do not depend on what the sensors' effects
        were taken to be when the guess was made.
        """
        apart = states.reshape(-1, *self.guess.shape) - self.guess
        if not model.composition.true_sensors:
            apart[..., self.columns] = self._read_at_start(model, states, parameters) - self.shown
        return np.asarray(apart / self.scale)

    def seated(self, model: Model) -> Array:
        """The guesses (segments, states), with the measured states moved to where the sensors of `model` show them."""
        states: Array = self.guess.copy()
        for _ in range(0 if model.composition.true_sensors else 3):
            states[:, self.columns] += self.shown - self._read_at_start(model, states)[0]
        return states

    def _read_at_start(self, model: Model, states: Array, parameters: Array | None = None) -> Array:
        copies = len(states) // max(len(self), 1)
        read = sense(
            model, states[:, None], parameters, self.voltage, np.tile(self.first, copies),
            sample_time=self.sample_time, start=np.tile(self.start - self.sample_time, copies), parts=PARTS,
        )  # fmt: skip
        return read.reshape(-1, *self.shown.shape)

    def simulate(self, model: Model, states: Array, parameters: Array | None = None, threads: int = 1) -> Array:
        """(lanes, samples, states) from initial states (lanes, states), lanes a multiple of the segments."""
        copies = len(states) // len(self)
        return model.simulate_lanes(
            self.voltage, states, parameters, samples=self.samples, first=np.tile(self.first, copies),
            sample_time=self.sample_time, start=np.tile(self.start, copies), parts=PARTS, threads=threads,
        )  # fmt: skip

    def residuals(self, model: Model, states: Array, parameters: Array | None = None, threads: int = 1) -> Array:
        """Whitened errors (copies, segments, samples * signals); predictions that left the finite count as very wrong.

        states (copies * segments, states), parameters (copies * segments, parameters) or None for the model's own.
        """
        copies = len(states) // len(self)
        predicted = sense(
            model, self.simulate(model, states, parameters, threads), parameters, self.voltage,
            np.tile(self.first, copies), sample_time=self.sample_time, start=np.tile(self.start, copies), parts=PARTS,
        ).reshape(copies, len(self), self.samples, -1)  # fmt: skip
        error = ((predicted - self.measured) * self.weight).reshape(copies, len(self), -1)
        return np.clip(np.nan_to_num(error, nan=_WRONG), -_WRONG, _WRONG)


def cut(model: Model, runs: Sequence[Run], duration: float) -> Segments:
    """Cut runs into segments of `duration` [s], side by side and without gaps; UsageError when sample times differ."""
    samples = max(round(duration / runs[0].sample_time), 2) if runs else 2
    return cut_at(model, runs, [side_by_side(run, samples) for run in runs], samples)


def cut_at(model: Model, runs: Sequence[Run], starts: Sequence[Index], samples: int) -> Segments:
    """Segments of `samples` that begin at the given grid points of each run."""
    dt = runs[0].sample_time if runs else 1e-3
    for run in runs:
        if abs(run.sample_time / dt - 1.0) > 1e-3:
            raise UsageError(
                f"{run.name} is sampled every {run.sample_time:g} s, {runs[0].name} every {dt:g} s; "
                "lay them on one grid"
            )
    names = measured_columns(model)
    offsets = np.cumsum([0, *(len(run.input) for run in runs)])
    measured, weight = [], []
    for run, begin in zip(runs, starts, strict=True):
        rows = begin[:, None] + np.arange(1, samples + 1)
        noise = run_noise(run)
        measured.append(np.stack([run.signals[name][rows] for name in names], axis=2))
        weight.append(run.measured[rows][:, :, None] / np.array([noise[name] for name in names]))
    guesses = [guess_states(model, run, begin) for run, begin in zip(runs, starts, strict=True)]
    counts = [len(begin) for begin in starts]
    segments = Segments(
        sample_time=dt,
        samples=samples,
        voltage=np.concatenate([run.input for run in runs]),
        first=np.concatenate([b * PARTS + o for b, o in zip(starts, offsets[:-1], strict=True)]).astype(np.int64),
        start=np.repeat(-dt / PARTS * offsets[:-1], counts),
        measured=np.concatenate(measured),
        weight=np.concatenate(weight),
        guess=np.concatenate([guess.states for guess in guesses]),
        scale=np.concatenate([np.tile(guess.scale, (len(guess.states), 1)) for guess in guesses]),
        shown=np.zeros((sum(counts), len(names))),
        columns=tuple(names.values()),
        run=np.repeat(np.arange(len(runs)), counts),
    )
    return replace(segments, shown=segments._read_at_start(model, segments.guess)[0])


def side_by_side(run: Run, samples: int) -> Index:
    """Grid points where segments of `samples` begin: side by side, without those that a gap cuts."""
    starts = np.arange(0, len(run) - samples, samples, dtype=np.int64)
    whole = np.array([bool(run.measured[s : s + samples + 1].all()) for s in starts], dtype=bool)
    return starts[whole] if len(starts) else starts
