"""The families of residuals that one run has: windows of an equation, and breakaways, with the noise of each."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.follow import Frame, follow
from pneumo_ros.diagnose.slip_time import UNSURE, slip_times
from pneumo_ros.equations.breakaway import Breakaway, find_breakaways, force_spread
from pneumo_ros.equations.bump import Bump
from pneumo_ros.equations.equations import Balance, Momentum, measured_throughout
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

Array = NDArray[np.float64]

MOMENTUM_WINDOWS, CHAMBER_WINDOWS = (0.1, 0.04), (0.2, 0.04)  # s
SLOW = 4e-3  # s between samples: windows of slower recordings are as many samples long


@dataclass(frozen=True)
class Family:
    """Windows of one equation and width in one run; arrays (windows,)."""

    equation: str
    width: float  # s; 0 for breakaways
    run: int
    time: Array
    noise: Array
    usable: NDArray[np.bool_] = field(repr=False)
    bump: Bump | None = field(repr=False, default=None)
    breakaways: tuple[Breakaway, ...] = ()
    slip_times: tuple[float, ...] = ()  # s, of each breakaway
    by_mass: Array | None = field(repr=False, default=None)  # the part of the noise that the moving mass amplifies

    @property
    def window(self) -> Bump:
        """The window's shape; breakaways have none."""
        assert self.bump is not None
        return self.bump

    @property
    def name(self) -> str:
        """The family's name, as `momentum 40 ms` or `breakaway`."""
        return f"{self.equation} {1e3 * self.width:.0f} ms" if self.width else self.equation


def families(model: Model, frame: Frame, index: int) -> list[Family]:
    """All families of one run, with noise by the claims of `model`; `index` is the run's."""
    run, (states, claimed) = frame.run, follow(model, frame)
    found, momentum = [], Momentum(model, run, states)
    longer = max(run.sample_time / SLOW, 1.0)
    for width in () if model.imposed else (longer * w for w in MOMENTUM_WINDOWS):
        bump = Bump.of(width, run.sample_time)
        family = _family("momentum", width, index, run, bump, momentum.noise(bump), momentum.usable(bump))
        found.append(replace(family, by_mass=momentum.noise_by_acceleration(bump)))
    for chamber in run.sensed(model.chambers):
        equation = Balance(model, chamber)
        rate, steep = claimed[:, equation.column], equation.steepness(run, states)
        for width in (longer * w for w in CHAMBER_WINDOWS):
            bump = Bump.of(width, run.sample_time)
            noise = equation.noise(bump, run, states, rate, steep)
            found.append(_family(chamber.equation, width, index, run, bump, noise, measured_throughout(run, bump)))
    slides = "z" in model.states and not model.imposed
    breakaways = tuple(find_breakaways(model, run)) if slides else ()
    late = slip_times(model, breakaways)
    spread = np.array([force_spread(b.ramp, UNSURE * seconds) for b, seconds in zip(breakaways, late, strict=True)])
    time = np.array([b.time for b in breakaways])
    found.append(Family("breakaway", 0.0, index, time, spread, np.ones(len(time), dtype=bool), None, breakaways, late))
    return found


def _family(
    equation: str, width: float, index: int, run: Run, bump: Bump, noise: Array, usable: NDArray[np.bool_]
) -> Family:
    return Family(equation, width, index, run.time[bump.centres(len(run))], noise, usable, bump)
