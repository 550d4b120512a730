"""What speaks for a candidate and what against: everything that has to hold before an effect is added."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.coordinates import Coordinate
from pneumo_ros.discover.evidence import Evidence
from pneumo_ros.discover.hypothesis import (
    OVERLAP,
    BaseFit,
    Hypothesis,
    cluster_robust,
    family_scales,
    huber,
    log_likelihood,
    weights,
)
from pneumo_ros.discover.ranking import wald

Array = NDArray[np.float64]

T_LEAST = 5.0
GAIN_LEAST = 0.05  # of the mean square of an equation's residual on held-out runs
Z_LEAST = 2.0  # of that gain over its scatter between blocks of time
SHARE_LEAST = (0.25, 0.5)  # of what noise does not explain in an equation, that the first and later effects remove
TEXTURE = 0.01  # of the driving force: a smaller force must explain most of what is there, or it is part of a texture
SPOILED = 0.5  # of its best gain: by no more may another equation get worse, which something else may still bend
REST_LEAST = 0.025  # of what was left at first: less is how an added effect's shape differs from the machine's
RELIEF, T_PRIOR = 4.5, 3.0  # log likelihood, and deviations, by which priors alone speak for an effect
MATERIAL = 0.1  # of the usual size
MOST_BLOCK = 3.0  # log likelihood that one block of time may say: it takes several to decide
ALIKE = 0.9  # of the best one's score: less explains less, however few the blocks that say so
TIED = 2.5  # deviations by which a rival must be worse to be told apart
PLAIN = 0.8  # of what noise does not explain: who removes that on held-out runs is no accident, whatever its t
SAME = 0.5  # likeness of what rivals change; less is another thing, not another name for it
DECOYS = 12
SLOW = 10.0
FEW_RUNS = 3
NOISE = {"breakaway": 0.56}  # mean square that noise alone leaves, where it is not 1: their spread is generous


@dataclass(frozen=True)
class Trial:
    """One candidate on trial: its fit, and what the runs that took no part in it say."""

    hypothesis: Hypothesis
    held: Array = field(repr=False)  # residual on held-out runs
    gain: dict[str, float]  # by equation: share of the mean square residual on held-out runs that it removes
    z: float  # of the loss it removes there, over its scatter between blocks
    size: float  # in usual ones
    stable: bool
    share: float  # of what noise does not explain in the equation it helps most, on held-out runs
    first: bool  # whether nothing was added before
    decoy: float  # the largest t that a copy of its trace shifted in time reaches
    score: float  # log likelihood over the base, training and held-out runs together
    force: float = np.inf  # N, root mean square of what it changes in the momentum equation, over TEXTURE of the drive
    rest: float = 1.0  # excess over noise in the equation it helps most, of what the refitted model left there at first
    lag: float = np.inf  # samples, of an effect that delays
    refused: str = ""  # why it was taken back after it had been added
    std: dict[str, float] = field(default_factory=dict)  # of its parameters, where the equations do not determine them

    @property
    def name(self) -> str:
        """Catalogue name."""
        return self.hypothesis.name

    @property
    def slowness(self) -> float:
        """Largest of its fading time constants in usual ones: unlike forces, times do not grow with a machine."""
        h = self.hypothesis
        times = [c for c in h.coordinates if c.is_size and c.name.endswith("time_constant")]
        return max((h.values[c.name] / c.typical for c in times), default=0.0)

    @property
    def absorbed(self) -> bool:
        """Whether base parameters stand in for it: the data cannot tell, but what is known of those parameters can."""
        h = self.hypothesis
        indifferent = all(abs(gain) < GAIN_LEAST for gain in self.gain.values())
        return indifferent and h.relief > RELIEF and h.t > T_PRIOR and self.score > RELIEF

    def _data_objections(self) -> list[str]:
        """What the recordings say against it."""
        h, found, most = self.hypothesis, list[str](), max(self.gain.values(), default=0.0)
        if h.t < T_LEAST:
            found.append(f"t is {h.t:.1f}, {T_LEAST:g} is the least")
        elif h.t < 1.5 * self.decoy and self.share < PLAIN:
            found.append(f"t is {h.t:.1f}, and its trace shifted in time reaches {self.decoy:.1f}")
        if most < GAIN_LEAST:
            found.append(f"removes {100.0 * most:.1f} % on held-out runs")
        elif self.z < Z_LEAST:
            found.append("its gain on held-out runs is within their scatter")
        worst = min(self.gain, key=lambda name: self.gain[name])
        if self.gain[worst] < -SPOILED * max(most, GAIN_LEAST):
            found.append(f"makes {worst} {-100.0 * self.gain[worst]:.0f} % worse on held-out runs")
        if self.rest < REST_LEAST:
            found.append(f"what it acts on is {100.0 * self.rest:.1f} % of what was left at first: a shape, no effect")
        alone = self.first and (self.force > 1.0 or equation_helped(self.gain) != "momentum")
        if self.share < SHARE_LEAST[0 if alone else 1]:
            found.append(f"removes {100.0 * self.share:.0f} % of what noise does not explain")
        return found

    @property
    def objections(self) -> tuple[str, ...]:
        """Why it may not be added; empty when it may."""
        h, found = self.hypothesis, [] if self.absorbed else self._data_objections()
        if self.size < MATERIAL:
            found.append(f"its size is {self.size:.2g} of the usual one")
        if self.slowness > SLOW:
            found.append(f"its time constant is {self.slowness:.0f} times the usual one")
        ends = [c.name for c, u in zip(h.coordinates, h.u, strict=True) if _at_end(c, float(u))]
        if ends:
            found.append(f"{ends[0]} is at the end of its range")
        if self.lag < 1.0:
            found.append("its delay is less than a sample, which may be how the recording was timed")
        if self.refused:
            found.append(self.refused)
        if not self.stable:
            found.append("its size depends on which run is left out")
        return tuple(found)


def _at_end(c: Coordinate, u: float) -> bool:
    """Whether a parameter sits on a bound, neither neutral nor usual, as one does that stands for something else."""
    value, margin = c.value(u), 1e-3 * abs(c.typical)
    near = [end for end in (c.low, c.high) if abs(value - end) <= margin]
    return bool(near) and near[0] not in (c.neutral, c.typical)


def equation_of(name: str) -> str:
    """The equation of a family: momentum, chamber_a, chamber_b or breakaway."""
    return name.partition(" ")[0]


def equation_helped(gain: dict[str, float]) -> str:
    """The equation that gains most; "" of none."""
    return max(gain, key=lambda name: gain[name], default="")


def force(evidence: Evidence, before: Array, after: Array) -> float:
    """Root mean square of what changes in the momentum equation [N]; 0 without it."""
    own = np.isin(evidence.family, [k for k, name in enumerate(evidence.names) if equation_of(name) == "momentum"])
    change = (before - after)[own] * evidence.noise[own]
    return float(np.sqrt(np.mean(change**2))) if len(change) else 0.0


def mean_squares(evidence: Evidence, residual: Array) -> dict[str, float]:
    """Robust mean square of the residual over noise by equation, the mean over its families; at least the noise's."""
    scale = family_scales(evidence, residual)
    found: dict[str, list[float]] = {}
    for k, name in enumerate(evidence.names):
        if (evidence.family == k).any():
            found.setdefault(equation_of(name), []).append(float(scale[k] ** 2))
    return {name: max(float(np.mean(values)), NOISE.get(name, 1.0)) for name, values in found.items()}


