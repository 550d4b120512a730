"""The starting point for the fit of an effect to breakaways and reversals, and its predicted gain."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.diagnose.coordinates import Coordinate, coordinates
from pneumo_ros.diagnose.slips import Slips, errors_of_each, friction_priors
from pneumo_ros.plant import Model
from pneumo_ros.shooting.problem import Problem
from pneumo_ros.shooting.refit import unknowns_of
from pneumo_ros.shooting.start import fit_starts

Array = NDArray[np.float64]
Begin = tuple[float, Model]  # a score, the smaller the better, and the model to start with

LOOKED_AT = 0.95  # share of the events used along a tangent: at slips predicted at the wrong time it is useless
_SIZES, _FACTORS = (0.3, 1.0, 2.5), (0.25, 0.5, 2.0, 4.0)
_NEAR = 0.2  # of the usual size: range in which a tangent is trusted


def by_sizes(alone: Model, found: Slips, name: str, own: tuple[Coordinate, ...]) -> Begin:
    """The best of some sizes of an effect beside `alone`, then of some shapes, by the median error of some events.

    `own`: its sizes of one kind and their shapes; the other sizes stay neutral.
    """
    effect = coordinates(alone.library.find(name))

    def tried(options: Sequence[dict[str, float]]) -> list[Begin]:
        models = [alone.with_effects([*alone.effects, name], values) for values in options]
        each = errors_of_each(models, [found.some(model) for model in models]) if models else []
        return [(float(np.median(one)), model) for one, model in zip(each, models, strict=True)]

    options = tried([_values(effect, own, share) for share in _SIZES])
    best = min(options, key=lambda option: option[0])[1]
    values = {c.name: best[c.name] for c in effect}
    options += tried([values | shape for shape in _shapes(own)])
    return min(options, key=lambda option: option[0])


@dataclass(frozen=True)
class Tangents:
    """Linearisations at mechanics without an effect, their fitted starts of the training events, and friction priors.

    For models that predict most events: with trial sizes all slips would come at the wrong time.
    """

    alone: Model
    found: Slips
    states: Array
    friction: dict[str, float]

    @classmethod
    def of(cls, alone: Model, found: Slips, known: dict[str, float]) -> "Tangents":
        """The starts of the events are fitted here; `known`: standard deviations of the friction from elsewhere."""
        return cls(alone, found, fit_starts(alone, found.train(alone), threads=2), friction_priors(alone, known))

    def best(self, name: str, own: tuple[Coordinate, ...]) -> Begin:
        """The effect along its best tangent, and minus the loss that a step along it would save.

        `own`: its sizes of one kind and their shapes; the other sizes stay neutral.
        """
        effect = coordinates(self.alone.library.find(name))
        options = [self._along(name, own, _values(effect, own, 0.0) | shape) for shape in ({}, *_shapes(own))]
        return min(options, key=lambda option: option[0])

    def _along(self, name: str, own: tuple[Coordinate, ...], values: dict[str, float]) -> Begin:
        model = self.alone.with_effects([*self.alone.effects, name], values)
        segments = self.found.train(model)
        states = segments.seated(model)
        states[:, [model.states.index(s) for s in self.alone.states]] = self.states
        prior = self.friction | {c.name: _NEAR * abs(c.scale) for c in own if c.is_size}
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
    """Parameters of an effect in its usual shape: its sizes `own` at a share of the usual size, the others neutral."""
    values = {c.name: c.value(0.0) if c.neutral is None else c.neutral for c in effect}
    return values | {c.name: c.grown(c.typical, share) for c in own if c.is_size} if share else values
