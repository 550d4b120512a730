"""What `pneumo fleet` found, as text."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.command.console import columns
from pneumo_ros.compare.wording import number


def text(result: Mapping[str, Any]) -> str:
    """The whole answer; `result` is the verb's JSON."""
    parts = [overview(result), drifts(result), effects(result), problems(result)]
    return "\n\n".join(part for part in parts if part)


def overview(result: Mapping[str, Any]) -> str:
    """A line for each machine."""
    rows = [("machine", "campaigns", "first", "last", "drifted", "effects found")]
    for one in result["machines"]:
        dates = [campaign["date"][:10] for campaign in one["campaigns"]]
        rows.append((
            one["machine"], str(len(dates)), dates[0], dates[-1],
            ", ".join(one["drifted"]) or "-", ", ".join(one["effects"]) or "-",
        ))  # fmt: skip
    return columns(rows, right=(1,))


def drifts(result: Mapping[str, Any]) -> str:
    """A line for each parameter that drifted."""
    rows = [("drifted", "parameter", "since", "first", "last", "95 % interval", "unit")]
    for one in result["machines"]:
        for name, moved in one["drifted"].items():
            interval = f"{number(moved['low'], 4)} to {number(moved['high'], 4)}"
            values = (number(moved["first"], 4), number(moved["last"], 4))
            rows.append(
                (one["machine"], name, f"{moved['since']} ({moved['date'][:10]})", *values, interval, moved["unit"])
            )
    return columns(rows, right=(3, 4)) if len(rows) > 1 else "No parameter drifted beyond what its intervals allow."


def effects(result: Mapping[str, Any]) -> str:
    """A sentence for each effect."""
    said = [f"{one['machine']}: {effect_sentence(name, found)}" for one in result["machines"]
            for name, found in one["effects"].items()]  # fmt: skip
    return "\n".join(said)


def effect_sentence(name: str, found: Mapping[str, Any]) -> str:
    """Since when a machine has an effect."""
    begin = f"{found['since']} ({found['date'][:10]})"
    if not found["steady"]:
        return f"{name} in {found['campaigns']} campaigns, first in {begin}, not in all later."
    if found["from_the_start"]:
        return f"{name} from the start."
    return f"{name} appeared in {begin} and stayed."


def problems(result: Mapping[str, Any]) -> str:
    """Campaigns that could not be examined."""
    said = [f"{one['machine']}/{campaign['campaign']}: {campaign['problem']}" for one in result["machines"]
            for campaign in one["campaigns"] if campaign["problem"]]  # fmt: skip
    return "\n".join(["Not examined:", *said]) if said else ""
