"""What recordings tell of a machine's parameters, and what a trial that was not made yet would tell.

Both come from the equations in weak form along the recorded motion (`diagnose.evidence`): fitted within what data
sheets say, their slopes over the parameters give the covariance, with errors correlated within blocks (Liang and Zeger
1986). A trial that was not made is simulated on the machine as known so far. It is worth by how much it narrows the
deviation of each parameter, all others unknown, too: their product, and not that of all directions together, the
determinant of the information (D-optimal, Fedorov 1972). That one is fed by ratios of parameters, known to 1e-4 and
narrower still with every move, while each of them stays as vague as it was.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.commission.slips import surely_static
from pneumo_ros.diagnose.basefit import Known, slopes, strain
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import UNSEEN, Fitter
from pneumo_ros.diagnose.hypothesis import family_scales, log_likelihood, spread, weights
from pneumo_ros.equations.breakaway import find_breakaways
from pneumo_ros.identify.presliding import fit_presliding
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.estimates import Estimate
from pneumo_ros.shooting.refit import default_free, default_prior

Array = NDArray[np.float64]
MINUTE = 60.0  # s
NORMAL = 1.96  # deviations of a 95 % interval
OPENED = 0.95  # of the largest command, at which a valve opens at the start of a fit, or before
LIMITS, GAIN = ("dead_zone.right_limit", "dead_zone.left_limit"), "arctan_flow.voltage_gain"


@dataclass(frozen=True)
class Told:
    """What runs tell: weighted slopes (residuals, parameters) per prior deviation, weighted residuals, their blocks."""

    slopes: Array
    residual: Array
    block: NDArray[np.int64]
    scales: dict[str, float]  # of each family of residuals, over its noise

    @property
    def information(self) -> Array:
        """(parameters, parameters), in prior deviations, without the prior."""
        return np.asarray(self.slopes.T @ self.slopes)

    def deviations(self) -> Array:
        """Standard deviations (parameters,) over those of the prior."""
        return spread(self.slopes, self.residual, self.block)

    def beside(self, more: "Told") -> "Told":
        """Both together."""
        blocks = np.concatenate([self.block, more.block + 1 + int(self.block.max(initial=0))])
        residual = np.concatenate([self.residual, more.residual])
        return Told(np.concatenate([self.slopes, more.slopes]), residual, blocks, self.scales)


def told(evidence: Evidence, model: Model, known: Known, scales: dict[str, float] | None = None) -> Told:
    """What `evidence` tells about `known` at `model`; `scales`: of a trial that is simulated, those of real ones."""
    residual, slope = slopes(evidence, model, known)
    scale = np.maximum(family_scales(evidence, residual), 1.0)  # what breakaways share does not scatter
    if scales is not None:
        scale = np.array([scales.get(name, one) for name, one in zip(evidence.names, scale, strict=True)])
        residual = residual * scale[evidence.family]
    weight = weights(evidence, residual, scale)
    named = dict(zip(evidence.names, (float(one) for one in scale), strict=True))
    return Told(slope * weight[:, None], residual * weight, evidence.block, named)


def shrinkage(now: Told, more: Told, seconds: float) -> float:
    """Share by which a minute of trials that tell `more` in `seconds` shrinks the intervals: their geometric mean.

    The interval of a parameter is its own, the others unknown.
    """
    whole = now.information + np.eye(len(now.information))
    both = whole + more.information * (MINUTE / seconds)
    before, after = (np.log(np.diag(np.linalg.inv(one))) for one in (whole, both))
    return float(1.0 - np.exp(0.5 * np.mean(after - before)))


@dataclass(frozen=True)
class Knowledge:
    """A machine fitted to runs, what they tell of it, and an estimate of every parameter that is uncertain."""

    model: Model
    known: Known
    told: Told
    estimates: dict[str, Estimate]

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of every parameter, in its unit."""
        return {name: one.std for name, one in self.estimates.items()}

    @property
    def correlation(self) -> Array:
        """(parameters, parameters) of all that is uncertain, in the order of `deviations`."""
        whole, names = np.eye(len(self.estimates)), list(self.estimates)
        if self.known.names:
            of_known = np.linalg.inv(self.told.information + np.eye(len(self.known.names)))
            scale = np.sqrt(np.diag(of_known))
            at = [names.index(name) for name in self.known.names]
            whole[np.ix_(at, at)] = of_known / np.outer(scale, scale)
        return whole


