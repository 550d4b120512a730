"""The JSON of `pneumo add`."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.diagnosis_json import equations_dict, value_dict

if TYPE_CHECKING:
    from pneumo_ros.diagnose.adding import Adding
    from pneumo_ros.shooting.refit import Estimate


def adding_dict(found: "Adding") -> dict[str, Any]:
    """Errors are over windows of one second; `held_out` says whether these runs were not fitted."""
    from pneumo_ros.compare.moved import estimates_dict
    from pneumo_ros.diagnose.diagnosis import noise_levels, signal_errors

    given, before, after = found.errors
    return {
        "schema_version": 1,
        "model": found.model.name,
        "coordinate": found.model.coordinate,
        "added": [
            {"effect": name, "parameters": _parameters(name, found), "error_before": before, "error_after": after}
            for name in found.effects
        ],
        "held_out": found.held_out,
        "train": list(found.train),
        "judged": list(found.judged),
        "horizon_s": found.after.horizon,
        "course": [
            {"model": "as given", "error": given},
            {"model": "refitted", "error": before},
            {"model": f"+ {', '.join(found.effects)}", "error": after},
        ],
        "errors": {
            "given": signal_errors(found.given), "before": signal_errors(found.before),
            "after": signal_errors(found.after), "noise": noise_levels(found.after),
        },
        "equations": {"before": equations_dict(found.before), "after": equations_dict(found.after)},
        "refit": estimates_dict(found.model, _base(found), found.train),
        "input_delay_s": found.late,
    }  # fmt: skip


def _parameters(effect: str, found: "Adding") -> dict[str, Any]:
    own = {name: one for name, one in found.estimates.items() if name.partition(".")[0] == effect}
    known = {name: found.model.specification(name) for name in own}
    return {name.partition(".")[2]: value_dict(one.value, one.std, known[name]) for name, one in own.items()}


def _base(found: "Adding") -> "dict[str, Estimate]":
    """Estimates of the parameters that the model had before."""
    return {n: one for n, one in found.estimates.items() if n.partition(".")[0] not in found.effects}


def undetermined(result: Mapping[str, Any]) -> list[str]:
    """Dotted names of added parameters that the recordings do not determine; `result` is the verb's JSON."""
    effects = result["added"]
    return [f"{e['effect']}.{key}" for e in effects for key, one in e["parameters"].items() if one["std"] is None]
