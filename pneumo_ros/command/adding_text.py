"""What `pneumo add` did, as plain text."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.command.adding_json import undetermined
from pneumo_ros.command.console import table_text
from pneumo_ros.compare.wording import times
from pneumo_ros.wording.additions import added_table
from pneumo_ros.wording.diagnosis import delayed, judged_words
from pneumo_ros.wording.errors import signals_table
from pneumo_ros.wording.moved import moved_sentence, moved_table
from pneumo_ros.wording.naming import counted, equation_words, listed
from pneumo_ros.wording.table import Table

HEADS = {"given": "as given", "before": "refitted", "after": "with it"}


def text(result: Mapping[str, Any]) -> str:
    """The whole answer; `result` is the verb's JSON."""
    refit = result["refit"]
    added = [one["effect"] for one in result["added"]]
    said = (moved_sentence(refit, added), table_text(moved_table(refit, added)))
    moved = "\n".join(part for part in said if part)
    recordings = "held-out recordings" if result["held_out"] else "recordings, which were fitted too"
    what = f"{result['horizon_s']:g} s, rms over the {recordings}"
    signals = table_text(signals_table(result["errors"], HEADS, what))
    table = table_text(added_table(result))
    parts = (headline(result), delayed(result["input_delay_s"]), table, signals, equations(result), moved,
             _lacking(result))  # fmt: skip
    return "\n\n".join(part for part in parts if part)


def headline(result: Mapping[str, Any]) -> str:
    """How the error changed."""
    names = listed([one["effect"] for one in result["added"]])
    given, before, after = (step["error"] for step in result["course"])
    where = "held out" if result["held_out"] else "that were fitted too (judge by others: --holdout BAG...)"
    pays = "" if after < before else " It does NOT help: refitting alone predicts as well."
    return (
        f"Added {names} to '{result['model']}'. On {counted(len(result['judged']), 'recording')} {where}, the error "
        f"over {result['horizon_s']:g} s is {times(given)} the noise floor as given, {times(before)} refitted, "
        f"{times(after)} with what was added.{pays}"
    )


def equations(result: Mapping[str, Any]) -> str:
    """The residual by equation."""
    before, rows = result["equations"]["before"], list[tuple[str, ...]]()
    for name, after in result["equations"]["after"].items():
        ratios = (times(before[name]["ratio_to_noise"]), times(after["ratio_to_noise"]))
        rows.append((equation_words(name), *ratios, judged_words(after, after["explained_by_noise"] is False)))
    head = ("Residual over noise", "refitted", "with it", "")
    return table_text(Table("", head, tuple(rows), numeric=(1, 2)))


def _lacking(result: Mapping[str, Any]) -> str:
    missing = undetermined(result)
    if not missing:
        return ""
    return f"Not determined by these recordings: {listed(missing)}; see how it is recognised: pneumo effects NAME"
