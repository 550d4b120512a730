"""The JSON of `pneumo diagnose`: the contract's keys, and beside them the evidence of every candidate."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pneumo_ros.wording.naming import NORMAL

if TYPE_CHECKING:
    from pneumo_ros.compare.compare import Comparison
    from pneumo_ros.diagnose.between import Moved
    from pneumo_ros.diagnose.candidate import Candidate
    from pneumo_ros.diagnose.outcome import Addition, Outcome, Ranked, Unexplained
    from pneumo_ros.diagnose.score import Score
    from pneumo_ros.plant import Model
    from pneumo_ros.plant.effect import Parameter
    from pneumo_ros.shooting.refit import Estimate

SCHEMA_VERSION = 1
KNOWN = 0.5  # times the prior standard deviation: a fit with a larger one has determined nothing


def diagnosis_dict(outcome: "Outcome", estimates: "Mapping[str, Estimate]", experiment: str) -> dict[str, Any]:
    """Numbers, texts and arrays by the names programs rely on; keys are only ever added.

    estimates: of all free parameters of the final model; experiment: what to record next, "" for nothing.
    """
    from pneumo_ros.compare.moved import estimates_dict

    return {
        "schema_version": SCHEMA_VERSION,
        "model": outcome.model.name,
        "coordinate": outcome.model.coordinate,
        "verdict": outcome.verdict,
        "interrupted": outcome.interrupted,
        "deadline": outcome.deadline,
        "because": outcome.because,
        "failing": list(outcome.failing),
        "added": [_added(one, outcome.model) for one in outcome.added],
        "candidates": [_candidate(one, outcome) for one in outcome.ranking],
        "holdout": {key: outcome.errors[key] for key in ("before", "after", "noise")},
        "unexplained": None if outcome.unexplained is None else _unexplained(outcome.unexplained),
        "suggested_experiment": experiment,
        "horizon_s": outcome.after.horizon,
        "course": [{"model": name, "holdout_error": error} for name, error in outcome.waterfall],
        "equations": {"before": equations_dict(outcome.before), "after": equations_dict(outcome.after)},
        "refit": estimates_dict(outcome.model, estimates, outcome.train),
        "train": list(outcome.train),
        "held_out": list(outcome.held),
        "rounds": len(outcome.steps),
        "input_delay_s": outcome.late,
        "limits": list(outcome.limits),
    }


def value_dict(value: float, std: float, known: "Parameter") -> dict[str, Any]:
    """A parameter with its 95 % interval, meaning and allowed range; infinite numbers become null in JSON."""
    return {
        "value": value, "std": std, "unit": known.unit, "low": value - NORMAL * std, "high": value + NORMAL * std,
        "meaning": known.meaning, "least": known.low, "most": known.high,
    }  # fmt: skip


def score_dict(score: "Score") -> dict[str, float]:
    """Nats that all recordings gain, and the part of the held-out ones."""
    return {"nats": score.nats, "heldout_nats": score.held}


def equations_dict(comparison: "Comparison") -> dict[str, Any]:
    """The verdict on each equation, over all runs."""
    return {name: dict(vars(judged)) for name, judged in comparison.equations.items()}


def _added(one: "Addition", model: "Model") -> dict[str, Any]:
    effect = model.library.find(one.effect)
    known = effect.parameters
    return {
        "effect": one.effect,
        "signature": effect.signature,
        "remedy": effect.remedy,
        "parameters": {key: value_dict(v.value, v.std, known[key]) for key, v in one.parameters.items()},
        "indistinguishable_from": list(one.indistinguishable_from),
        "holdout_error_before": one.holdout_error_before,
        "holdout_error_after": one.holdout_error_after,
        "t": one.t,
        "score": score_dict(one.score),
    }


def _candidate(one: "Ranked", outcome: "Outcome") -> dict[str, Any]:
    """Evidence of the round in which the candidate was tried last."""
    added = {addition.effect: addition for addition in outcome.added}
    rivals = [name for name, addition in added.items() if one.effect in addition.indistinguishable_from]
    tried = _tried(one, outcome)
    low, high = _size_interval(tried)
    predicted = added[one.effect].holdout_error_after if one.effect in added else one.holdout_error
    return {
        "effect": one.effect,
        "score": score_dict(one.score),
        "holdout_error": predicted,
        "t": one.t,
        "holdout_gain": one.holdout_gain,
        "equation": one.equation,
        "size": one.size,
        "size_low": low,
        "size_high": high,
        "added": one.effect in added,
        "rival_of": rivals,
        "objections": list(one.objections) or _outdone(one.effect, list(added), rivals, outcome.model),
        "parameters": _fitted(tried, outcome.model),
    }


def _outdone(name: str, added: list[str], rivals: list[str], model: "Model") -> list[str]:
    """Why an effect without objections was not added: another effect was."""
    if name in added or rivals or not added:
        return []
    simpler = [other for other in added if other in model.library.find(name).contains]
    return [f"{simpler[0]} explains as much with fewer parameters" if simpler else "another effect explains more"]


def _tried(one: "Ranked", outcome: "Outcome") -> "Candidate":
    """The candidate that a row of the ranking shows: that of the addition, else the last one with the row's t."""
    added = [step.added for step in outcome.steps if step.added and step.added.name == one.effect]
    tried = [c for step in outcome.steps for c in (*step.candidates, *step.rivals) if c.name == one.effect]
    return [*tried, *(c for c in tried if c.score == one.score), *added][-1]


