"""The result of a diagnosis: verdict, added effects with intervals, ranking, held-out errors, unexplained misfit."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.diagnose.between import Moved
from pneumo_ros.diagnose.score import Score
from pneumo_ros.diagnose.steps import Step
from pneumo_ros.plant import Model

Array = NDArray[np.float64]

ADEQUATE, FOUND, UNKNOWN = "adequate", "effects_found", "unknown_effect"


@dataclass(frozen=True)
class Value:
    """A parameter of an added effect: value, standard deviation (infinite when not determined) and unit."""

    value: float
    std: float
    unit: str


@dataclass(frozen=True)
class Addition:
    """An effect that was added; errors are held-out window errors over the noise floor, without and with it."""

    effect: str
    parameters: dict[str, Value]  # by key, without the effect's name
    indistinguishable_from: tuple[str, ...]
    holdout_error_before: float
    holdout_error_after: float
    t: float
    score: Score  # nats that the recordings gain with it


@dataclass(frozen=True)
class Ranked:
    """One row of the ranking of the round in which an effect was tried last."""

    effect: str
    score: Score  # nats that the recordings gain with it
    t: float  # on the training runs
    holdout_gain: float  # share of the mean square of the equation it helps most, on held-out runs
    equation: str  # that equation
    size: float  # in usual sizes of the effect
    objections: tuple[str, ...]  # why it was not added; empty for added effects and their rivals
    holdout_error: float | None  # held-out window error with it; None where it was not predicted


@dataclass(frozen=True)
class Unexplained:
    """The misfit of one equation over bins of the variable that explains it best: (bins,) arrays."""

    equation: str
    against: str  # "" where the recordings hold too few windows to say
    at: Array
    mean: Array
    low: Array  # 95 % band
    high: Array
    noise: Array
    seconds: Array  # coverage
    unit: str
    rms: float
    share: float  # of the residual's square that the variable explains, predicted for data left out
    material: bool  # whether it is large enough to matter, beyond texture and the inexact law of an added effect
    moved: Moved | None = None  # where most of it comes from machine parameters that changed on held-out recordings


@dataclass(frozen=True)
class Outcome:
    """Everything `pneumo diagnose` found."""

    verdict: str
    failing: tuple[str, ...]  # of the refitted base: momentum, chamber_a, chamber_b, valve, sensor
    base: Model  # refitted
    model: Model  # with the added effects
    added: tuple[Addition, ...]
    ranking: tuple[Ranked, ...]
    steps: tuple[Step, ...] = field(repr=False)
    before: Comparison = field(repr=False)  # refitted base on the held-out runs
    after: Comparison = field(repr=False)
    errors: dict[str, dict[str, float]]  # before, after, noise -> by signal, rms in its unit over all held-out windows
    waterfall: tuple[tuple[str, float], ...]  # name and error, in noise floors: as given, refitted, each addition
    unexplained: Unexplained | None
    because: str = ""  # failing predictions of held-out runs, if they make the verdict `unknown_effect`
    interrupted: bool = False
    deadline: bool = False  # whether the search ended because its time was over
    train: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    limits: tuple[str, ...] = ()  # a sentence for every loop of the search that ended at its bound
    late: float = 0.0  # s, by which a measured force was delayed, as positions are recorded after it