def knowledge(model: Model, runs: Sequence[Run], before: Model | None = None) -> Knowledge:
    """`model`, as data sheets tell it, fitted to `runs`; without runs, what data sheets alone say.

    before: as fitted to fewer runs; its valve is one more to begin with.
    """
    if not runs:
        estimates = {
            name: _estimate(model, name, model[name], default_prior(model, name)) for name in default_free(model)
        }
        nothing = Told(np.zeros((0, len(estimates))), np.zeros(0), np.zeros(0, dtype=np.int64), {})
        empty = np.zeros(0)
        return Knowledge(model, Known((), empty, empty, empty), nothing, estimates)
    together = on_one_clock(runs)
    fitter = Fitter(_as_sheet(model), together, candidates=())
    known, every = fitter.known(model), fitter.train
    fitter.train = surely_static(every, before or model)
    found = _fitted(fitter, known, begun(model, together), before)
    if before is None:  # which breakaways count, the data sheet says badly
        fitter.train = surely_static(every, _presliding(found, together)[0])
        found = fitter.refit(found)
    what = told(fitter.train, found, known)
    deviations = dict(zip(known.names, (what.deviations() * known.prior).tolist(), strict=True))
    found, seen = _presliding(found, together)
    estimates = {
        name: _estimate(model, name, found[name], deviations.get(name, seen.get(name, default_prior(model, name))))
        for name in default_free(model)
    }
    return Knowledge(found, known, what, estimates)


def _as_sheet(model: Model) -> Model:
    """`model` with every prior stated, as wide as that which estimates are compared with.

    Where a file states nothing, a diagnosis takes 3 %, as for a machine that was identified, and `default_prior` 5 %.
    Slopes of the dead zone and gain of the valve act as a product, so the prior alone tells how large each of them is.
    """
    return model.with_uncertainty({name: default_prior(model, name) for name in default_free(model)})


def begun(model: Model, runs: Sequence[Run]) -> list[Model]:
    """Models to begin a fit with: valves as the data sheet says, and that open later or more steeply.

    Later by a deviation, or just before the largest command, as ramps end where the piston moves. The flow over the
    command has a kink at the dead zone, so a fit finds the best one near its start only. Each of these valves is opened
    by the commands of `runs`: within its dead zone a limit has no influence.
    """
    held = np.concatenate([run.held for run in runs]) - closed_signal(model)
    most = dict(zip(LIMITS, (float(held.max()), float(-held.min())), strict=True))
    last = {name: OPENED * volts for name, volts in most.items() if name in model.uncertainty and volts > 0.0}
    later = {name: min(_farther(model, name), volts) for name, volts in last.items()}
    steeper = {name: _farther(model, name) for name in (GAIN,) if name in model.uncertainty}
    asked = {name: min(model[name], volts) for name, volts in last.items()}
    gains = [{}, steeper] if steeper else [{}]
    openings = asked, last, later
    limits = [one for k, one in enumerate(openings) if one not in openings[:k]]
    return [model.with_parameters(one | steep) for steep in gains for one in limits]


def _farther(model: Model, name: str) -> float:
    return min(model[name] + model.uncertainty[name], model.specification(name).high)


def _fitted(fitter: Fitter, known: Known, starts: list[Model], before: Model | None) -> Model:
    """Fitted from several valves, `starts`: the best fit, or with that of `before` the best start."""

    def likely(one: Model) -> float:
        return log_likelihood(fitter.train, fitter.train.residual(one)) - strain(known.offset(one))

    if before is not None:
        valve = {name: before[name] for name in (*LIMITS, GAIN) if name in before.parameters}
        return fitter.refit(max([fitter.start.with_parameters(valve), *starts], key=likely))
    return max(map(fitter.refit, starts), key=likely)


def _estimate(before: Model, name: str, value: float, deviation: float) -> Estimate:
    half = NORMAL * deviation
    return Estimate(value, deviation, value - half, value + half, before[name], default_prior(before, name))


def _presliding(model: Model, runs: Sequence[Run]) -> tuple[Model, dict[str, float]]:
    """The model with the bristle stiffness that the deflection before breakaways shows, and its deviation."""
    stiffness = UNSEEN[0]
    if stiffness not in model.parameters:
        return model, {}
    found = fit_presliding(model, runs, [one for run in runs for one in find_breakaways(model, run)])
    if stiffness not in found.intervals:
        return model, {}
    low, high = found.intervals[stiffness]
    return model.with_parameters({stiffness: found.values[stiffness]}), {stiffness: (high - low) / (2.0 * NORMAL)}