def _size_interval(candidate: "Candidate") -> tuple[float, float]:
    """95 % interval of the largest size over its usual size; NaN where the fit has no covariance."""
    from pneumo_ros.diagnose.judging import sizes

    h = candidate.hypothesis
    if not len(h.coordinates) or len(h.covariance) != len(h.coordinates):
        return math.nan, math.nan
    here = sizes(h.coordinates, h.u)
    largest = int(np.argmax(np.abs(here)))
    spread = np.zeros(len(here))
    spread[largest] = NORMAL * math.sqrt(max(float(h.covariance[largest, largest]), 0.0))
    ends = [sizes(h.coordinates, h.u + off)[largest] * np.sign(here[largest]) for off in (-spread, spread)]
    return float(min(ends)), float(max(ends))


def _fitted(candidate: "Candidate", model: "Model") -> dict[str, Any]:
    """Parameters of a candidate as they were fitted when it was tried."""
    h, specified = candidate.hypothesis, model.library.find(candidate.name).parameters
    whole = len(h.covariance) == len(h.coordinates)
    found = {}
    for k, (c, u) in enumerate(zip(h.coordinates, h.u, strict=True)):
        seen = whole and bool(h.slopes[:, k].any())
        spread = math.sqrt(max(float(h.covariance[k, k]), 0.0)) if seen else math.inf
        value, key = c.value(float(u)), c.name.partition(".")[2]
        std = spread * (abs(value) if c.logarithmic else abs(c.scale)) if spread < KNOWN * c.prior else math.inf
        found[key] = value_dict(value, std, specified[key])
    return found


def _unexplained(left: "Unexplained") -> dict[str, Any]:
    """Empty bins are left out."""
    rows = zip(left.at, left.mean, left.low, left.high, left.noise, left.seconds, strict=True)
    kept = [tuple(map(float, row)) for row in rows if all(map(math.isfinite, row[:2]))]
    at, mean, low, high, noise, seconds = (list(column) for column in zip(*kept, strict=True)) if kept else [[]] * 6
    return {
        "equation": left.equation, "against": left.against,
        "shape": [[x, y] for x, y in zip(at, mean, strict=True)], "unit": left.unit,
        "low": low, "high": high, "noise": noise, "seconds": seconds,
        "residual_rms": left.rms, "explained_share": left.share, "material": left.material,
        "moved": None if left.moved is None else _moved(left.moved),
    }  # fmt: skip


def _moved(moved: "Moved") -> dict[str, Any]:
    """Parameters of the model itself that differ on held-out recordings."""
    values = {n: {"before": one, "after": two, "unit": unit} for n, (one, two, unit) in moved.parameters.items()}
    return {"share": moved.share, "parameters": values}
