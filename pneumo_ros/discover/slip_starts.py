"""Where the fit of an effect to breakaways and reversals begins, and how well it promises to do."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.discover.coordinates import Coordinate, coordinates, kinds
from pneumo_ros.discover.slips import Slips, errors
from pneumo_ros.identify.problem import Problem, Unknowns
from pneumo_ros.identify.segments import Segments
from pneumo_ros.identify.start import fit_starts
from pneumo_ros.plant import Model

Array = NDArray[np.float64]
Begin = tuple[float, Model]  # the smaller the better, and the model to begin with

EVERY = 3  # of the events one is enough to begin by
WILD = 0.95  # of the events are looked at along a tangent: where the moment of a slip is missed it leads nowhere
_SIZES, _FACTORS = (0.3, 1.0, 2.5), (0.25, 0.5, 2.0, 4.0)
_NEAR = 0.2  # of the usual size: as far as a tangent is trusted


@dataclass(frozen=True)
class Start:
    """The mechanics without an effect, the training events, their starts fitted, and priors of the friction."""

    alone: Model
    found: Slips
    segments: Segments
    states: Array
    friction: dict[str, float]

    @classmethod
    def of(cls, alone: Model, found: Slips, friction: dict[str, float]) -> "Start":
        """Starts are fitted here."""
        segments = found.train(alone)
        return cls(alone, found, segments, fit_starts(alone, segments), friction)

    def sizes(self, name: str) -> Begin:
        """The best of some sizes, then of some shapes, by the median error of a third of the events."""
        effect = coordinates(self.alone.library.find(name))
        some = np.arange(0, len(self.found.train_rows), EVERY)

        def tried(values: dict[str, float]) -> Begin:
            model = self._with(name, values)
            return float(np.median(errors(model, self.found.train(model).pick(some)))), model

        options = [tried(_values(effect, own, share)) for own in kinds(effect) for share in _SIZES]
        best = min(options, key=lambda option: option[0])[1]
        own = {c.name: best[c.name] for c in effect}
        options += [tried(own | shape) for shape in _shapes(effect)]
        return min(options, key=lambda option: option[0])

    def promise(self, name: str) -> Begin:
        """Along the tangent from none of it, friction beside it: minus the loss that a step would save.

        For models that predict most events: sizes large enough to try would miss the moments of all.
        """
        effect = coordinates(self.alone.library.find(name))
        options = []
        for own in kinds(effect):
            for shape in ({}, *_shapes(effect)):
                options.append(self._tangent(name, own, _values(effect, own, 0.0) | shape))
        return min(options, key=lambda option: option[0])

    def _tangent(self, name: str, own: tuple[Coordinate, ...], values: dict[str, float]) -> Begin:
        model = self._with(name, values)
        segments = self.found.train(model)
        states = segments.seated(model)
        states[:, [model.states.index(s) for s in self.alone.states]] = self.states
        prior = self.friction | {c.name: _NEAR * abs(c.scale) for c in own}
        problem = Problem(model, _unknowns(model, prior), segments, threads=1)
        begin = problem.unknowns.begin
        residuals = problem.residuals(states, begin)
        losses = problem.losses(residuals)
        problem.active = losses <= np.quantile(losses, WILD)
        equations = problem.equations(states, begin, residuals)
        step = problem.move(begin, equations, 0.0) * problem.unknowns.prior
        return -problem.promise(begin, equations), problem.with_values(begin + step)

    def _with(self, name: str, values: dict[str, float]) -> Model:
        return self.alone.with_effects([*self.alone.effects, name], values)


def _shapes(effect: tuple[Coordinate, ...]) -> Iterator[dict[str, float]]:
    """Each parameter that only shapes an effect, in turn a few times smaller and larger than usual."""
    for c in effect:
        if c.logarithmic and not c.is_size:
            yield from ({c.name: c.value(np.log(factor))} for factor in _FACTORS)


def _values(effect: tuple[Coordinate, ...], own: tuple[Coordinate, ...], share: float) -> dict[str, float]:
    """Parameters of an effect in its usual shape: its sizes `own` that share of the usual one, the others none."""
    values = {c.name: c.value(0.0) if c.neutral is None else c.neutral for c in effect}
    if share:  # what grows may be the inverse of the parameter
        values |= {c.name: c.value(-float(np.log(share)) if c.logarithmic else share) for c in own}
    return values


def _unknowns(model: Model, prior: dict[str, float]) -> Unknowns:
    begin = np.array([model[name] for name in prior])
    low, high = (np.array([getattr(model.specification(n), end) for n in prior]) for end in ("low", "high"))
    return Unknowns(tuple(prior), begin, begin, np.array(list(prior.values())), low, high)
