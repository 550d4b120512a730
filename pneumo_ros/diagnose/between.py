"""Whether what remains on held-out recordings is the machine's own parameters having moved since the fitted ones.

Friction repeats itself to a few per cent only, with temperature and wear; a law that is missing does not go away when
other values are put into those that are there.
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

MOSTLY_GONE = 0.5  # of the mean square of what remains: less of it gone is not worth a word
REMAINING = 0.5  # of the noise's mean square: less beyond it is noise, too
NAMED = 0.01  # change of a parameter, of its value, that is named


@dataclass(frozen=True)
class Moved:
    """`share` of the mean square beyond noise that is gone once the model's own parameters are those of the held-out
    recordings, and the parameters that moved: before and after, in their units.
    """

    share: float
    parameters: dict[str, tuple[float, float, str]]


def moved_between(fitter: Fitter, model: Model, equation: str) -> Moved | None:
    """What refitting the parameters of `fitter.start` to the held-out recordings alone takes from `equation`.

    Each may move by what is known of it. None where less than half of what remains is gone, or nothing remains.
    """
    own = _own(fitter, model)
    other = fitter.noted(fit_base(fitter.held, model, own))
    before, after = (_beyond_noise(m, fitter.held.runs, equation) for m in (model, other))
    share = 1.0 - after / max(before, REMAINING)
    if share < MOSTLY_GONE or before < REMAINING:
        return None
    changed = {n: (model[n], other[n], model.specification(n).unit) for n in own.names}
    return Moved(share, {n: v for n, v in changed.items() if abs(v[1] - v[0]) > NAMED * abs(v[0])})


def _own(fitter: Fitter, model: Model) -> Known:
    """The parameters that the start had, each known to be about where it is now."""
    known = fitter.known(model)
    own = np.array([name.partition(".")[0] in fitter.start.effects for name in known.names])
    names = tuple(name for name, mine in zip(known.names, own, strict=True) if mine)
    return Known(names, np.array([model[n] for n in names]), known.prior[own], known.step[own])


def _beyond_noise(model: Model, runs: Sequence[Run], equation: str) -> float:
    """Mean square of an equation's residual over the noise's, less one."""
    return judge_equations([equation_residuals(model, run) for run in runs])[equation].ratio_to_noise ** 2 - 1.0
