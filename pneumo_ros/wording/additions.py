"""What was added to a model: parameters with intervals, the error without and with it, and its rivals."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pneumo_ros.compare.wording import times
from pneumo_ros.wording.naming import interval, listed, resolved
from pneumo_ros.wording.table import Table


@dataclass(frozen=True)
class ParameterWords:
    """A fitted parameter; `name` is its name in the machine file, `key` the same without the effect."""

    key: str
    name: str
    meaning: str
    value: str
    interval: str
    unit: str


@dataclass(frozen=True)
class AdditionWords:
    """An effect that was added; `error` is the held-out error without and with it, `rivals` a sentence or empty."""

    effect: str
    nats: str  # that all recordings gain with it; a dash where it was not asked
    error: str
    parameters: tuple[ParameterWords, ...]
    rivals: str


def additions(added: Sequence[Mapping[str, Any]]) -> tuple[AdditionWords, ...]:
    """The entries of `added` in the JSON of `diagnose`."""
    return tuple(_addition(one) for one in added)


def added_table(result: Mapping[str, Any]) -> Table:
    """The table of `diagnose` for the JSON of `add`, without the columns of a search."""
    added = [one | {"holdout_error_before": one["error_before"], "holdout_error_after": one["error_after"]}
             for one in result["added"]]  # fmt: skip
    return additions_table(additions(added), "held-out error" if result["held_out"] else "error")


def _addition(one: Mapping[str, Any]) -> AdditionWords:
    effect, rivals = str(one["effect"]), one.get("indistinguishable_from", ())
    nats = one.get("score", {}).get("nats")  # null where the time for it was over
    said = f"These recordings cannot distinguish {effect} from {listed(rivals, 'or')}: each explains them as well."
    return AdditionWords(
        effect,
        "-" if nats is None else f"{nats:.0f}",
        f"{times(one['holdout_error_before'])} -> {times(one['holdout_error_after'])}",
        tuple(parameter(effect, key, value) for key, value in one["parameters"].items()),
        said if rivals else "",
    )


def parameter(effect: str, key: str, one: Mapping[str, Any]) -> ParameterWords:
    """A parameter of an effect from its JSON, with as many decimals as its uncertainty allows."""
    std = math.inf if one["std"] is None else one["std"]
    least, most = (sign * math.inf if one.get(end) is None else one[end] for end, sign in (("least", -1), ("most", 1)))
    span = interval(one["value"], std, least, most)
    unit = "" if one["unit"] == "1" else one["unit"]
    return ParameterWords(key, f"{effect}.{key}", one.get("meaning", ""), resolved(one["value"], std), span, unit)


def with_rivals(one: Mapping[str, Any]) -> str:
    """An added effect within a sentence."""
    rivals = one["indistinguishable_from"]
    return str(one["effect"]) + (f" (or {listed(rivals, 'or')}, which explains as much)" if rivals else "")


def additions_table(added: Sequence[AdditionWords], error: str = "held-out error") -> Table:
    """A row for each parameter of what was added; `error` is the heading of the errors."""
    rows: list[tuple[str, ...]] = []
    for one in added:
        first: tuple[str, ...] = (one.effect, one.nats, one.error)
        for p in one.parameters:
            rows.append((*first, p.key, p.value, p.interval, p.unit))
            first = ("", "", "")
        if not one.parameters:
            rows.append((*first, "(no parameter)", "", "", ""))
    return Table("", ("Added", "nats", error, "parameter", "value", "95 % interval", "unit"), tuple(rows), (1, 2, 4))
