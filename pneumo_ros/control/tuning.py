"""Gains found by simulation: one procedure for every law."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pneumo_ros.control.closed_loop import SteppedPlant, closed_loop
from pneumo_ros.control.figures import arrivals, tracking
from pneumo_ros.control.law import Law
from pneumo_ros.control.sensors import NoisySensors
from pneumo_ros.control.setpoint import Reference
from pneumo_ros.errors import NumericalError

EXPLORED, DRAWN = 0.5, 40  # share and largest number of evaluations at drawn gains: the rest is for the search
SPREAD = 5.0  # largest factor between a drawn gain and its first value
FACTORS = (1.5, 1.2)  # by which a gain is changed afterwards, the coarse one first
WORST = 100.0  # cost of a run that fails
NOISE_SEED, DRAW_SEED = 1, 0
TOGETHER = 8  # sets of gains that are drawn and judged at a time

Gains = Mapping[str, float]
Costs = Callable[[Sequence[Gains]], Sequence[float]]


@dataclass(frozen=True)
class RatedMotion:
    """A motion on a plant: a reference followed from `begin` [s] on, or moves that are each held for `hold` [s]."""

    plant: Callable[[], SteppedPlant]
    reference: Reference
    seconds: float
    begin: float = 0.0
    hold: float | None = None
    unit: float = 1e-3  # m, rms error that costs 1; of a move, the tolerance within which it must end


@dataclass(frozen=True)
class Weights:
    """Costs beside the error: of the valve's `activity` [s/V], and of a second until a move has `settled` [1/s]."""

    activity: float = 2e-4
    settled: float = 0.2


def cost(law: Law, motions: Sequence[RatedMotion], weights: Weights | None = None) -> float:
    """Mean cost of `law` over `motions`; smaller is better, and the same law costs the same."""
    return sum(_cost_of(law, motion, weights or Weights()) for motion in motions) / len(motions)


def _cost_of(law: Law, motion: RatedMotion, weights: Weights) -> float:
    law.reset()
    plant = motion.plant()
    try:
        record = closed_loop(
            plant, law, motion.reference, round(motion.seconds / plant.sample_time), NoisySensors(seed=NOISE_SEED)
        )
    except NumericalError:
        return WORST
    seen = tracking(record, motion.begin)
    if motion.hold is None:
        return min(seen.rms / motion.unit + weights.activity * seen.activity, WORST)
    ends = arrivals(record, motion.hold, motion.unit)
    errors = sum(min(end.error / motion.unit, 10.0) + weights.settled * end.settling for end in ends) / len(ends)
    return min(errors + weights.activity * seen.activity, WORST)


class Search:
    """First a law's `tuned` gains are drawn at random, log-uniformly around their first values. Then, from the best,
    each in turn is multiplied and divided by a factor, and kept if the cost falls; if no cost falls, the factor becomes
    smaller: the pattern search of R. Hooke and T. A. Jeeves, J. ACM 8 (1961), without its pattern moves.
    """

    def __init__(
        self,
        begin: Law,
        costs: Costs,
        evaluations: int = 60,
        told: Callable[[int, float], object] = lambda count, least: None,
    ) -> None:
        """`begin` has the gains to start from; `costs` returns the costs of several sets of gains, as `costs_here`;
        `told` is called with the number of evaluations so far and the least cost.
        """
        self._costs, self._told = costs, told
        self.evaluations, self.count = evaluations, 1
        self._kind, self.gains = type(begin), {name: float(getattr(begin, name)) for name in begin.tuned}
        (self.least,) = costs([self.gains])
        self.first = self.least

    def run(self) -> dict[str, float]:
        """The gains of least cost, once no change lowers it or all evaluations are used."""
        self._explore()
        for factor in FACTORS:
            while self.count < self.evaluations and self._round(factor):
                pass
        return self.gains

    def _explore(self) -> None:
        begin, random = dict(self.gains), np.random.default_rng(DRAW_SEED)
        while (left := math.ceil(min(EXPLORED * self.evaluations, DRAWN)) - self.count) > 0:
            factors = SPREAD ** random.uniform(-1.0, 1.0, (min(left, TOGETHER), len(begin)))
            drawn = [{n: self._rounded(n, f * begin[n]) for n, f in zip(begin, row, strict=True)} for row in factors]
            self._take(drawn)

    def _round(self, factor: float) -> bool:
        paid = [self._try(name, factor) or self._try(name, 1.0 / factor) for name in self._kind.tuned]
        return any(paid)

    def _try(self, name: str, factor: float) -> bool:
        value = self._rounded(name, self.gains[name] * factor)
        if value == self.gains[name] or self.count >= self.evaluations:
            return False
        return self._take([{**self.gains, name: value}])

    def _rounded(self, name: str, value: float) -> float:
        """A gain within its range, to three digits: a control file is read by people."""
        gain = self._kind.gains[name]
        return float(f"{min(max(value, gain.low), gain.high):.3g}")

    def _take(self, candidates: Sequence[dict[str, float]]) -> bool:
        """Keep the best candidate if it is the best so far; returns whether it is."""
        before = self.least
        for candidate, found in zip(candidates, self._costs(candidates), strict=True):
            self.count += 1
            if found < self.least:
                self.gains, self.least = candidate, found
            self._told(self.count, self.least)
        return self.least < before


def costs_here(make: Callable[[Gains], Law], motions: Sequence[RatedMotion]) -> Costs:
    """Costs found one after another, in this process."""
    return lambda many: [cost(make(gains), motions) for gains in many]
