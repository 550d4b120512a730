"""The verdict of a diagnosis: the effects that may be kept, the equations that fail, and the verdict's word.

Three sentences hold for every diagnosis:

1. No effect is kept with which held-out predictions get worse by more than their scatter (`rises`).
2. An equation fails if its misfit exceeds noise and is large enough to matter (`fails`); predictions of a signal fail
   if their error exceeds noise and 5 % of the signal's change within the horizon (`missed`).
3. Where an equation or a prediction of the final model fails, the verdict is `unknown_effect`, whatever was added.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.compare import Comparison
from pneumo_ros.compare.verdicts import EquationVerdict
from pneumo_ros.compare.wording import SIGNALS, amount, percent
from pneumo_ros.diagnose.measures import MATERIAL_FORCE
from pneumo_ros.diagnose.outcome import ADEQUATE, FOUND, UNKNOWN, Addition, Unexplained
from pneumo_ros.diagnose.prediction import WORSE, typical_error, usual_errors
from pneumo_ros.plant import Model
from pneumo_ros.plant.effect import Effect
from pneumo_ros.runs.readings import read_from

Array = NDArray[np.float64]

SIGNIFICANT = 1.3  # times the noise: a larger error is more than noise and coarse sums explain
BEYOND_SCATTER = 2.0  # standard errors of the change of predictions between windows
LARGE = 0.05  # of the drive force, of the flow, or of a signal's change within the horizon
SHAPE_LEFT = 0.25  # of the base's mean square: a smaller misfit is an inexact law of an added effect


@dataclass(frozen=True)
class Missed:
    """Error of the predictions of one signal, in its unit, and its change within the horizon."""

    signal: str
    error: float
    change: float

    @property
    def sentence(self) -> str:
        """In words, for text and report."""
        off = f"{amount(self.error, self.signal)}, {percent(self.error / self.change)} of how much it changes"
        return f"predictions of the {SIGNALS[self.signal][0]} on held-out recordings are off by {off} in that time"


def rises(before: Mapping[str, Array], after: Mapping[str, Array], run: NDArray[np.int64] | None = None) -> bool:
    """Whether held-out predictions get worse, by more than their scatter, and are worse than noise explains.

    before, after: by signal, logarithms of the errors over noise (windows,) in the same windows. `run`: number of the
    recording (windows,) of each; by default all windows are of one. Windows of one recording are not independent: of
    the scatter between windows and that between recordings the larger one counts. One recording alone decides where its
    predictions get worse by a tenth and the others do not gain as much: a small rise in it may be chance, and a large
    one is lost in the scatter between recordings that it makes itself.
    """
    parts = [] if run is None or run.max(initial=0) == 0 else [run == k for k in np.unique(run)]
    change = np.mean([after[name] - before[name] for name in before], axis=0)
    sums = np.array([np.sum((change - np.mean(change))[own]) for own in parts])  # clusters (Liang and Zeger 1986)
    scatter = max(_scatter(change), float(np.sqrt(np.sum(sums**2))) / len(change))
    alone = any(
        np.mean(change[own]) > max(np.log(WORSE), BEYOND_SCATTER * _scatter(change[own]))
        and _worse({n: v[own] for n, v in before.items()}, {n: v[own] for n, v in after.items()})
        for own in parts
    )
    together = float(np.mean(change))
    return (alone and together > 0.0) or bool(_worse(before, after) and together > BEYOND_SCATTER * scatter)


def _scatter(change: Array) -> float:
    """Standard error of the mean of changes (windows,)."""
    return float(np.std(change)) / float(np.sqrt(len(change)))


def _worse(before: Mapping[str, Array], after: Mapping[str, Array]) -> bool:
    """Whether the error is larger, and larger than noise."""
    return typical_error(usual_errors(after)) > max(typical_error(usual_errors(before)), SIGNIFICANT)


def verdict(added: Sequence[Addition], unexplained: Unexplained | None, missed: Sequence[Missed]) -> str:
    """The one word for a diagnosis."""
    if missed or (unexplained is not None and unexplained.material):
        return UNKNOWN
    return FOUND if added else ADEQUATE


def failing(before: Comparison, after: Comparison, added: Sequence[Addition], model: Model) -> tuple[str, ...]:
    """Failing parts of the refitted base: its equations, and valve or sensors where an added effect belongs to them.

    An equation whose misfit is too small to matter fails where an added effect explains it.
    """
    found = [n for n in before.equations if fails(n, before, before) or (added and _mended(n, before, after))]
    for addition in added:
        kind = model.library.find(addition.effect)
        acts = {"valve": ".valve." in kind.__module__, "sensor": _misreads(kind, addition)}
        found += [part for part, own in acts.items() if own and part not in found]
    return tuple(found)


def _misreads(kind: type[Effect], addition: Addition) -> bool:
    """Whether an added effect makes a sensor differ from its state: a play before the load does not."""
    own = read_from(kind)
    return any(value.value != kind.parameters[key].neutral for key, value in addition.parameters.items() if key in own)


def fails(name: str, before: Comparison, after: Comparison) -> bool:
    """Whether the misfit of an equation is significant and material."""
    return significant(after.equations[name]) and material(name, before, after)


def significant(equation: EquationVerdict) -> bool:
    """Whether the misfit of an equation is larger than noise explains."""
    return equation.explained_by_noise is False and excess(equation) > 1.0


def excess(equation: EquationVerdict) -> float:
    """Mean square of a residual beyond the noise's, over the significant one: above 1 it is significant."""
    return (equation.ratio_to_noise**2 - 1.0) / (SIGNIFICANT**2 - 1.0)