def gains(evidence: Evidence, before: Array, after: Array) -> dict[str, float]:
    """By equation, the share of the mean square residual that `after` lacks against `before`."""
    first, second = mean_squares(evidence, before), mean_squares(evidence, after)
    return {name: 1.0 - second[name] / first[name] for name in first}


def explained(evidence: Evidence, before: Array, after: Array) -> float:
    """Largest share, over the equations, of the mean square beyond the noise's that `after` lacks."""
    first, second = mean_squares(evidence, before), mean_squares(evidence, after)
    noise = {name: NOISE.get(name, 1.0) for name in first}
    return max((first[n] - second[n]) / max(first[n] - noise[n], 0.1 * noise[n]) for n in first)


def advantage(evidence: Evidence, worse: Array, better: Array) -> tuple[float, float]:
    """Loss that `better` saves against `worse`, and that saving over its scatter between blocks (Vuong 1989)."""
    scale = family_scales(evidence, better)[evidence.family]
    difference = OVERLAP**2 * (huber(worse / scale) - huber(better / scale))
    blocks = np.clip(np.bincount(evidence.block, difference), -MOST_BLOCK, MOST_BLOCK)
    spread = float(np.sqrt(np.sum(blocks**2)))
    return float(blocks.sum()), float(blocks.sum() / spread) if spread > 0.0 else 0.0


