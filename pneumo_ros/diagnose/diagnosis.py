"""`diagnose`: the search, judged on held-out runs, as one outcome."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.blas import on_one_thread
from pneumo_ros.compare.compare import Comparison, compare
from pneumo_ros.diagnose.between import moved_between
from pneumo_ros.diagnose.candidate import Candidate
from pneumo_ros.diagnose.evidence import BLOCK
from pneumo_ros.diagnose.outcome import Addition, Outcome, Ranked, Unexplained, Value
from pneumo_ros.diagnose.prediction import typical_error
from pneumo_ros.diagnose.ruler import finest
from pneumo_ros.diagnose.score import TIMES
from pneumo_ros.diagnose.search import Progress, Search
from pneumo_ros.diagnose.steps import Found, Step
from pneumo_ros.diagnose.verdict import excess, failing, material, missed, significant, verdict
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

Array = NDArray[np.float64]

# s: correlation times that the score gives to what no model has, beyond those of neighbouring windows
CORRELATED = tuple(time for time in TIMES if time > BLOCK)


def diagnose(
    model: Model, train: Sequence[Run], held: Sequence[Run], *, progress: Progress | None = None,
    horizon: float | None = None,
) -> Outcome:  # fmt: skip
    """Which effects `model` lacks: refit, rank on `train`, confirm on `held`, add, repeat.

    `horizon` [s]: length of the windows in which runs are predicted; by default 1 s, or less where a run is shorter.

    All runs are of one machine; `held` is never fitted. Raises UsageError when either sequence is empty, DataError when
    a run does not fit the model.
    """
    if not train or not held:
        raise UsageError(
            "a diagnosis needs recordings to fit and other recordings to judge by; give the latter by --holdout"
        )
    tell = progress or (lambda share, text: None)
    search = Search(model, train, held, lambda share, text: tell(0.8 * share, text), horizon)
    return conclude(search, search.run(), tell)


@on_one_thread()
def conclude(search: Search, found: Found, tell: Progress) -> Outcome:
    """Judge what a search found by one-second windows of the held-out runs."""
    held = search.held.runs
    models = [search.start, found.base, *(step.model for step in found.steps[1:])]
    if models[-1].effects != found.model.effects:
        models.append(found.model)
    models[-1] = found.model
    waterfall, comparisons = [], {}
    for k, model in enumerate(models):
        tell(0.8 + 0.2 * k / len(models), "predicting held-out runs")
        waterfall.append((_label(models, k), typical_error(search.predicted(model))))
        if k in (1, len(models) - 1):
            comparisons[k] = compare(model, held, search.horizon)
    values = search.fitter.deviations(found.model, CORRELATED)
    added = tuple(
        _addition(step, found.model, values, waterfall[k + 1][1], waterfall[k + 2][1])
        for k, step in enumerate(found.steps)
        if step.added
    )
    before, after = comparisons[1], comparisons[len(models) - 1]
    unexplained, off = remains(before, after), missed(after)
    if unexplained is not None and unexplained.material:
        unexplained = replace(unexplained, moved=moved_between(search.fitter, found.model, unexplained.equation))
    return Outcome(
        verdict=verdict(added, unexplained, off),
        failing=failing(before, after, added, found.base),
        because=f"over {search.horizon:g} s, {'; '.join(one.sentence for one in off)}" if off else "",
        base=found.base,
        model=found.model,
        added=added,
        ranking=tuple(_ranked(candidate) for candidate in _latest(found.steps)),
        steps=found.steps,
        before=before,
        after=after,
        errors={
            "before": signal_errors(before), "after": signal_errors(after), "noise": noise_levels(after),
        },
        waterfall=tuple(waterfall),
        unexplained=unexplained,
        interrupted=found.interrupted,
        deadline=found.deadline,
        train=tuple(run.name for run in search.train.runs),
        held=tuple(run.name for run in held),
        limits=tuple(dict.fromkeys(search.fitter.limits)),
        late=search.late,
    )  # fmt: skip


def _label(models: Sequence[Model], k: int) -> str:
    if k < 2:
        return ("as given", "refitted")[k]
    now, before = models[k].effects, models[k - 1].effects
    changes = ["+ " + ", ".join(e for e in now if e not in before), "- " + ", ".join(e for e in before if e not in now)]
    return ", ".join(change for change in changes if len(change) > 2)


def signal_errors(comparison: Comparison) -> dict[str, float]:
    """Rms window error by signal over all runs, in its unit."""
    names = comparison.runs[0].error
    return {n: float(np.sqrt(np.mean([run.error[n].rms ** 2 for run in comparison.runs]))) for n in names}


def noise_levels(comparison: Comparison) -> dict[str, float]:
    """Noise by signal, in its unit."""
    names = comparison.runs[0].error
    return {n: float(np.sqrt(np.mean([run.error[n].noise ** 2 for run in comparison.runs]))) for n in names}


def _addition(step: Step, model: Model, std: dict[str, float], before: float, after: float) -> Addition:
    assert step.added is not None
    name, std = step.added.name, std | step.added.std
    values, effect = {}, model.library.find(name)
    idle = model.idle(name)
    for key, parameter in effect.parameters.items():
        dotted = f"{name}.{key}"
        if dotted in idle:
            continue
        values[key] = Value(model[dotted], math.hypot(std.get(dotted, math.inf), finest(model, dotted)), parameter.unit)
    return Addition(
        name, values, tuple(r.name for r in step.rivals), before, after, step.added.hypothesis.t, step.added.score
    )


def _latest(steps: Sequence[Step]) -> list[Candidate]:
    """Each candidate as judged in the last round that tried it; added candidates come first."""
    added = [step.added for step in steps if step.added]
    seen = {c.name: c for step in steps for c in step.candidates}
    seen |= {c.name: c for step in steps for c in step.rivals}  # of the round in which they tied
    names = [c.name for c in added]
    return [*added, *sorted((c for n, c in seen.items() if n not in names), key=lambda c: -c.score.nats)]


def _ranked(c: Candidate) -> Ranked:
    equation = max(c.gain, key=lambda name: c.gain[name])
    return Ranked(c.name, c.score, c.hypothesis.t, c.gain[equation], equation, c.size, c.objections, None)


def remains(before: Comparison, after: Comparison) -> Unexplained | None:
    """The worst failing equation, or else the worst with a misfit beyond noise, over its most explanatory variable.

    None where noise explains the misfit of all equations. Without a variable and bins where there are too few windows
    for them: the equation fails nonetheless.
    """
    left = {n: e for n, e in after.equations.items() if significant(e)}
    if not left:
        return None
    worst = max(left, key=lambda n: (material(n, before, after), excess(left[n])))
    shown = {n: d for n, d in after.dependences.get(worst, {}).items() if len(d.bins.centre)}
    equation, matters, none = after.equations[worst], material(worst, before, after), np.empty(0)
    if not shown:
        return Unexplained(
            worst, "", none, none, none, none, none, none, equation.unit, equation.residual_rms, 0.0, matters
        )
    against, best = max(shown.items(), key=lambda item: item[1].explained_share)
    bins = best.bins
    return Unexplained(
        worst, against, bins.centre, bins.mean, bins.below, bins.above, best.noise, best.seconds, equation.unit,
        equation.residual_rms, best.explained_share, matters,
    )  # fmt: skip
