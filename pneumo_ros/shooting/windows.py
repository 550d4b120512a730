"""Prediction windows: how far the model runs from the measurement within a given horizon."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.equations import centred
from pneumo_ros.equations.guess import measured_columns, measured_frame
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.plant.reach import read_by
from pneumo_ros.plant.sensing import sense
from pneumo_ros.runs.run import METERED, PARTS, Run
from pneumo_ros.runs.sensors import driven
from pneumo_ros.shooting.segments import side_by_side
from pneumo_ros.shooting.start import start_states

Array = NDArray[np.float64]

HORIZON, SHORTER = 1.0, (0.5, 0.2, 0.1, 0.05)  # s


@dataclass(frozen=True)
class Prediction:
    """Simulated against measured over windows: grid index of each window's start, and errors by signal name.

    errors[name] has shape (windows, samples), the model's sensor reading minus the measurement in the signal's unit;
    where the motion is imposed, the force that it takes by the model minus the measured one; NaN where nothing was
    measured. Row i covers the grid points start[i] + 1 ... start[i] + samples.
    """

    start: NDArray[np.int64]
    sample_time: float
    errors: dict[str, Array]
    states: Array  # (windows, samples, states)


def fitting_horizon(runs: Sequence[Run], wanted: float | None = None) -> float:
    """Length [s] of the windows in which the runs are predicted: `wanted`, or 1 s, or less where a run is shorter.

    Or where one has no whole second between its gaps. Raises UsageError for a length that is not positive, or that a
    run does not have.
    """
    shortest = min(runs, key=lambda run: len(run) * run.sample_time)
    lasts = (len(shortest) - 1) * shortest.sample_time
    if wanted is None:
        some = (h for h in (HORIZON, *SHORTER) if h <= 0.95 * lasts and all(_holds(run, h) for run in runs))
        return next(some, min(SHORTER[-1], 0.95 * lasts))
    if not 0.0 < wanted < np.inf:
        raise UsageError(f"--horizon {wanted:g} is not a length of time; give seconds, such as --horizon 1")
    if wanted > lasts:
        raise UsageError(
            f"--horizon {wanted:g} is longer than {shortest.name}, which lasts {lasts:.3g} s; give a shorter one, or "
            "leave that recording out"
        )
    return wanted


def _holds(run: Run, horizon: float) -> bool:
    samples = round(horizon / run.sample_time)
    return samples >= 2 and len(side_by_side(run, samples)) > 0


def predict(model: Model, run: Run, horizon: float) -> Prediction:
    """Predict a run in windows of `horizon` [s], each from a start estimated around its first sample.

    Raises UsageError when the run holds no window of this length.
    """
    samples = round(min(len(run), horizon / run.sample_time))
    if samples < 2:
        raise UsageError(
            f"a horizon of {horizon:g} s holds fewer than two samples of {run.name}, {run.sample_time:.3g} s apart; "
            "give a longer --horizon"
        )
    starts = side_by_side(run, samples)
    if not len(starts):
        raise UsageError(
            f"{run.name} has no window of {horizon:g} s without a gap in its {run.time[-1]:.3g} s; "
            "give a shorter --horizon"
        )
    return _predict_from(model, run, starts, samples)


def free_run(model: Model, run: Run) -> Prediction:
    """Simulate the whole run from its first sample alone; where the state diverges, errors are not finite."""
    return _predict_from(model, run, np.zeros(1, dtype=np.int64), len(run) - 1)


def _predict_from(model: Model, run: Run, starts: NDArray[np.int64], samples: int) -> Prediction:
    if run.imposed and model.force_driven:
        return _force_along(model, run, starts, samples)
    held = run.inputs(model.inputs)
    states = model.simulate_lanes(
        held, start_states(model, run, starts), samples=samples, first=starts * PARTS,
        sample_time=run.sample_time, parts=PARTS,
    )  # fmt: skip
    read = sense(model, states, None, held, starts * PARTS, sample_time=run.sample_time, parts=PARTS)
    rows = starts[:, None] + np.arange(1, samples + 1)
    hidden = np.where(run.measured[rows], 0.0, np.nan)
    errors = {
        name: read[:, :, i] - run.signals[name][rows] + hidden
        for i, name in enumerate(measured_columns(model))
        if name in run.judged
    }
    if METERED in model.composition.measured:
        errors["flow_a_kg_s"] = _flow(model, run, states, rows) - run.judged["flow_a_kg_s"][rows] + hidden
    return Prediction(starts, run.sample_time, errors, states)


def _flow(model: Model, run: Run, states: Array, rows: NDArray[np.int64]) -> Array:
    """The flow into chamber a (windows, samples) [kg/s] by the law of the valve, whatever the model takes from a meter.

    So models with and without an effect that reads the flow meter are judged by the same signals.
    """
    readers = {one.name for one in model.composition.effects if METERED in read_by(one)}
    law = model.with_effects(name for name in model.effects if name not in readers) if readers else model
    inputs = run.sampled(law.inputs)[rows].reshape(-1, len(law.inputs))
    flow = law.outputs(states.reshape(-1, states.shape[2]), inputs)["port_flow_a"]
    return flow.reshape(states.shape[:2])


def _force_along(model: Model, run: Run, starts: NDArray[np.int64], samples: int) -> Prediction:
    """The force that the imposed motion takes by the model: F + M (a - a_model), with the measured F and a."""
    states, mean = driven(model, measured_frame(run, ()), run)
    mass = model["piston.mass"] + model.outputs(states, run.sampled(model.inputs))["added_mass"]
    error = mass * (run.smoothed.acceleration - centred(mean)[:, 1])
    rows = starts[:, None] + np.arange(1, samples + 1)
    hidden = np.where(run.measured[rows], 0.0, np.nan)
    return Prediction(starts, run.sample_time, {"force_n": error[rows] + hidden}, states[rows])
