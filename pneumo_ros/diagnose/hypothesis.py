"""Hypotheses about what a model lacks: candidates and base parameters fitted to the evidence together.

All hypotheses share one model that holds every candidate at its neutral setting, so that their residuals are lanes of
one kernel. Base parameters act through their derivative at the current model; candidates act exactly, by Gauss-Newton.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from pneumo_ros.diagnose.coordinates import Coordinate, coordinates
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.plant.library import FRAME
from pneumo_ros.plant.reach import acting, reads_drive
from pneumo_ros.runs.run import SENSORS
from pneumo_ros.shooting.bounded import bounded_minimum, finite
from pneumo_ros.shooting.robust import huber_loss, huber_weight

Array = NDArray[np.float64]
Form = tuple[str, frozenset[str]]

Slopes = Sequence[Array]  # derivatives side by side, each (residuals, some): of base parameters, and of a candidate

# Residuals whose weighted slopes are kept at a time; only time and memory depend on it. With 85 slopes of 320 s a step
# takes 62 ms and 8 MB, with half or twice as many rows 66 and 69 ms, with all at once 112 ms and 160 MB.
ROWS = 4096
FAR = 50.0  # usual sizes: no residual counts as larger
SCALE_TAIL = 5.0  # scales: beyond, the loss of an error is linear
OVERLAP = 0.6  # weight of each window, as windows overlap and together count about once
COORDINATE_PROBE = 0.05  # u: finite-difference step of a candidate's coordinate


def robust_scale(size: Array) -> float:
    """Root mean square of sizes (n,), each limited to fifty usual sizes.

    The limit is wide: an effect that shows in a few windows only (slow motion, near an end) is no outlier.
    """
    return float(np.sqrt(np.mean(np.minimum(size, FAR * usual(size)) ** 2))) if len(size) else 0.0


def usual(size: Array) -> float:
    """Usual size of errors of sizes (n,): the deviation of Gaussian errors with their median, at least the noise."""
    return max(1.4826 * float(np.median(size)), 1.0) if len(size) else 1.0


FLOOR = {"breakaway": 0.2}  # least scale: the stated spread of breakaways is larger than their scatter


def family_scales(evidence: Evidence, residual: Array) -> Array:
    """Robust scale (families,) of each family, at least the noise; 1 where it has no window."""
    result = np.ones(len(evidence.names))
    for k, name in enumerate(evidence.names):
        own = evidence.family == k
        if own.any():
            result[k] = max(robust_scale(np.abs(residual[own])), FLOOR.get(name, 1.0))
    return result


def huber(u: Array) -> Array:
    """Loss of sizes in scales: squared up to five, linear beyond."""
    return huber_loss(u, SCALE_TAIL)


def weights(evidence: Evidence, residual: Array, scale: Array) -> Array:
    """Factors (residuals,) of the residuals in iterated least squares."""
    each = scale[evidence.family]
    return np.asarray(OVERLAP * np.sqrt(huber_weight(residual / each, SCALE_TAIL)) / each)


def own_weights(evidence: Evidence, residual: Array, unit: Array | float = 1.0) -> Array:
    """The same in the residual's own scales; unit (residuals,): the noise in which the residual counts."""
    counted = residual / unit
    return np.asarray(weights(evidence, counted, family_scales(evidence, counted)) / unit)


def log_likelihood(evidence: Evidence, residual: Array) -> float:
    """Log likelihood of Gaussian errors with the residual's own family scales, at least noise; windows count once."""
    return float(np.sum(family_likelihoods(evidence, residual)))


def family_likelihoods(evidence: Evidence, residual: Array) -> Array:
    """The same by family (families,)."""
    scale = family_scales(evidence, residual)
    counts = np.bincount(evidence.family, minlength=len(scale)) * OVERLAP**2
    loss = np.bincount(evidence.family, huber(residual / scale[evidence.family]), len(scale)) * OVERLAP**2
    return np.asarray(-counts * np.log(scale) - loss)


@dataclass
class Hypothesis:
    """A candidate under fit: u (coordinates,), shift of base parameters in priors (base,), and the residual."""

    name: str
    coordinates: tuple[Coordinate, ...]
    u: Array
    shift: Array
    residual: Array = field(repr=False)
    likelihood: float = -np.inf
    t: float = 0.0
    relief: float = 0.0  # log likelihood of the priors that base parameters regain with it
    covariance: Array = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    # the same if each line of the machine file may be wrong; and the nats that it costs if such lines explain it
    beside_lines: Array = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    wrong_lines: float = np.inf
    slopes: Array = field(default_factory=lambda: np.empty((0, 0)), repr=False)

    @property
    def values(self) -> dict[str, float]:
        """Parameters by dotted name."""
        return {c.name: c.value(u) for c, u in zip(self.coordinates, self.u, strict=True)}

    @property
    def surprise(self) -> float:
        """Nats by which its coordinates are less probable than at the middle of what is expected."""
        return 0.5 * float(np.sum([(u / c.expected) ** 2 for c, u in zip(self.coordinates, self.u, strict=True)]))

    @property
    def form(self) -> Form:
        """The effect's name, and what its shapes belong to, where it has several forms."""
        return self.name, frozenset(c.shapes for c in self.coordinates)


