"""What `pneumo add` did, as text and as data."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import columns
from pneumo_ros.command.diagnosed import added, by_signal, listed, moved
from pneumo_ros.command.diagnosis_json import equations_dict, value_dict
from pneumo_ros.compare.wording import EQUATIONS, put_off, times

if TYPE_CHECKING:
    from pneumo_ros.diagnose.adding import Adding
    from pneumo_ros.shooting.refit import Estimate

HEADS = {"given": "as given", "before": "refitted", "after": "with it", "noise": "noise"}


def adding_dict(found: "Adding") -> dict[str, Any]:
    """Errors are over windows of one second; `held_out` says whether on runs that took no part in the fit."""
    from pneumo_ros.compare.moved import estimates_dict
    from pneumo_ros.diagnose.diagnosis import noise_levels, signal_errors

    given, before, after = found.errors
    return {
        "schema_version": 1,
        "model": found.model.name,
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
    units = {name: found.model.specification(name).unit for name in own}
    return {name.partition(".")[2]: value_dict(one.value, one.std, units[name]) for name, one in own.items()}


def _base(found: "Adding") -> "dict[str, Estimate]":
    """Estimates of what the model had before."""
    return {n: one for n, one in found.estimates.items() if n.partition(".")[0] not in found.effects}


def undetermined(result: Mapping[str, Any]) -> list[str]:
    """Dotted names of added parameters that the recordings do not tell; `result` is the verb's JSON."""
    effects = result["added"]
    return [f"{e['effect']}.{key}" for e in effects for key, one in e["parameters"].items() if one["std"] is None]


def text(result: Mapping[str, Any]) -> str:
    """The whole answer; `result` is the verb's JSON."""
    tables = _table(result), by_signal(result["errors"], HEADS), equations(result), moved(result["refit"])
    parts = (headline(result), put_off(result["input_delay_s"]), *tables, _lacking(result))
    return "\n\n".join(part for part in parts if part)


def headline(result: Mapping[str, Any]) -> str:
    """What became of the error."""
    names = listed([one["effect"] for one in result["added"]])
    given, before, after = (step["error"] for step in result["course"])
    where = "held out" if result["held_out"] else "that were fitted too (judge by others: --holdout BAG...)"
    count = f"{len(result['judged'])} recording{'s' if len(result['judged']) != 1 else ''}"
    pays = "" if after < before else " It does NOT pay: refitting alone predicts as well."
    return (
        f"Added {names} to '{result['model']}'. On {count} {where}, the error over {result['horizon_s']:g} s is "
        f"{times(given)} the noise floor as given, {times(before)} refitted, {times(after)} with what was added.{pays}"
    )


def _table(result: Mapping[str, Any]) -> str:
    """The table of `diagnose`, less what only a search tells."""
    rows = [one | {"holdout_error_before": one["error_before"], "holdout_error_after": one["error_after"]}
            for one in result["added"]]  # fmt: skip
    return added(rows) if result["held_out"] else added(rows).replace("held-out error", "error         ", 1)


def equations(result: Mapping[str, Any]) -> str:
    """The residual by equation."""
    found = result["equations"]
    rows = [("Residual by equation", "refitted", "with it", "")]
    for name, after in found["after"].items():
        cells = (times(found["before"][name]["ratio_to_noise"]), times(after["ratio_to_noise"]))
        judged = {None: "not judged: nothing slides", True: "explained by noise", False: "FAILS"}
        rows.append((f"  {EQUATIONS[name][0]}", *cells, judged[after["explained_by_noise"]]))
    return columns(rows, right=(1, 2))


def _lacking(result: Mapping[str, Any]) -> str:
    missing = undetermined(result)
    if not missing:
        return ""
    return f"Not determined by these recordings: {listed(missing)}; see: pneumo effects NAME for what shows it."
