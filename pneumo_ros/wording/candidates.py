"""Every effect that was tried: its evidence, and why it was or was not added."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pneumo_ros.compare.wording import number
from pneumo_ros.wording.naming import NORMAL, equation_words, listed, resolved
from pneumo_ros.wording.table import Table

ADDED, RIVAL, REFUSED = "added", "rival", "refused"
STATES = {ADDED: "added", RIVAL: "not distinguishable", REFUSED: "refused"}
LITTLE = 0.0005  # a held-out gain that is shown as 0.0 %
SHOWN = 4  # refused candidates that are shown everywhere
REASONS = 2  # of each of them


@dataclass(frozen=True)
class CandidateWords:
    """One effect that was tried; `gain` is the share of an equation's squared held-out residual that it removes."""

    effect: str
    state: str  # ADDED, RIVAL or REFUSED
    nats: float  # that all recordings gain with it
    gain: float
    equation: str  # that it helps most; a dash where it helps none
    size: str  # in usual sizes
    interval: str  # 95 %, of the size
    reasons: tuple[str, ...]

    @property
    def word(self) -> str:
        """The state in words."""
        return STATES[self.state]


def candidates(result: Mapping[str, Any]) -> tuple[CandidateWords, ...]:
    """All candidates, from the JSON of `diagnose`: what was added first, then by score."""
    rivals = {one["effect"]: one["indistinguishable_from"] for one in result["added"]}
    return tuple(_candidate(one, rivals) for one in result["candidates"])


def _candidate(one: Mapping[str, Any], rivals: Mapping[str, Sequence[str]]) -> CandidateWords:
    gain = one["holdout_gain"]
    return CandidateWords(
        effect=one["effect"],
        state=ADDED if one["added"] else RIVAL if one["rival_of"] else REFUSED,
        nats=-math.inf if one["score"]["nats"] is None else one["score"]["nats"],  # null: no finite prediction
        gain=gain,
        equation="-" if gain < LITTLE else equation_words(one["equation"]),
        size=f"{number(one['size'])} x" if one["size"] else "0",
        interval=_size_interval(one),
        reasons=_reasons(one, rivals.get(one["effect"], ())),
    )


def _size_interval(one: Mapping[str, Any]) -> str:
    low, high = one.get("size_low"), one.get("size_high")
    if low is None or high is None or not one["size"]:
        return "-"
    std = (high - low) / (2.0 * NORMAL)
    return f"{resolved(low, std)} to {resolved(high, std)}" if math.isfinite(std) else "-"


def _reasons(one: Mapping[str, Any], rivals: Sequence[str]) -> tuple[str, ...]:
    if one["added"]:
        as_well = f"these recordings cannot distinguish it from {listed(rivals, 'or')}"
        return (as_well if rivals else "no other effect explains as much",)
    if one["rival_of"]:
        return (f"would explain as much in place of {listed(one['rival_of'])}",)
    if one["size"] == 0.0:
        return ("fits best with size zero",)
    return tuple(_plain(text) for text in one["objections"]) or ("another effect explains more",)


def _plain(objection: str) -> str:
    """An objection with readable names of equations."""
    for name in ("chamber_a", "chamber_b"):
        objection = objection.replace(name, equation_words(name))
    return objection


def foremost(found: Sequence[CandidateWords]) -> tuple[CandidateWords, ...]:
    """Candidates that were not added but are shown everywhere: all rivals, and the refused ones of best score."""
    refused = [one for one in found if one.state == REFUSED]
    return (*(one for one in found if one.state == RIVAL), *refused[:SHOWN])


def refused_table(found: Sequence[CandidateWords]) -> Table:
    """The foremost candidates that were not added, a row for each of the first reasons."""
    rows = []
    for one in foremost(found):
        first, *others = one.reasons[:REASONS]
        rows += [(one.effect, f"{one.nats:.0f}", first), *(("", "", other) for other in others)]
    return Table("", ("Not added", "nats", "because"), tuple(rows), (1,))
