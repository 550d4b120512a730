"""Residuals of the model's equations along the measured signals, in weak form: no measured signal is differentiated.

The equations themselves, their noise and usable windows are those of `equations.equations`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.bump import Bump
from pneumo_ros.equations.equations import Balance, Momentum, drive_along, measured_throughout, moving_mass
from pneumo_ros.equations.guess import measured_frame
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import Chamber
from pneumo_ros.runs.run import Run, check_position
from pneumo_ros.runs.sensors import driven

Array = NDArray[np.float64]

MOMENTUM_WINDOW, CHAMBER_WINDOW = 0.1, 0.2  # s
FORCE_WINDOW = 0.02  # s: so short that the error is that of the force itself


@dataclass(frozen=True)
class Residual:
    """Residual of one equation in consecutive windows: measured minus claimed by the model."""

    equation: str  # momentum, chamber_a or chamber_b
    unit: str
    time: Array  # (windows,) centres [s]
    value: Array  # (windows,) in `unit`
    noise: Array  # (windows,) standard deviation by sensor noise and the error of sums over samples, in `unit`

    @property
    def rms(self) -> float:
        """Root mean square of the residual."""
        return float(np.sqrt(np.mean(self.value**2))) if len(self.value) else float("nan")

    @property
    def ratio_to_noise(self) -> float:
        """Root mean square of residual over noise: 1 where noise alone explains it."""
        return float(np.sqrt(np.mean((self.value / self.noise) ** 2))) if len(self.value) else float("nan")


def equation_residuals(model: Model, run: Run) -> dict[str, Residual]:
    """Residuals of momentum, unless motion is imposed, and, with chambers, of both chambers, by equation name.

    There are no windows without data to judge: no sliding for the momentum, a run shorter than a window. Raises
    DataError when the run leaves the stroke of the model.
    """
    check_position(model, run)
    states, claimed = _along(model, run)
    result = {} if model.imposed else {"momentum": _momentum(model, run, states, claimed)}
    for chamber in run.sensed(model.chambers):
        result[chamber.equation] = _chamber(model, run, states, claimed, chamber)
    return result


def force_error(model: Model, run: Run) -> float:
    """Relative force error in percent: |measured - modelled drive force| / |measured|, both averaged over 20 ms.

    The usual figure of merit for the identification of drives (inverse dynamics, Gautier and Khalil); unlike the
    residuals it includes rest and reversals.
    """
    bump = Bump.of(FORCE_WINDOW, run.sample_time)
    states, claimed = _along(model, run)
    mass = moving_mass(model)
    drive = drive_along(model, run, states) if model.force_driven else model.outputs(states)["drive"]
    error = mass * (bump.apply(bump.second, states[:, 0]) - bump.means(claimed[:, 1]))
    inside = measured_throughout(run, bump)
    return float(100.0 * np.linalg.norm(error[inside]) / np.linalg.norm(bump.apply(bump.phi, drive)[inside]))


def _along(model: Model, run: Run) -> tuple[Array, Array]:
    """States (n, states) along the measured signals, corrected for sensor effects, and claimed derivatives.

    The latter are means over the interval before each sample.
    """
    return driven(model, measured_frame(run, model.chambers), run)


def _momentum(model: Model, run: Run, states: Array, claimed: Array) -> Residual:
    bump, equation = Bump.of(MOMENTUM_WINDOW, run.sample_time), Momentum(model, run, states)
    added = model.outputs(states, run.sampled(model.inputs))["added_mass"]
    mass = model["piston.mass"] + added[bump.centres(len(run))]
    value = equation.value(bump, mass, states[:, 0], claimed[:, 1])
    return _residual("momentum", model.unit("N"), run, bump, value, equation.noise(bump), equation.usable(bump))


def _chamber(model: Model, run: Run, states: Array, claimed: Array, chamber: Chamber) -> Residual:
    bump, equation = Bump.of(CHAMBER_WINDOW, run.sample_time), Balance(model, chamber)
    rate = claimed[:, equation.column]
    value = equation.value(bump, states, rate)
    noise = equation.noise(bump, run, states, rate, equation.steepness(run, states))
    return _residual(chamber.equation, "kg/s", run, bump, value, noise, measured_throughout(run, bump))


def _residual(
    equation: str, unit: str, run: Run, bump: Bump, value: Array, noise: Array, usable: NDArray[np.bool_]
) -> Residual:
    centre = run.time[bump.centres(len(run))]
    good = usable & np.isfinite(value)
    return Residual(equation, unit, centre[good], value[good], np.broadcast_to(noise, value.shape)[good])
