"""Many short simulations against measurements: segments of runs, whitened, as one batch of lanes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import guess_states, measured_columns
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.model import STEP
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.lead import Lead, columns

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_COARSE = 2.0 * STEP  # s
_ROWS = ("first", "start", "measured", "weight", "guess", "scale", "shown", "row", "run", "at")  # one a segment
_WRONG = 1e9  # noise deviations: limit of an error, so that its square stays finite


@dataclass(frozen=True)
class Segments:
    """Segments of equal length; arrays hold one row per segment.

    first: index of each segment's first row in `inputs` (rows, inputs), those during all segments; start [s]: time of
    inputs[0] by the clock of the segment's run; measured and weight (segments, samples, signals), weight =
    1 / noise, or 0 where nothing was measured; guess and scale (segments, states): initial states and their prior
    deviations; shown (segments, signals): sensor readings at the guess by the model that made it; columns: the states
    that the signals show.
    """

    sample_time: float
    samples: int
    inputs: Array
    first: Index
    start: Array
    measured: Array
    weight: Array
    guess: Array
    scale: Array
    shown: Array
    columns: tuple[int, ...]
    lead: Lead  # states that the command alone determines, at the start of each segment before `pick`
    row: Index  # index of each segment among those
    run: Index  # the run of each segment
    at: Index  # its first grid point in that run
    runs: tuple[Run, ...]
    parts: int = PARTS  # inputs held one after another in a sample
    step: float = STEP  # s, longest of the integration

    def __len__(self) -> int:
        return len(self.first)

    def pick(self, chosen: Index) -> "Segments":
        """Some of the segments, by index."""
        return replace(self, **{name: getattr(self, name)[chosen] for name in _ROWS})

    def joined(self, others: Sequence["Segments"]) -> "Segments":
        """These segments and `others` of the same recordings, as with guesses by other values of the model."""
        rows: dict[str, Any] = {n: np.concatenate([getattr(s, n) for s in (self, *others)]) for n in _ROWS}
        return replace(self, **rows)

    def guessed(self, model: Model) -> "Segments":
        """The same with guesses by `model`."""
        guess, scale = self.guess.copy(), self.scale.copy()
        for number in np.unique(self.run):
            rows = self.run == number
            found = guess_states(model, self.runs[number], self.at[rows])
            guess[rows], scale[rows] = found.states, found.scale
        return replace(self, guess=guess, scale=scale, shown=self.read(model, guess)[0])

    def estimated(self, model: Model) -> NDArray[np.bool_]:
        """Which states (segments, states) measurements determine at the start: not those that follow from the command.

        Where a run begins, nothing is known of the command before it: only levels and clocks are taken to be at rest.
        """
        found = np.ones(self.guess.shape, dtype=bool)
        for name, column in zip(model.composition.commanded, columns(model), strict=True):
            found[:, column] = (self.at == 0) & (name not in model.composition.memories)
        return found

    def completed(self, model: Model, states: Array, parameters: Array | None = None) -> Array:
        """States (copies * segments, states) with those that follow from the command, by the values of each lane.

        parameters (copies * segments, parameters), or None for the model's own.
        """
        if not model.composition.commanded:
            return states
        copies = self._copies(states)
        full: Array = states.copy()
        given, row = np.tile(~self.estimated(model), (copies, 1)), np.tile(self.row, copies)
        values = model.values[None] if parameters is None else parameters
        each, lanes = np.unique(values, axis=0, return_inverse=True)
        for k, own in enumerate(each):
            known = self.lead.states(model, own)[row]
            for i, column in enumerate(columns(model)):
                rows = given[:, column] & (lanes.ravel() == k)
                full[rows, column] = known[rows, i]
        return full

    def coarser(self) -> "Segments":
        """The same for integration in steps of 0.2 ms, with inputs held as long, where samples are that fine.

        This halves the work. Derivatives change by 1 %, errors by 10 % of the noise and, at breakaways from a stiff
        bristle, more. So differences must be taken between results of equal steps.
        """
        if self.sample_time / self.parts > 0.5 * _COARSE * (1.0 + 1e-6) or self.parts % 2:
            return replace(self, step=_COARSE)
        pairs = self.inputs.reshape(-1, 2, self.inputs.shape[1]).mean(axis=1)
        return replace(self, inputs=pairs, first=self.first // 2, parts=self.parts // 2, step=_COARSE)

    def from_guess(self, model: Model, states: Array, parameters: Array | None = None) -> Array:
        """Distance of states (copies * segments, states) from the guesses, in scales: (copies, segments, states).

        For measured states the readings are compared, which do not depend on the sensor effects of the model that made
        the guess.
        """
        apart = states.reshape(self._copies(states), *self.guess.shape) - self.guess
        if not model.composition.true_sensors:
            apart[..., self.columns] = self.read(model, states, parameters) - self.shown
        return np.where(self.estimated(model), apart / self.scale, 0.0)

    def seated(self, model: Model, states: Array | None = None, shown: Array | None = None) -> Array:
        """States (segments, states), with measured ones moved so that sensors read `shown` (segments, signals).

        By default, both are those of the guesses.
        """
        moved: Array = (self.guess if states is None else states).copy()
        for _ in range(0 if model.composition.true_sensors else 3):
            moved[:, self.columns] += (self.shown if shown is None else shown) - self.read(model, moved)[0]
        return moved

    def read(self, model: Model, states: Array, parameters: Array | None = None) -> Array:
        """Sensor readings at initial states (copies * segments, states): (copies, segments, signals)."""
        copies = self._copies(states)
        read = sense(
            model, states[:, None], parameters, self.inputs, np.tile(self.first, copies),
            sample_time=self.sample_time, start=np.tile(self.start - self.sample_time, copies), parts=self.parts,
        )  # fmt: skip
        return read.reshape(copies, *self.shown.shape)

    def simulate(
        self, model: Model, states: Array, parameters: Array | None = None, threads: int = 1,
        columns: Sequence[int] | None = None,
    ) -> Array:  # fmt: skip
        """(lanes, samples, states or columns) from initial states (lanes, states), lanes a multiple of the segments."""
        copies = self._copies(states)
        begin = self.completed(model, states, parameters)
        return model.simulate_lanes(
            self.inputs, begin, parameters, samples=self.samples, first=np.tile(self.first, copies),
            sample_time=self.sample_time, step=self.step, start=np.tile(self.start, copies), parts=self.parts,
            threads=threads, columns=columns,
        )  # fmt: skip

    def residuals(self, model: Model, states: Array, parameters: Array | None = None, threads: int = 1) -> Array:
        """Whitened errors (copies, segments, samples * signals), limited where predictions are not finite.

        states (copies * segments, states), parameters (copies * segments, parameters) or None for the model's own.
        """
        shape = self._copies(states), len(self), self.samples, len(self.columns)
        error = self.predicted(model, states, parameters, threads).reshape(shape)
        with np.errstate(over="ignore", invalid="ignore"):
            error -= self.measured
            error *= self.weight
        if not np.abs(error).max(initial=0.0) < _WRONG:
            error = np.clip(np.nan_to_num(error, nan=_WRONG), -_WRONG, _WRONG)
        return error.reshape(*shape[:2], shape[2] * shape[3])

    def predicted(self, model: Model, states: Array, parameters: Array | None = None, threads: int = 1) -> Array:
        """Sensor readings along all lanes (lanes, samples, signals)."""
        if model.composition.true_sensors:
            return self.simulate(model, states, parameters, threads, self.columns)
        copies = self._copies(states)
        return sense(
            model, self.simulate(model, states, parameters, threads), parameters, self.inputs,
            np.tile(self.first, copies), sample_time=self.sample_time, start=np.tile(self.start, copies),
            parts=self.parts,
        )  # fmt: skip

    def _copies(self, states: Array) -> int:
        return len(states) // len(self) if len(self) else 1


def cut(model: Model, runs: Sequence[Run], duration: float, rows: Index | None = None) -> Segments:
    """Cut runs into segments of `duration` [s], side by side and without gaps; UsageError when sample times differ.

    `rows`, ascending: indices of the segments to keep.
    """
    samples = max(round(duration / runs[0].sample_time), 2) if runs else 2
    starts = [side_by_side(run, samples) for run in runs]
    if rows is not None:
        ends = np.cumsum([len(own) for own in starts])
        chosen = np.split(rows, np.searchsorted(rows, ends[:-1]))
        starts = [own[some - end] for own, some, end in zip(starts, chosen, ends, strict=True)]
    return cut_at(model, runs, starts, samples)


def cut_at(model: Model, runs: Sequence[Run], starts: Sequence[Index], samples: int) -> Segments:
    """Segments of `samples` that begin at the given grid points of each run."""
    dt = runs[0].sample_time if runs else 1e-3
    for one in runs:
        if abs(one.sample_time / dt - 1.0) > 1e-3:
            raise UsageError(
                f"{one.name} is sampled every {one.sample_time:g} s, {runs[0].name} every {dt:g} s; "
                "resample them to one sample time"
            )
    names = measured_columns(model)
    inputs, first = _inputs(model, runs, starts, samples)
    measured, weight = [], []
    for one, begin in zip(runs, starts, strict=True):
        rows = begin[:, None] + np.arange(1, samples + 1)
        noise = one.noise
        measured.append(np.stack([one.signals[name][rows] for name in names], axis=2))
        known = np.array([0.0 if name in one.assumed else 1.0 / noise[name] for name in names])
        weight.append(one.measured[rows][:, :, None] * known)
    counts = [len(begin) for begin in starts]
    run, at = np.repeat(np.arange(len(runs)), counts), np.concatenate(starts)
    nothing = np.zeros((sum(counts), len(model.states)))
    segments = Segments(
        sample_time=dt,
        samples=samples,
        inputs=inputs,
        first=first,
        start=np.asarray(dt / PARTS * (at * PARTS - first)),
        measured=np.concatenate(measured),
        weight=np.concatenate(weight),
        guess=nothing,
        scale=nothing,
        shown=np.zeros((sum(counts), len(names))),
        columns=tuple(names.values()),
        lead=Lead(runs, run, at),
        row=np.arange(sum(counts)),
        run=run,
        at=at,
        runs=tuple(runs),
    )
    return segments.guessed(model)


def _inputs(model: Model, runs: Sequence[Run], starts: Sequence[Index], samples: int) -> tuple[Array, Index]:
    """The inputs that `cut_at` needs (rows, inputs), and the index of each segment's first row.

    They are often a few seconds out of minutes.
    """
    inputs, first, count = [], [], 0
    for run, begin in zip(runs, starts, strict=True):
        edges = np.zeros(len(run) + 1, dtype=np.int64)
        np.add.at(edges, begin, 1)
        np.add.at(edges, begin + samples, -1)
        needed = np.cumsum(edges)[: len(run) - 1] > 0  # between a grid point and the next
        held = run.inputs(model.inputs)
        inputs.append(held.reshape(-1, PARTS, held.shape[1])[needed].reshape(-1, held.shape[1]))
        first.append((count + np.concatenate([[0], np.cumsum(needed)])[begin]) * PARTS)
        count += int(needed.sum())
    return np.concatenate(inputs), np.concatenate(first)


def side_by_side(run: Run, samples: int) -> Index:
    """Grid points where segments of `samples` begin: side by side, without segments that contain a gap."""
    starts = np.arange(0, len(run) - samples, samples, dtype=np.int64)
    whole = np.array([bool(run.measured[s : s + samples + 1].all()) for s in starts], dtype=bool)
    return starts[whole] if len(starts) else starts
