"""Where the fit of an effect to breakaways and reversals begins, and how well it promises to do."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate, coordinates, kinds
from pneumo_ros.diagnose.slips import Slips, errors, friction_priors
from pneumo_ros.plant import Model
from pneumo_ros.shooting.problem import Problem
from pneumo_ros.shooting.refit import unknowns_of
from pneumo_ros.shooting.start import fit_starts

Array = NDArray[np.float64]
Begin = tuple[float, Model]  # the smaller the better, and the model to begin with

ONE_IN = 3  # of the events one is enough to begin by
LOOKED_AT = 0.95  # of the events are looked at along a tangent: where the moment of a slip is missed it leads nowhere
_SIZES, _FACTORS = (0.3, 1.0, 2.5), (0.25, 0.5, 2.0, 4.0)
_NEAR = 0.2  # of the usual size: as far as a tangent is trusted


def by_sizes(alone: Model, found: Slips, name: str) -> Begin:
    """The best of some sizes of an effect beside `alone`, then of some shapes, by the median error of some events."""
    effect = coordinates(alone.library.find(name))
    some = np.arange(0, len(found.train_rows), ONE_IN)

    def tried(values: dict[str, float]) -> Begin:
        model = alone.with_effects([*alone.effects, name], values)
        return float(np.median(errors(model, found.train(model).pick(some)))), model

    options = [tried(_values(effect, own, share)) for own in kinds(effect) for share in _SIZES]
    best = min(options, key=lambda option: option[0])[1]
    own = {c.name: best[c.name] for c in effect}
    options += [tried(own | shape) for shape in _shapes(effect)]
    return min(options, key=lambda option: option[0])


@dataclass(frozen=True)
class Tangents:
    """From mechanics without an effect, where the training events begin by them, and with what is known of friction.

    For models that predict most events: sizes large enough to try would miss the moments of all.
    """

    alone: Model
    found: Slips
    states: Array
    friction: dict[str, float]

    @classmethod
    def of(cls, alone: Model, found: Slips, known: dict[str, float]) -> "Tangents":
        """Where the events begin is fitted here; `known`: standard deviations of the friction from elsewhere."""
        return cls(alone, found, fit_starts(alone, found.train(alone)), friction_priors(alone, known))

    def best(self, name: str) -> Begin:
        """The effect along the tangent that promises most, and minus the loss that a step along it would save."""
        effect = coordinates(self.alone.library.find(name))
        options = [
            self._along(name, own, _values(effect, own, 0.0) | shape)
            for own in kinds(effect)
            for shape in ({}, *_shapes(effect))
        ]
        return min(options, key=lambda option: option[0])

    def _along(self, name: str, own: tuple[Coordinate, ...], values: dict[str, float]) -> Begin:
        model = self.alone.with_effects([*self.alone.effects, name], values)
        segments = self.found.train(model)
        states = segments.seated(model)
        states[:, [model.states.index(s) for s in self.alone.states]] = self.states
        prior = self.friction | {c.name: _NEAR * abs(c.scale) for c in own}
        problem = Problem(model, unknowns_of(model, tuple(prior), prior), segments, threads=1)
        begin = problem.unknowns.begin
        residuals = problem.residuals(states, begin)
        losses = problem.losses(residuals)
        problem.active = losses <= np.quantile(losses, LOOKED_AT)
        equations = problem.equations(states, begin, residuals)
        step = problem.move(begin, equations, 0.0) * problem.unknowns.prior
        return -problem.promise(begin, equations), problem.with_values(begin + step)


def _shapes(effect: tuple[Coordinate, ...]) -> Iterator[dict[str, float]]:
    """Each parameter that only shapes an effect, in turn a few times smaller and larger than usual."""
    for c in effect:
        if c.logarithmic and not c.is_size:
            yield from ({c.name: c.value(np.log(factor))} for factor in _FACTORS)


def _values(effect: tuple[Coordinate, ...], own: tuple[Coordinate, ...], share: float) -> dict[str, float]:
    """Parameters of an effect in its usual shape: its sizes `own` that share of the usual one, the others none."""
    values = {c.name: c.value(0.0) if c.neutral is None else c.neutral for c in effect}
    return values | {c.name: c.grown(c.typical, share) for c in own} if share else values
