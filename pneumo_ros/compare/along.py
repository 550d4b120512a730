"""The model along the measured motion: the claims of its equations, sample by sample, at the measured states."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.equations import drive_along
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.runs.run import Run
from pneumo_ros.runs.sensors import driven
from pneumo_ros.runs.smooth import HALF_WIDTH, noise_gain

Array = NDArray[np.float64]

_SLOWEST = 1e-3  # m/s: a slower piston rests, however good the sensor
_DEVIATIONS = 4.0  # of the estimated velocity: below, motion cannot be distinguished from noise


@dataclass(frozen=True)
class Along:
    """One run with the model's claims beside it; arrays (n,) on the run's grid, SI units."""

    run: Run
    velocity: Array  # local polynomials over +-12 ms
    rest_below: float  # m/s: slower cannot be distinguished from rest
    input: Array  # V, or N when force-driven: held from each sample on
    seen: dict[str, Array]  # `Model.outputs` along the measured states
    reach: float  # m, half the stroke
    chambers: tuple[Chamber, ...]  # of the machine


def along(model: Model, run: Run) -> Along:
    """Drive the model's own states (bristles, spool) along the measured ones and compute its outputs."""
    states, _ = driven(model, run.smoothed.states(model.chambers), run)
    spread = run.noise["position_m"] * noise_gain(run.sample_time, HALF_WIDTH, 3, 1)
    return Along(
        run=run,
        velocity=states[:, 1],
        rest_below=max(_SLOWEST, _DEVIATIONS * spread),
        input=drive_along(model, run, states) if model.force_driven else np.append(run.held, run.held[-1]),
        seen=model.outputs(states, run.sampled(model.inputs), sample_time=run.sample_time),
        reach=0.5 * model["piston.stroke"],
        chambers=model.chambers,
    )
