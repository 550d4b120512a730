"""Changes by a refit: every free parameter with its interval, and the parameters that moved beyond their priors."""

from collections.abc import Mapping, Sequence
from typing import Any

from pneumo_ros.plant import Model
from pneumo_ros.shooting.refit import Estimate, Refit

BEYOND = 2.0  # prior standard deviations


def refit_dict(found: Refit, runs: Sequence[str]) -> dict[str, Any]:
    """The part `refit` of a verb's JSON; `runs` are the names of the recordings that were fitted."""
    return estimates_dict(found.model, found.estimates, runs) | {"segments": found.segments}


def estimates_dict(model: Model, estimates: Mapping[str, Estimate], runs: Sequence[str]) -> dict[str, Any]:
    """The same for estimates of any origin, by dotted name of the model's parameters."""
    parameters = {name: _parameter(model, name, estimate) for name, estimate in estimates.items()}
    return {
        "runs": list(runs),
        "parameters": parameters,
        "moved": [name for name, one in parameters.items() if one["moved_beyond_prior"]],
        "undetermined": [name for name, one in parameters.items() if not one["determined"]],
    }


def _parameter(model: Model, name: str, estimate: Estimate) -> dict[str, Any]:
    distance = (estimate.value - estimate.before) / estimate.prior
    return {
        "value": estimate.value, "std": estimate.std, "low": estimate.low, "high": estimate.high,
        "before": estimate.before, "prior": estimate.prior, "unit": model.specification(name).unit,
        "priors_moved": distance, "moved_beyond_prior": bool(abs(distance) > BEYOND),
        "determined": estimate.determined,
    }  # fmt: skip
