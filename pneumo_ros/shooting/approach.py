"""The starting point for a refit of all segments: near the optimum, found with a few segments."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.plant import Model
from pneumo_ros.shooting.estimates import Refit
from pneumo_ros.shooting.problem import Unknowns
from pneumo_ros.shooting.segments import Segments
from pneumo_ros.shooting.shooting import Progress, Shooting
from pneumo_ros.shooting.start import fit_starts

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_FEW = 40  # segments: enough for a start near the optimum


@dataclass(frozen=True)
class Near:
    """The starting point for the fit of all segments; `fresh`: starts were fitted from guesses by these parameters."""

    unknowns: Unknowns
    segments: Segments
    states: Array
    fresh: bool


def approach(
    model: Model, unknowns: Unknowns, segments: Segments, chosen: Index, start: Refit | None, threads: int,
    progress: Progress,
) -> Near:  # fmt: skip
    """Find a start near the optimum with a few segments.

    An earlier refit may have biased parameters to compensate a missing effect, sometimes too far to recover. So the
    descent is tried both from its result and from the prior values, and the better result is used.
    """
    few = np.unique(np.linspace(0, len(segments) - 1, min(len(segments), _FEW)).round().astype(np.int64))
    part, found = segments.pick(few), []
    for earlier in (None, start) if start else (None,):
        begin = _begun(unknowns, earlier)
        there = model.with_parameters(dict(zip(unknowns.names, begin.begin.tolist(), strict=True)))
        states = _warm(there, part, chosen[few], earlier) if earlier else part.seated(there)
        found.append(Shooting(model, begin, part, threads).approach(states, progress))
    states, theta, _ = min(found, key=lambda one: one[2])
    unknowns = replace(unknowns, begin=theta)
    if len(few) == len(segments):
        return Near(unknowns, segments, states, False)
    near = model.with_parameters(dict(zip(unknowns.names, theta.tolist(), strict=True)))
    segments = segments.guessed(near)
    return Near(unknowns, segments, fit_starts(near, segments, threads=threads), True)


def _begun(unknowns: Unknowns, earlier: Refit | None) -> Unknowns:
    known = earlier.estimates if earlier else {}
    begin = [known[n].value if n in known else b for n, b in zip(unknowns.names, unknowns.begin, strict=True)]
    return replace(unknowns, begin=np.array(begin))


def _warm(model: Model, segments: Segments, chosen: Index, start: Refit) -> Array:
    """Starts (segments, states) from an earlier refit, fitted where it had none.

    States that its model lacked start at their guesses, and sensor readings stay as they were.
    """
    before = start.model
    known = np.isin(chosen, start.chosen)
    old = start.starts[np.searchsorted(start.chosen, chosen[known])]
    shared = [s for s in model.states if s in before.states]
    states: Array = segments.seated(model)
    part = segments.pick(np.flatnonzero(known))
    moved = states[known]
    moved[:, [model.states.index(s) for s in shared]] = old[:, [before.states.index(s) for s in shared]]
    states[known] = part.seated(model, moved, part.read(before, old)[0])
    if not known.all():
        states[~known] = fit_starts(model, segments.pick(np.flatnonzero(~known)))
    return states
