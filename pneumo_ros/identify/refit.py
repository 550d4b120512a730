"""Refit of a whole model to recordings by multiple shooting (Bock 1983).

Every run is cut into segments whose initial states are free; each segment is simulated from its own start, and all
starts and all parameters together minimise the whitened, robustly weighted errors (Huber 1964) plus the priors. The few
segments that fit far worse than the rest, breakaways caught in the wrong moment, are left out. The starts are
eliminated segment by segment (Schur complement), so that the cost grows linearly with the data, and all perturbed
simulations of one iteration run as lanes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.identify.estimates import Estimate, estimates
from pneumo_ros.identify.run import Run
from pneumo_ros.identify.segments import Segments, cut
from pneumo_ros.identify.shooting import Progress, Shooting, Unknowns
from pneumo_ros.identify.start import fit_starts
from pneumo_ros.plant import Model

__all__ = ["Estimate", "Refit", "default_free", "refit", "refit_segments"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

SEGMENT = 0.5  # s
PRIOR = 0.05  # relative standard deviation of a parameter known to a few per cent

# What a scale, a ruler or a table tells better than a motion: fixed unless asked for.
FIXED_SECTIONS = ("piston", "chambers", "air", "end_stop")
FIXED = ("air.supply_pressure", "lugre_friction.bristle_damping", "lugre_friction.breakaway_ratio")


@dataclass(frozen=True)
class Refit:
    """The refitted model, an estimate per free parameter, their correlation, and the course of the cost.

    `starts` (segments, states) are the fitted initial states of the segments that were used, `chosen` (segments,) which
    of all they are; another refit may begin with them.
    """

    model: Model
    estimates: dict[str, Estimate]
    correlation: Array  # (free, free)
    costs: tuple[float, ...]
    segments: int
    left_out: int  # segments that fit far worse than the rest
    starts: Array
    chosen: Index


def default_free(model: Model) -> tuple[str, ...]:
    """Parameters a refit lets move: all but mass, geometry, gas, end stops and what presliding alone shows."""
    return tuple(
        name for name in model.parameters if name.partition(".")[0] not in FIXED_SECTIONS and name not in FIXED
    )


def refit(
    model: Model,
    runs: Sequence[Run],
    *,
    free: Sequence[str] | None = None,
    priors: Mapping[str, float] | None = None,
    segment: float = SEGMENT,
    share: float = 1.0,
    start: Refit | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters (default `default_free`) of a model to all runs together.

    `priors` maps dotted names to standard deviations in the parameter's unit (default `default_prior`). `segment` [s]
    is the length of the shooting segments, `share` how many of them are used, evenly drawn. With `start`, an earlier
    refit to the same runs and `segment`, parameters begin where it ended, and keep the priors they had there unless
    others are given; a few iterations then tell what another effect changes. Raises UsageError for unknown names,
    DataError when no run holds a segment, NumericalError when no prediction is finite.
    """
    names = default_free(model) if free is None else tuple(free)
    segments = cut(model, runs, segment)
    return refit_segments(
        model, segments, names, priors or {}, share=share, start=start, threads=threads, progress=progress
    )


def refit_segments(
    model: Model,
    segments: Segments,
    free: Sequence[str],
    priors: Mapping[str, float],
    *,
    share: float = 1.0,
    start: Refit | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters to the given segments; otherwise as `refit`."""
    unknowns = _unknowns(model, tuple(free), priors, start)
    if not len(segments):
        raise DataError("no segment without a gap in any of the recordings; give a shorter --segment")
    count = max(round(share * len(segments)), 1)
    chosen = np.unique(np.linspace(0, len(segments) - 1, count).round().astype(np.int64))
    used = segments.pick(chosen)
    model = model.with_parameters(dict(zip(unknowns.names, unknowns.begin.tolist(), strict=True)))
    states = _warm(model, used, chosen, start) if start else used.seated(model)
    solution = Shooting(model, unknowns, used, threads).solve(states, progress or (lambda share, text: None))
    found, correlation = estimates(unknowns, solution)
    return Refit(
        model.with_parameters(dict(zip(unknowns.names, solution.theta.tolist(), strict=True))),
        found, correlation, solution.costs, len(used), int(np.sum(~solution.active)), solution.states, chosen,
    )  # fmt: skip


def default_prior(model: Model, name: str) -> float:
    """Standard deviation that a parameter has before any data: 5 % of its value, in the parameter's unit.

    Of its default where that is larger; where an effect is switched off, all that would bring it to its default.
    """
    specification, value = model.specification(name), model[name]
    if value == specification.neutral and specification.default != value:
        return abs(specification.default - value)
    return PRIOR * max(abs(value), abs(specification.default))


def _unknowns(model: Model, names: tuple[str, ...], priors: Mapping[str, float], start: Refit | None) -> Unknowns:
    known = start.estimates if start else {}
    prior = [priors.get(n, known[n].prior if n in known else default_prior(model, n)) for n in names]
    if not names or not all(p > 0.0 for p in prior):
        raise UsageError("a refit needs at least one free parameter, and priors above zero")
    specs = [model.specification(name) for name in names]
    return Unknowns(
        names=names,
        begin=np.array([known[n].value if n in known else model[n] for n in names]),
        centre=np.array([known[n].before if n in known else model[n] for n in names]),
        prior=np.array(prior),
        low=np.array([s.low for s in specs]),
        high=np.array([s.high for s in specs]),
    )


def _warm(model: Model, segments: Segments, chosen: Index, start: Refit) -> Array:
    """Starts (segments, states) as an earlier refit left them, fitted where it had none.

    States that its model lacked begin as guessed, and sensors read there what they read before.
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