def material(name: str, before: Comparison, after: Comparison) -> bool:
    """Whether a misfit matters: a force above 0.7 % of the drive force, and large or no small part of the base's."""
    first, last, whole = before.equations[name], after.equations[name], driving(after, name)
    if name == "momentum" and last.residual_rms < MATERIAL_FORCE * whole:
        return False
    return excess(last) > SHAPE_LEFT * excess(first) or last.residual_rms > LARGE * whole


def _mended(name: str, before: Comparison, after: Comparison) -> bool:
    """Whether the significant misfit of an equation falls to noise, or to a quarter of its excess at most."""
    first, last = before.equations[name], after.equations[name]
    return significant(first) and (not significant(last) or excess(last) <= SHAPE_LEFT * excess(first))


def driving(comparison: Comparison, equation: str) -> float:
    """Root mean square over all runs of the drive of an equation: force on the piston [N], flow at a port [kg/s]."""
    seen = [run.motion.seen for run in comparison.runs]
    if equation == "momentum":
        parts = [one["drive"] - one["force"] for one in seen]
    else:
        parts = [one[f"port_flow_{equation[-1]}"] for one in seen]
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def missed(comparison: Comparison) -> tuple[Missed, ...]:
    """The signals whose predictions fail, by their usual error: a few breakaways at the wrong moment decide nothing."""
    found = []
    for name in comparison.runs[0].error:
        each = [run.error[name] for run in comparison.runs]
        count = [run.windows for run in comparison.runs]
        ratio = float(np.exp(np.average(np.log([e.typical for e in each]), weights=count)))
        error = float(np.exp(np.average(np.log([e.typical * e.noise for e in each]), weights=count)))
        change = _change(comparison, name)
        if ratio > SIGNIFICANT and error > LARGE * change:
            found.append(Missed(name, error, change))
    return tuple(found)


def _change(comparison: Comparison, name: str) -> float:
    """Root mean square over all runs of the change of a measured signal within the horizon, in its unit."""
    changes = []
    for run in (one.motion.run for one in comparison.runs):
        signal, step = run.judged[name], round(comparison.horizon / run.sample_time)
        changes.append(signal[step:] - signal[:-step] if 0 < step < len(signal) else signal[-1:] - signal[0])
    return float(np.sqrt(np.mean(np.concatenate(changes) ** 2)))
