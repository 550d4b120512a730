"""Refit of a whole model to recordings by multiple shooting (Bock 1983).

Every run is cut into segments whose initial states are free; each segment is simulated from its own start, and all
starts and all parameters together minimise the whitened, robustly weighted errors (Huber 1964) plus the priors. The few
segments that fit far worse than the rest, breakaways predicted at the wrong moment, are left out. The starts are
eliminated segment by segment (Schur complement), so that the cost grows linearly with the data, and all perturbed
simulations of one iteration run as lanes.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from pneumo_ros.blas import on_one_thread
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.plant import Model
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.approach import approach
from pneumo_ros.shooting.estimates import Estimate, Refit, estimates
from pneumo_ros.shooting.problem import Unknowns
from pneumo_ros.shooting.segments import Segments, cut
from pneumo_ros.shooting.shooting import Progress, Shooting

__all__ = ["Estimate", "Refit", "default_free", "refit", "refit_segments"]


SEGMENT, LOOP_SEGMENT = 0.5, 1.0  # s: of most machines, and of one in its position loop, which bounds errors
PRIOR = 0.05  # relative standard deviation of a parameter known to a few per cent

# Parameters that a scale, a ruler or a table determines better than a motion: fixed unless named.
FIXED_EFFECTS = ("end_stop", "arm_load")  # beside piston, air and what actuates the machine
FIXED = ("air.supply_pressure", "lugre_friction.bristle_damping", "lugre_friction.breakaway_ratio")


def default_free(model: Model) -> tuple[str, ...]:
    """Free parameters of a refit: all but mass, geometry, gas, end stops and parameters only presliding shows.

    What whoever built the machine chose is not free either, nor what does nothing in the form that an effect has. What
    the machine file states to be uncertain is free, too, and nothing is free that it states to be known exactly.
    """
    idle = {name for effect in model.effects for name in model.idle(effect)}
    fitted = [name for name in model.effects if name not in FIXED_EFFECTS]

    def usually(name: str) -> bool:
        chosen = model.specification(name).chosen
        return name.partition(".")[0] in fitted and name not in (*FIXED, *idle) and not chosen

    return tuple(name for name in model.parameters if model.uncertainty.get(name, float(usually(name))) > 0.0)


def to_fit(model: Model, names: Iterable[str]) -> tuple[str, ...]:
    """Those of `names` that `model` has and whose values its machine file does not state to be known exactly."""
    return tuple(name for name in names if name in model.parameters and name not in model.exact)


def refit(
    model: Model,
    runs: Sequence[Run],
    *,
    free: Sequence[str] | None = None,
    priors: Mapping[str, float] | None = None,
    centres: Mapping[str, float] | None = None,
    segment: float = SEGMENT,
    share: float = 1.0,
    start: Refit | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters (default `default_free`) of a model to all runs together.

    `priors` maps dotted names to standard deviations in the parameter's unit (default `default_prior`), `centres` to
    what was known before these runs (default: the value of `model`, where the fit begins). `model` fitted to the same
    runs needs its centres: about its own values, the priors would count the runs twice. `segment` [s] is the length of
    the shooting segments, `share` the share of them that is used, evenly drawn. With `start`, an earlier refit to the
    same runs and `segment`, parameters start at its result, and keep its priors unless others are given; a few
    iterations then show the change by another effect. Raises UsageError for unknown names, DataError when no run holds
    a segment, NumericalError when no prediction is finite.
    """
    names = default_free(model) if free is None else tuple(free)
    segments = cut(model, on_one_clock(runs), segment)
    return refit_segments(
        model, segments, names, priors or {}, centres, share=share, start=start, threads=threads, progress=progress
    )


@on_one_thread()
def refit_segments(
    model: Model,
    segments: Segments,
    free: Sequence[str],
    priors: Mapping[str, float],
    centres: Mapping[str, float] | None = None,
    *,
    share: float = 1.0,
    start: Refit | None = None,
    threads: int = 2,
    progress: Progress | None = None,
) -> Refit:
    """Refit `free` parameters to the given segments; otherwise as `refit`."""
    unknowns = unknowns_of(model, tuple(free), priors, start, centres)
    if not len(segments):
        raise DataError("no segment without a gap in any of the recordings; give a shorter --segment")
    count = max(round(share * len(segments)), 1)
    chosen = np.unique(np.linspace(0, len(segments) - 1, count).round().astype(np.int64))
    used = segments.pick(chosen)
    tell = progress or (lambda share, text: None)
    first = Shooting(model, unknowns, used, threads).begin_cost(used.seated(model))
    near = approach(model, unknowns, used, chosen, start, threads, lambda part, text: tell(0.3 * part, text))
    shooting = Shooting(model, near.unknowns, near.segments, threads)
    solution = shooting.solve(near.states, lambda part, text: tell(0.3 + 0.7 * part, text), near.fresh)
    found, correlation = estimates(unknowns, solution)
    return Refit(
        model.with_parameters(dict(zip(unknowns.names, solution.theta.tolist(), strict=True))),
        found, correlation, (first, *solution.costs), len(used), int(np.sum(~solution.active)), solution.states, chosen,
    )  # fmt: skip


def default_prior(model: Model, name: str) -> float:
    """Prior standard deviation of a parameter: what the machine file states, else 5 % of its value, in its unit.

    5 % of its default if that is larger, of its usual size if both are 0. For an effect that is switched off, its whole
    usual size.
    """
    if name in model.uncertainty:
        return model.uncertainty[name]
    specification, value = model.specification(name), model[name]
    size = max(abs(value), abs(specification.default))
    if value == specification.neutral and (specification.default != value or size == 0.0):
        return model.usual_size(name)
    return PRIOR * (size or model.usual_size(name))


def unknowns_of(
    model: Model, names: tuple[str, ...], priors: Mapping[str, float], start: Refit | None = None,
    centres: Mapping[str, float] | None = None,
) -> Unknowns:  # fmt: skip
    """The unknowns of a refit of the named parameters; otherwise as `refit`. UsageError for no name or a prior of 0."""
    known = start.estimates if start else {}
    prior = [priors.get(n, known[n].prior if n in known else default_prior(model, n)) for n in names]
    if not names:
        raise UsageError("a refit needs at least one free parameter; name one, or leave out the list for the default")
    for name, width in zip(names, prior, strict=True):
        if not width > 0.0:
            unit = model.specification(name).unit
            why = ", and the machine file states it to be known exactly" if name in model.exact else ""
            raise UsageError(f"the prior of {name} is {width:g} {unit}; a refit takes standard deviations above 0{why}")
    specs = [model.specification(name) for name in names]
    begin = {n: known[n].before if n in known else model[n] for n in names}
    return Unknowns(
        names=names,
        begin=np.array(list(begin.values())),
        centre=np.array([(centres or {}).get(n, value) for n, value in begin.items()]),
        prior=np.array(prior),
        low=np.array([s.low for s in specs]),
        high=np.array([s.high for s in specs]),
    )
