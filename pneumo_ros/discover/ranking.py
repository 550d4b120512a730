"""Every candidate that was tried, with what spoke for it in the round in which it was tried last."""

from collections.abc import Sequence

from pneumo_ros.discover.outcome import Ranked
from pneumo_ros.discover.prediction import typical_error
from pneumo_ros.discover.search import Search
from pneumo_ros.discover.steps import Step
from pneumo_ros.discover.trial import Trial
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model


def ranking(search: Search, steps: Sequence[Step]) -> tuple[Ranked, ...]:
    """What was added comes first, then the others by t."""
    added = [step.added for step in steps if step.added]
    names = [trial.name for trial in added]
    seen = {trial.name: (step.model, trial) for step in steps for trial in step.trials}
    seen |= {trial.name: (step.model, trial) for step in steps for trial in step.rivals}  # of the round they tied in
    others = sorted((pair for n, pair in seen.items() if n not in names), key=lambda pair: -pair[1].hypothesis.t)
    return (
        *(_ranked(trial, None) for trial in added),
        *(_ranked(trial, _error(search, model, trial)) for model, trial in others),
    )


def _ranked(trial: Trial, error: float | None) -> Ranked:
    equation = max(trial.gain, key=lambda name: trial.gain[name])
    return Ranked(trial.name, trial.hypothesis.t, trial.gain[equation], equation, trial.size, trial.objections, error)


def _error(search: Search, model: Model, trial: Trial) -> float | None:
    """Held-out error with the candidate as it was fitted to the equations; None where that cannot be simulated."""
    try:
        return typical_error(search.predicted(search.fitter.extended(model, trial.hypothesis)))
    except PneumoError:
        return None
