"""What a diagnosis says: verdict, added effects with intervals, ranking, held-out errors, what remains unexplained."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.diagnose.between import Moved
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


@dataclass(frozen=True)
class Ranked:
    """One row of the ranking of the round in which an effect was tried last."""

    effect: str
    score: float  # t on the training runs
    holdout_gain: float  # share of the mean square of the equation it helps most, on held-out runs
    equation: str  # that equation
    size: float  # in usual sizes of the effect
    objections: tuple[str, ...]  # why it was not added; empty for what was, and for its rivals
    holdout_error: float | None  # held-out window error with it; None where it was not predicted


@dataclass(frozen=True)
class Unexplained:
    """What remains in one equation, over bins of the variable that explains it best: (bins,) arrays."""

    equation: str
    against: str
    at: Array
    mean: Array
    low: Array  # 95 % band
    high: Array
    noise: Array
    seconds: Array  # coverage
    unit: str
    rms: float
    share: float  # of the residual's square that the variable explains, predicted for data left out
    material: bool  # whether it is of a size that matters, rather than texture or the rest of an added effect's shape
    moved: Moved | None = None  # where most of it is the model's own parameters being others on held-out recordings


@dataclass(frozen=True)
class Outcome:
    """Everything `pneumo diagnose` found."""

    verdict: str
    failing: tuple[str, ...]  # of the refitted base: momentum, chamber_a, chamber_b, valve, sensor
    base: Model  # refitted
    model: Model  # with what was added
    added: tuple[Addition, ...]
    ranking: tuple[Ranked, ...]
    steps: tuple[Step, ...] = field(repr=False)
    before: Comparison = field(repr=False)  # refitted base on the held-out runs
    after: Comparison = field(repr=False)
    errors: dict[str, dict[str, float]]  # before, after, noise -> by signal, rms in its unit over all held-out windows
    waterfall: tuple[tuple[str, float], ...]  # name and error, in noise floors: as given, refitted, each addition
    unexplained: Unexplained | None
    because: str = ""  # what fails in predictions of held-out runs, where the verdict is `unknown_effect` for that
    interrupted: bool = False
    train: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    limits: tuple[str, ...] = ()  # a sentence for every loop of the search that ended at its bound
    late: float = 0.0  # s, by which a measured force was put off, as positions come after it
