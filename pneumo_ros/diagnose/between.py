"""Whether the misfit of held-out recordings comes from machine parameters that changed since the fitted recordings.

Friction varies by a few per cent with temperature and wear. Other parameter values remove such a misfit; they do not
remove the misfit of a missing law.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneumo_ros.compare.verdicts import judge_equations
from pneumo_ros.diagnose.basefit import Known, fit_base
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

MOSTLY_GONE = 0.5  # share of the remaining mean square: a smaller reduction is not reported
REMAINING = 0.5  # of the noise's mean square: a smaller excess over noise is noise, too
NAMED = 0.01  # relative change of a parameter: a smaller change is not named


@dataclass(frozen=True)
class Moved:
    """`share` of the mean square beyond noise that disappears when the model's own parameters are refitted to the
    held-out recordings, and the parameters that changed: before and after, in their units.
    """

    share: float
    parameters: dict[str, tuple[float, float, str]]


def moved_between(fitter: Fitter, model: Model, equation: str) -> Moved | None:
    """How far the misfit of `equation` falls when the parameters of `fitter.start` are refitted to held-out recordings.

    Each parameter may move within its prior. None where the misfit falls by less than half, or is noise, or where no
    parameter moves by more than NAMED.
    """
    own = _own(fitter, model)
    other = fitter.noted(fit_base(fitter.held, model, own))
    before, after = (_beyond_noise(m, fitter.held.runs, equation) for m in (model, other))
    share = 1.0 - after / max(before, REMAINING)
    if share < MOSTLY_GONE or before < REMAINING:
        return None
    changed = {n: (model[n], other[n], model.specification(n).unit) for n in own.names}
    named = {n: v for n, v in changed.items() if abs(v[1] - v[0]) > NAMED * abs(v[0])}
    return Moved(share, named) if named else None  # a machine whose parameters agree within 1 % is the same machine


def _own(fitter: Fitter, model: Model) -> Known:
    """The parameters of the start model, with priors centred at their present values."""
    known = fitter.known(model)
    own = np.array([name.partition(".")[0] in fitter.start.effects for name in known.names], dtype=bool)
    names = tuple(name for name, mine in zip(known.names, own, strict=True) if mine)
    return Known(names, np.array([model[n] for n in names]), known.prior[own], known.step[own])


def _beyond_noise(model: Model, runs: Sequence[Run], equation: str) -> float:
    """Mean square of an equation's residual over the noise's, minus one."""
    return judge_equations([equation_residuals(model, run) for run in runs])[equation].ratio_to_noise ** 2 - 1.0