def pooled_advantage(pairs: Sequence[tuple[Evidence, Array, Array]]) -> float:
    """The same over several bodies of evidence, (evidence, worse, better) each: deviations."""
    total = spread = 0.0
    for evidence, worse, better in pairs:
        saved, z = advantage(evidence, worse, better)
        total += saved
        spread += (saved / z) ** 2 if z else 0.0
    return total / np.sqrt(spread) if spread > 0.0 else 0.0


def magnitude(h: Hypothesis) -> float:
    """Largest size of a hypothesis in usual ones."""
    found = [0.0]
    for c, u in zip(h.coordinates, h.u, strict=True):
        if c.is_size:
            value = c.value(float(u))
            if c.logarithmic:
                found.append(0.0 if value == c.neutral else c.typical / value)
            else:
                found.append(abs(float(u)))
    return max(found)


def _parts(base: BaseFit, h: Hypothesis) -> tuple[Array, Array, Array]:
    """Weighted slopes (residuals, base + candidate), weighted residual, and ridge, at the hypothesis."""
    w = weights(base.evidence, h.residual, family_scales(base.evidence, h.residual))
    K = np.concatenate([base.slopes, h.slopes], axis=1)
    ridge = np.concatenate([np.ones(len(base.names)), [1.0 / c.prior**2 for c in h.coordinates]])
    return K * w[:, None], w * h.residual, ridge


def _folds(evidence: Evidence) -> list[NDArray[np.bool_]]:
    """Which residuals to leave out together: a run each; quarters in time of each, of less than three runs."""
    if len(evidence.runs) >= FEW_RUNS:
        return [evidence.run == k for k in range(len(evidence.runs))]
    ends = np.array([run.time[-1] for run in evidence.runs])
    part = np.minimum((4.0 * evidence.time / ends[evidence.run]).astype(int), 3) + 4 * evidence.run
    return [part == k for k in range(4 * len(evidence.runs))]


def stable(base: BaseFit, h: Hypothesis) -> bool:
    """Whether the sizes keep their sign and half their value, whichever run is left out (linearised)."""
    A, e, ridge = _parts(base, h)
    p, normal = len(base.names), A.T @ A
    sizes = [k for k, c in enumerate(h.coordinates) if c.is_size and not c.logarithmic]
    if not sizes:
        return True
    u = h.u[sizes]
    for own in _folds(base.evidence):
        left = normal - A[own].T @ A[own] + np.diag(ridge)
        shift = np.linalg.solve(left, A[own].T @ e[own])[p:][
            sizes
        ]  # the other runs' optimum: their gradient is minus it
        if float(u @ (u + shift)) < 0.5 * float(u @ u):
            return False
    return True


def decoy(base: BaseFit, h: Hypothesis, rng: np.random.Generator) -> float:
    """Largest t among copies of the candidate's trace shifted in time, each within its runs."""
    evidence, p = base.evidence, len(base.names)
    w = weights(evidence, h.residual, family_scales(evidence, h.residual))
    B, e = base.slopes * w[:, None], w * h.residual
    sizes = [k for k, c in enumerate(h.coordinates) if c.is_size]
    C = h.slopes[:, sizes]
    groups = [
        np.flatnonzero((evidence.family == f) & (evidence.run == r))
        for f in range(len(evidence.names))
        for r in range(len(evidence.runs))
    ]
    largest = 0.0
    for _ in range(DECOYS):
        shifted = np.empty_like(C)
        for rows in groups:
            if len(rows):
                shifted[rows] = np.roll(C[rows], int(rng.uniform(0.1, 0.9) * len(rows)), axis=0)
        A = np.concatenate([B, shifted * w[:, None]], axis=1)
        bread = np.linalg.inv(A.T @ A + np.diag(np.concatenate([np.ones(p), np.full(len(sizes), 1e-3)])))
        x = -bread @ (A.T @ e)
        cov = cluster_robust(A, e + A @ x, evidence.block, bread, np.zeros(len(x)))
        largest = max(largest, wald(x[p:], cov[p:, p:]))
    return largest