@dataclass(frozen=True)
class BaseFit:
    """The current model on one set of runs: residual, derivative by free parameters per prior, offsets from priors.

    The last `bends` parameters are not the model's: they free the laws of its effects (see `freedom`).
    """

    model: Model
    everything: Model
    names: tuple[str, ...]
    prior: Array
    offset: Array
    evidence: Evidence
    residual: Array
    slopes: Array
    bends: int = 0
    uneven: int = 0  # of them, the first ones: points of profiles that the model lacks

    @property
    def own(self) -> slice:
        """The parameters that are the model's."""
        return slice(0, len(self.names) - self.bends)

    @property
    def lines(self) -> NDArray[np.bool_]:
        """Which parameters may be wrong by any amount, as a line of its file: not points of profiles that it lacks."""
        at = np.arange(len(self.names))
        return np.asarray((at < self.own.stop) | (at >= self.own.stop + self.uneven))


def missing(model: Model, measured: Collection[str], imposed: bool = False) -> dict[str, tuple[Coordinate, ...]]:
    """Coordinates of every library effect that the model lacks, that can fade in, and that fits its other effects.

    `measured`: the inputs that recordings hold; an effect that reads another one is left out. `imposed`: whether a test
    machine imposed the motion of a machine without chambers, so that its drive is the force that is predicted. An
    effect that reads it would follow from itself, and explain everything.
    """
    found = {}
    for name in model.library.names():
        if name not in FRAME and name not in model.effects:
            kind = model.library.find(name)
            never = kind.part or (kind.transmission and not model.force_driven) or (imposed and reads_drive(kind))
            effect = () if never else coordinates(kind)
            if effect and _fits(model, name, measured):
                found[name] = effect
    return found


def unmeasured(model: Model, measured: Collection[str]) -> dict[str, tuple[str, ...]]:
    """Effects that would be missing candidates but read inputs that are not among `measured`, and those inputs."""
    others = {*measured, *SENSORS}
    names = [name for name in missing(model, others) if not _fits(model, name, measured)]
    read = {name: model.with_effects([*model.effects, name]).inputs for name in names}
    return {name: tuple(one for one in own if one not in measured) for name, own in read.items()}


def _fits(model: Model, name: str, measured: Collection[str]) -> bool:
    try:
        larger = model.with_effects([*model.effects, name])
    except PneumoError:
        return False
    return set(larger.inputs) <= set(measured) and name in acting(larger.composition.effects, _shown(larger))


def _shown(model: Model) -> tuple[str, ...]:
    """What recordings show of a model: its frame, the readings of its sensors, and the force of a breakaway.

    An effect on which none of these depends changes nothing here, such as a drop of a supply that fills no chamber.
    """
    readings = (name for name in model.composition.observed if name.endswith("_measured"))
    return (*model.states[: model.frame], *readings, "friction_level")


def everything(model: Model, found: dict[str, tuple[Coordinate, ...]]) -> Model:
    """The model with all candidates in it, each neutral: it behaves as `model` does."""
    values = {c.name: c.typical if c.neutral is None else c.neutral for each in found.values() for c in each}
    order = sorted([*model.effects, *found])  # one kernel, whatever was added before
    return model.with_effects(order, values)


def vectors(model: Model, variants: Sequence[Mapping[str, float]]) -> Array:
    """Parameter vectors (variants, parameters) of a model with some values changed."""
    names = {name: k for k, name in enumerate(model.parameters)}
    result = np.tile(model.values, (len(variants), 1))
    for row, variant in zip(result, variants, strict=True):
        for name, value in variant.items():
            row[names[name]] = value
    return result


def gathered(slopes: Slopes, w: Array, r: Array) -> tuple[Array, Array]:
    """Normal matrix (p, p) of weighted slopes, and their gradient (p,) with the weighted residual r (residuals,)."""
    p = _columns(slopes)
    normal, gradient = np.zeros((p, p)), np.zeros(p)
    for rows, A in _weighted(slopes, w):
        with np.errstate(invalid="ignore", over="ignore"):
            normal += A.T @ A
            gradient += A.T @ (w[rows] * r[rows])
    return normal, gradient


