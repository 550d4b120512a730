"""The mechanics alone: piston, friction and load driven by the measured pressures.

Without the chambers' equations a short simulation from rest through a breakaway or a reversal depends on friction and
load only. It shows the millimetre between sticking and sliding, which no equation along the motion shows.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.sensors import corrected
from pneumo_ros.shooting.segments import Segments, cut, side_by_side

Array = NDArray[np.float64]

LENGTH = 0.3  # s
MOST_EVENTS = 40  # segments: more take longer, and change friction by less than its deviation
_SLOW, _MOVED = 0.004, 3e-4  # m/s and m: the slowest speed of an event is smaller, its travel is larger
_LAG = 0.025  # s


def driven_by_pressures(model: Model, run: Run) -> Run:
    """The run as that of an axis driven by its measured pressures, corrected for the model's pressure sensors."""
    if model.force_driven:
        return run
    states = np.tile(model.state(), (len(run), 1))
    states[:, : model.frame] = corrected(model, measured_frame(run, model.chambers), run)
    force, n = model.outputs(states, run.sampled(model.inputs))["drive"], len(run)
    cells = np.repeat(np.arange(n - 1), PARTS) + np.tile((np.arange(PARTS) + 0.5) / PARTS, n - 1)
    held, *pressures = (np.interp(cells, np.arange(n), one) for one in (force, *states[:, 2 : model.frame].T))
    further = {**run.further, **{one.state: p for one, p in zip(model.chambers, pressures, strict=True)}}
    return replace(run, input=held, further=further, force_driven=True, pressure_a=None, pressure_b=None)


def event_rows(runs: Sequence[Run], most: int = MOST_EVENTS) -> NDArray[np.int64]:
    """Which of the side-by-side segments of `runs` hold a breakaway, a stop or a reversal; spread evenly."""
    if not runs:
        return np.arange(0)
    dt = runs[0].sample_time
    samples, lag = max(round(LENGTH / dt), 2), max(round(_LAG / dt), 1)
    y = np.concatenate([run.position[side_by_side(run, samples)[:, None] + np.arange(1, samples + 1)] for run in runs])
    speed = np.abs(y[:, lag:] - y[:, :-lag]) / (lag * dt)
    found = np.flatnonzero((speed.min(axis=1) < _SLOW) & (np.ptp(y, axis=1) > _MOVED))
    if len(found) > most:
        found = found[np.linspace(0, len(found) - 1, most).astype(int)]
    return found


def events(model: Model, runs: Sequence[Run], rows: NDArray[np.int64]) -> Segments:
    """Those segments, with first guesses by `model`."""
    return cut(model, runs, LENGTH, rows)