def excess(evidence: Evidence, residual: Array) -> dict[str, float]:
    """By equation, the mean square of the residual beyond the noise's."""
    return {n: max(value - NOISE.get(n, 1.0), 0.0) for n, value in mean_squares(evidence, residual).items()}


def remaining(trial: Trial, first: dict[str, float], now: dict[str, float]) -> float:
    """Share of what was left at first that is still there, in the equation where the trial helps most."""
    name = max(trial.gain, key=lambda n: trial.gain[n] * now.get(n, 0.0))
    return now.get(name, 0.0) / first[name] if first.get(name) else 1.0


def _lag(h: Hypothesis, sample_time: float) -> float:
    delays = [value for name, value in h.values.items() if name.endswith(".delay")]
    return min(delays) / sample_time if delays else np.inf


def put_on_trial(
    base: BaseFit,
    held: BaseFit,
    hypotheses: Sequence[Hypothesis],
    residuals: Sequence[Array],
    nothing: Hypothesis,
    first: bool,
) -> list[Trial]:
    """Trials of refined hypotheses with their held-out residuals, best score first.

    All is told against `nothing`: base parameters at their best without any candidate, whose residuals `held` has.
    """
    rng, found = np.random.default_rng(0), []
    reference = nothing.likelihood + log_likelihood(held.evidence, held.residual)
    for h, r in zip(hypotheses, residuals, strict=True):
        found.append(
            Trial(
                hypothesis=replace(h, relief=h.relief - nothing.relief),
                held=r,
                gain=gains(held.evidence, held.residual, r),
                z=advantage(held.evidence, held.residual, r)[1],
                size=magnitude(h),
                stable=stable(base, h),
                share=explained(held.evidence, held.residual, r),
                first=first,
                decoy=decoy(base, h, rng) if h.t >= T_LEAST else 0.0,
                score=h.likelihood + log_likelihood(held.evidence, r) - reference,
                force=force(held.evidence, held.residual, r) / (TEXTURE * held.evidence.drive),
                lag=_lag(h, base.evidence.runs[0].sample_time),
            )
        )
    return sorted(found, key=lambda trial: -trial.score)


def rivals(base: BaseFit, held: BaseFit, best: Trial, others: Sequence[Trial]) -> list[Trial]:
    """Trials whose residuals all runs together cannot tell from the best one's."""
    found = []
    for other in others:
        if other.name == best.name or other.hypothesis.t < T_LEAST or other.size < MATERIAL:
            continue
        if other.score < ALIKE * best.score or best.name in _contained(base, other):
            continue
        if _likeness(held.residual - best.held, held.residual - other.held) < SAME:
            continue
        if _tied(base, held, best, other):
            found.append(other)
    return found


def _likeness(one: Array, other: Array) -> float:
    """Cosine of the angle between what two effects change."""
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(one @ other) / size if size else 0.0


def simplest(base: BaseFit, held: BaseFit, good: Sequence[Trial]) -> Trial | None:
    """The first of `good`, or what it contains when all runs together do not ask for more; None of none."""
    for other in good[1:]:
        if other.name in _contained(base, good[0]) and _tied(base, held, good[0], other):
            return other
    return good[0] if good else None


def _contained(base: BaseFit, trial: Trial) -> tuple[str, ...]:
    return base.model.library.find(trial.name).contains


def _tied(base: BaseFit, held: BaseFit, best: Trial, other: Trial) -> bool:
    pairs = [
        (base.evidence, other.hypothesis.residual, best.hypothesis.residual),
        (held.evidence, other.held, best.held),
    ]
    return pooled_advantage(pairs) < TIED
