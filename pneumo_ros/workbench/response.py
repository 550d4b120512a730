"""The response of a machine with other values: simulated from a measured state, as predictions over windows are."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import measured_columns
from pneumo_ros.plant import Model
from pneumo_ros.plant.effect import Parameter
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.start import start_states

Array = NDArray[np.float64]
REACH = 4.0  # a slider goes from a quarter to four times a value
STOPS = 100  # steps to either side of the middle
LONGEST = 10.0  # s that are simulated


@dataclass(frozen=True)
class Stretch:
    """A part of a run to simulate: its first sample, its number of samples, and the state at its start (states,)."""

    run: Run
    first: int
    samples: int
    start: Array

    @property
    def time(self) -> Array:
        """Times of the simulated samples [s]."""
        return self.run.time[self.first + 1 : self.first + self.samples + 1]


def stretch(model: Model, run: Run, begin: float, end: float) -> Stretch:
    """The part of `run` from `begin` [s], at most 10 s; its start is estimated with `model` from the data around it."""
    first = min(max(round(begin / run.sample_time), 0), max(len(run) - 50, 0))
    samples = max(min(round(min(end - begin, LONGEST) / run.sample_time), len(run) - 1 - first), 2)
    return Stretch(run, first, samples, start_states(model, run, np.array([first]))[0])


def respond(model: Model, part: Stretch) -> dict[str, Array]:
    """What the model's sensors would read over a stretch (samples,), by signal. NumericalError when it diverges."""
    run, begin = part.run, part.first * PARTS
    held = run.inputs(model.inputs)
    states = model.simulate(
        held[begin : begin + part.samples * PARTS], part.start, sample_time=run.sample_time, parts=PARTS
    )
    read = sense(model, states[None], None, held, np.array([begin]), sample_time=run.sample_time, parts=PARTS)
    return {name: read[0, :, i] for i, name in enumerate(measured_columns(model)) if name in run.judged}


def slid(value: float, stop: int, known: Parameter) -> float:
    """The value of a parameter with its slider `stop` steps from the middle, where it is `value`.

    By factors from a quarter to four; a parameter that is zero moves by its default, to either side.
    """
    moved = value * math.pow(REACH, stop / STOPS) if value else abs(known.default or 1.0) * stop / STOPS
    return min(max(moved, known.low), known.high)