def block_sums(slopes: Slopes, w: Array, e: Array, block: NDArray[np.int64]) -> Array:
    """Sums (blocks, p) over blocks of time of weighted slopes times weighted residuals e (residuals,)."""
    sums = np.zeros((int(block.max()) + 1, _columns(slopes)))
    for rows, A in _weighted(slopes, w):
        sums += csr_array((e[rows], block[rows], np.arange(len(A) + 1)), (len(A), len(sums))).T @ A
    return sums


def along(slopes: Slopes, x: Array) -> Array:
    """Change (residuals,) by a step x (p,)."""
    change, first = np.zeros(len(slopes[0])), 0
    for part in slopes:
        change += part @ x[first : first + part.shape[1]]
        first += part.shape[1]
    return change


def _columns(slopes: Slopes) -> int:
    return sum(part.shape[1] for part in slopes)


def _weighted(slopes: Slopes, w: Array) -> Iterator[tuple[slice, Array]]:
    """Weighted slopes (rows, p), some rows at a time: of a long recording all together are large, for every thread."""
    for first in range(0, len(w), ROWS):
        rows = slice(first, first + ROWS)
        yield rows, np.concatenate([part[rows] for part in slopes], axis=1) * w[rows, None]


def solve(slopes: Slopes, r: Array, w: Array, ridge: Array, offset: Array) -> tuple[Array, Array]:
    """Step x (p,) that minimises |w (r + slopes x)|^2 + |sqrt(ridge) (x + offset)|^2; and the inverse normal matrix.

    Raises NumericalError when the derivatives are not finite, or differ too much in magnitude.
    """
    normal, gradient = gathered(slopes, w, r)
    bread = finite(np.linalg.inv, normal + np.diag(ridge))
    return bread @ (-gradient - ridge * offset), bread


def solve_within(slopes: Slopes, r: Array, w: Array, ridge: Array, offset: Array, low: Array, high: Array) -> Array:
    """The step of `solve` that is best within low and high (p,). Raises NumericalError as `solve`."""
    normal, gradient = gathered(slopes, w, r)
    return bounded_minimum(normal + np.diag(ridge), gradient + ridge * offset, low, high)


def cluster_robust(sums: Array, bread: Array, ridge: Array) -> Array:
    """Covariance of a least-squares estimate whose errors are correlated within blocks (Liang and Zeger 1986).

    sums (blocks, p): `block_sums`. Directions that only a prior determines (`ridge`, its information) keep the prior's
    uncertainty.
    """
    n = len(sums)
    return np.asarray(bread @ (sums.T @ sums * (n / max(n - sums.shape[1], 1)) + np.diag(ridge)) @ bread)


def spread(A: Array, e: Array, block: NDArray[np.int64]) -> Array:
    """Deviations (p,) in priors by weighted slopes A (residuals, p): cluster-robust, at least those of noise alone.

    e (residuals,): weighted residuals.
    """
    ridge = np.ones(A.shape[1])
    bread = np.linalg.inv(A.T @ A + np.diag(ridge)).astype(np.float64)
    robust = cluster_robust(block_sums((A,), np.ones(len(e)), e, block), bread, ridge)
    return np.sqrt(np.maximum(np.diag(robust), np.diag(bread)))


def jackknife(A: Array, e: Array, block: NDArray[np.int64]) -> Array:
    """Deviations (p,) in priors as of `spread`, by leaving out one block after another (CR3, Bell and McCaffrey 2002).

    `cluster_robust` takes a few long blocks for far too many: each bends the fit towards itself. Here its own residual
    is that of the fit without it.
    """
    bread = np.linalg.inv(A.T @ A + np.eye(A.shape[1])).astype(np.float64)
    sums, order = block_sums((A,), np.ones(len(e)), e, block), np.argsort(block, kind="stable")
    parts = np.split(A[order], np.flatnonzero(np.diff(block[order])) + 1)
    normal = np.stack([own.T @ own for own in parts])
    without = np.linalg.solve(np.eye(A.shape[1]) - normal @ bread, sums[:, :, None])[:, :, 0]
    return np.asarray(np.sqrt(np.diag(bread @ (without.T @ without + np.eye(A.shape[1])) @ bread)))


def wald(size: Array, covariance: Array) -> float:
    """Student-like statistic of several sizes together: sqrt(chi2 - (n - 1)), |t| for a single size."""
    if not len(size):
        return 0.0
    jitter = 1e-9 * np.trace(covariance) / len(size) + 1e-300
    value = float(size @ np.linalg.solve(covariance + jitter * np.eye(len(size)), size))
    return float(np.sqrt(max(value - (len(size) - 1), 0.0)))
